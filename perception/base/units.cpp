#include "perception/base/units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <ctime>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace base {

namespace {

struct UnitFactor {
  std::string_view unit;
  double factor;
};

constexpr std::array kDurationUnits{
    UnitFactor{"ns", 1e-9},  UnitFactor{"us", 1e-6}, UnitFactor{"ms", 1e-3}, UnitFactor{"s", 1.0},
    UnitFactor{"min", 60.0}, UnitFactor{"m", 60.0},  UnitFactor{"h", 3600.0}};
constexpr std::array kByteUnits{UnitFactor{"B", 1.0},           UnitFactor{"kB", 1e3},
                                UnitFactor{"MB", 1e6},          UnitFactor{"GB", 1e9},
                                UnitFactor{"KiB", 1024.0},      UnitFactor{"MiB", 1048576.0},
                                UnitFactor{"GiB", 1073741824.0}};
constexpr std::array kPercentUnits{UnitFactor{"%", 0.01}};

/// Reads "<number><unit>", with optional blanks between. The message names every accepted unit.
template <std::size_t Count>
double parse_with_unit(std::string_view text, const std::array<UnitFactor, Count>& units,
                       std::string_view what, const Place& place) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
  while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
  if (error == std::errc{} && std::isfinite(number)) {
    for (const UnitFactor& known : units) {
      if (known.unit == unit) return number * known.factor;
    }
  }
  std::string accepted;
  for (const UnitFactor& known : units) {
    accepted += fmt::format("{}{}", accepted.empty() ? "" : ", ", known.unit);
  }
  throw InputError(place, fmt::format("{} \"{}\" is not a number with a unit; accepted units: {} "
                                      "(e.g. \"2{}\")",
                                      what, text, accepted, units.back().unit));
}

double require_positive(double value, std::string_view text, std::string_view what,
                        const Place& place) {
  if (value > 0.0) return value;
  throw InputError(place, fmt::format("{} \"{}\" must be greater than 0", what, text));
}

}  // namespace

double parse_duration_s(std::string_view text, const Place& place) {
  return require_positive(parse_with_unit(text, kDurationUnits, "duration", place), text,
                          "duration", place);
}

std::int64_t parse_bytes(std::string_view text, const Place& place) {
  const double bytes = require_positive(parse_with_unit(text, kByteUnits, "size in bytes", place),
                                        text, "size in bytes", place);
  constexpr double kLargest = 9.0e18;
  if (bytes > kLargest) {
    throw InputError(place, fmt::format("size in bytes \"{}\" is greater than 8 EiB", text));
  }
  return static_cast<std::int64_t>(bytes);
}

double parse_percent(std::string_view text, const Place& place) {
  return parse_with_unit(text, kPercentUnits, "percentage", place);
}

SizePx parse_size_px(std::string_view text, const Place& place) {
  SizePx size;
  const char* end = text.data() + text.size();
  const auto [after_width, width_error] = std::from_chars(text.data(), end, size.width);
  if (width_error == std::errc{} && after_width != end && *after_width == 'x') {
    const auto [after_height, height_error] = std::from_chars(after_width + 1, end, size.height);
    constexpr int kLargestSide = 65536;
    if (height_error == std::errc{} && after_height == end && size.width >= 1 && size.height >= 1 &&
        size.width <= kLargestSide && size.height <= kLargestSide) {
      return size;
    }
  }
  throw InputError(place, fmt::format("image size \"{}\" is not WIDTHxHEIGHT in pixels, each 1 "
                                      "to 65536 (e.g. \"640x480\")",
                                      text));
}

std::string format_significant(double value, int digits) {
  if (!std::isfinite(value)) return std::isnan(value) ? "n/a" : (value > 0 ? "inf" : "-inf");
  if (value == 0.0) return "0";
  const int exponent = static_cast<int>(std::floor(std::log10(std::fabs(value))));
  if (exponent < -4 || exponent >= 7) return fmt::format("{:.{}e}", value, digits - 1);
  const int decimals = std::max(0, digits - 1 - exponent);
  return fmt::format("{:.{}f}", value, decimals);
}

std::string format_duration(double seconds) {
  constexpr int kDigits = 3;
  const double magnitude = std::fabs(seconds);
  if (magnitude >= 5400.0) return format_significant(seconds / 3600.0, kDigits) + " h";
  if (magnitude >= 90.0) return format_significant(seconds / 60.0, kDigits) + " min";
  if (magnitude >= 0.9995 || seconds == 0.0) return format_significant(seconds, kDigits) + " s";
  if (magnitude >= 0.9995e-3) return format_significant(seconds * 1e3, kDigits) + " ms";
  return format_significant(seconds * 1e6, kDigits) + " us";
}

std::string format_bytes(double bytes) {
  constexpr std::array<std::string_view, 5> kUnits{"B", "KiB", "MiB", "GiB", "TiB"};
  std::size_t unit = 0;
  while (std::fabs(bytes) >= 999.5 && unit + 1 < kUnits.size()) {
    bytes /= 1024.0;
    ++unit;
  }
  return fmt::format("{} {}", format_significant(bytes, 3), kUnits[unit]);
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1,
                     utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

}  // namespace base
