#include "perception/base/names.h"

#include <algorithm>
#include <cctype>

namespace base {

namespace {

char with_separator(char c, char separator) {
  if (c == '-' || c == '_') return separator;
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

std::string with_separator(std::string_view name, char separator) {
  std::string result(name);
  for (char& c : result) c = with_separator(c, separator);
  return result;
}

}  // namespace

std::string kebab_case(std::string_view name) { return with_separator(name, '-'); }

std::string snake_case(std::string_view name) { return with_separator(name, '_'); }

bool is_same_name(std::string_view a, std::string_view b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char c, char d) {
           return c == d || with_separator(c, '-') == with_separator(d, '-');
         });
}

bool is_path_safe(std::string_view name) {
  if (name.empty() || name.front() == '.' || name.front() == '-') return false;
  return std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-';
  });
}

}  // namespace base
