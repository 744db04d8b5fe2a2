#include "results/html_report/html_text.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

namespace results::html_report {

std::string sort_attribute(double value) {
  // JavaScript's Number() knows infinity by its full name only.
  if (std::isinf(value))
    return value > 0.0 ? R"( data-sort="Infinity")" : R"( data-sort="-Infinity")";
  return fmt::format(" data-sort=\"{}\"", value);
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  result.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t byte =
          i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U;
      group = group << 8U | byte;
    }
    const std::size_t digits = bytes.size() - i >= 3 ? 4 : bytes.size() - i + 1;
    for (std::size_t k = 0; k < 4; ++k) {
      result += k < digits ? kDigits[group >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return result;
}

}  // namespace results::html_report
