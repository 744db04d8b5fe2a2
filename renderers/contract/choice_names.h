#pragma once

#include <algorithm>
#include <cassert>
#include <string>
#include <string_view>
#include <vector>

namespace renderers {

/// Names of a table of (name, enumerator) pairs, for a parameter that is a choice.
template <typename Table>
std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  for (const auto& entry : table) names.emplace_back(entry.first);
  return names;
}

/// The enumerator of a name. @param name  one of the table's
template <typename Table>
auto value_of(const Table& table, std::string_view name) {
  const auto found = std::ranges::find_if(
      table, [&](const auto& entry) { return std::string_view(entry.first) == name; });
  assert(found != table.end());
  return found->second;
}

}  // namespace renderers
