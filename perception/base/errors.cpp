#include "perception/base/errors.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "perception/base/names.h"

namespace base {

namespace {

/// Edit distance of two words (insertions, deletions, substitutions), Levenshtein 1966.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row.back();
}

}  // namespace

std::string to_string(const Place& place) {
  if (place.line <= 0) return place.file;
  if (place.column <= 0) return fmt::format("{}:{}", place.file, place.line);
  return fmt::format("{}:{}:{}", place.file, place.line, place.column);
}

InputError::InputError(const std::string& message) : std::runtime_error(message) {}

InputError::InputError(const Place& place, const std::string& message)
    : std::runtime_error(place.file.empty() ? message : to_string(place) + ": " + message) {}

DeviceError::DeviceError(const std::string& message) : std::runtime_error(message) {}

std::string unknown_name(std::string_view kind, std::string_view name,
                         std::span<const std::string> known) {
  std::string message = fmt::format("unknown {} \"{}\"", kind, name);
  const std::string wanted = kebab_case(name);
  const std::string* nearest = nullptr;
  std::size_t nearest_distance = std::max<std::size_t>(1, wanted.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(wanted, kebab_case(candidate));
    if (distance < nearest_distance) {
      nearest = &candidate;
      nearest_distance = distance;
    }
  }
  if (nearest != nullptr) message += fmt::format("; did you mean \"{}\"?", *nearest);
  message += nearest != nullptr ? " known: " : "; known: ";
  message += known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "));
  return message;
}

}  // namespace base
