#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "perception/base/errors.h"

namespace base {

/// Width and height of an image, pixels.
struct SizePx {
  int width = 0;
  int height = 0;
  friend bool operator==(const SizePx&, const SizePx&) = default;
};

/// "10s", "250ms", "1.5min", "10m" (minutes), "1h" -> seconds, > 0.
/// @throws InputError with the accepted forms
double parse_duration_s(std::string_view text, const Place& place);

/// "8GiB", "512MiB", "64KiB", "100B", also kB MB GB (powers of ten) -> bytes, > 0.
std::int64_t parse_bytes(std::string_view text, const Place& place);

/// "2%" -> 0.02. A bare number is refused.
double parse_percent(std::string_view text, const Place& place);

/// "640x480" -> {640, 480}; each side 1 ... 65536.
SizePx parse_size_px(std::string_view text, const Place& place);

/// "1.24 s", "83.1 ms", "12.0 us": three significant digits with a fitting unit.
std::string format_duration(double seconds);

/// "1.50 GiB", "312 KiB": three significant digits with a fitting binary unit.
std::string format_bytes(double bytes);

/// Number with the given count of significant digits, without a trailing exponent where short.
std::string format_significant(double value, int digits);

/// Now, UTC, as "2026-11-22T00:12:09Z".
std::string utc_now();

}  // namespace base
