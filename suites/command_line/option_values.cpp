#include "suites/command_line/option_values.h"

#include <limits>

#include <fmt/format.h>

#include "perception/base/document.h"
#include "perception/base/errors.h"

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

}  // namespace suites::command_line
