#include "perception/base/names.h"

#include <algorithm>
#include <cctype>

namespace base {

namespace {

std::string with_separator(std::string_view name, char separator) {
  std::string result(name);
  for (char& c : result) {
    c = (c == '-' || c == '_') ? separator
                               : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return result;
}

}  // namespace

std::string kebab_case(std::string_view name) { return with_separator(name, '-'); }

std::string snake_case(std::string_view name) { return with_separator(name, '_'); }

bool is_same_name(std::string_view a, std::string_view b) { return kebab_case(a) == kebab_case(b); }

bool is_path_safe(std::string_view name) {
  if (name.empty() || name.front() == '.' || name.front() == '-') return false;
  return std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-';
  });
}

}  // namespace base
