#include "suites/command_line/option_values.h"

#include <filesystem>
#include <limits>
#include <system_error>

#include <fmt/format.h>

#include "perception/base/document.h"
#include "perception/base/errors.h"
#include "perception/base/units.h"

namespace suites::command_line {

std::int64_t parse_integer_option(const std::string& text, const std::string& option,
                                  std::int64_t low) {
  constexpr std::int64_t kHigh = std::numeric_limits<int>::max();
  const base::Place place{option};
  const base::Node node = base::Node::from_plain_scalar(text, place);
  const bool is_integer = node.kind() == base::Node::Kind::integer;
  if (!is_integer || node.integer(option) < low || node.integer(option) > kHigh) {
    throw base::InputError(place, fmt::format("\"{}\" is not accepted; accepted: a whole number "
                                              "from {} to {}",
                                              text, low, kHigh));
  }
  return node.integer(option);
}

double parse_number_option(const std::string& text, const std::string& option) {
  const base::Place place{option};
  const base::Node node = base::Node::from_plain_scalar(text, place);
  if (!node.is_number()) {
    throw base::InputError(place, fmt::format("\"{}\" is not accepted; accepted: a number", text));
  }
  return node.number(option);
}

double parse_share_option(const std::string& text, const std::string& option) {
  const bool is_percentage = !text.empty() && text.back() == '%';
  const double share = is_percentage ? base::parse_percent(text, base::Place{option})
                                     : parse_number_option(text, option);
  if (share <= 0.0 || share >= 1.0) {
    throw base::InputError(base::Place{option},
                           fmt::format("\"{}\" is not accepted; accepted: a share between 0 and 1, "
                                       "such as 0.05 or 5%",
                                       text));
  }
  return share;
}

void make_folder_of_option(const std::string& folder, const std::string& option) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return;
  throw base::InputError(
      fmt::format("{}: the folder \"{}\" cannot be made: {}", option, folder, error.message()));
}

}  // namespace suites::command_line
