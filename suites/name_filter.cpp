#include "suites/name_filter.h"

#include <regex>

#include <fmt/format.h>

#include "perception/base/errors.h"

namespace suites {

struct NameFilter::Pattern {
  std::regex regex;
};

NameFilter::NameFilter(const std::string& filter) {
  if (filter.empty()) return;
  try {
    pattern_ = std::make_shared<const Pattern>(Pattern{std::regex(filter, std::regex::ECMAScript)});
  } catch (const std::regex_error& error) {
    throw base::InputError(
        fmt::format("--filter \"{}\" is not a regular expression: {}", filter, error.what()));
  }
}

bool NameFilter::matches(const std::string& name) const {
  return pattern_ == nullptr || std::regex_search(name, pattern_->regex);
}

}  // namespace suites
