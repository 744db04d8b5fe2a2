#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "perception/base/errors.h"
#include "results/run_record.h"

namespace results {

/// What a row of a run is known by, beside its times and scores.
struct RowFacts {
  std::string scene;         ///< id, sweep values included: "room[light=high]"
  std::string base_scene;    ///< "room"
  std::string method;        ///< id, sweep values included: "val[vals=30]"
  std::string base_method;   ///< "val"
  std::string budget;        ///< "64spp"
  ParameterValues sweep;     ///< of the scene, then of the method: columns
  ParameterValues settings;  ///< all parameters of the method, then "renderer" and "preset"

  /// The value of a swept value or a parameter, "scene", "method" or "budget"; null if unknown.
  const base::ParameterValue* find(std::string_view key) const;
};

/// One condition of a selector: `vals=2|5|10`, `vals=2..30`, `clamp>=0.1`, `scene=horse`,
/// `budget='relmse=0.05'`.
struct RowCondition {
  enum class Relation { equal, unequal, less, less_or_equal, greater, greater_or_equal };
  std::string key;
  Relation relation = Relation::equal;
  /// Alternatives; a range "2..30" is a pair of its ends, any other value a pair of itself.
  std::vector<std::pair<std::string, std::string>> values;
  std::size_t position = 0;  ///< in the text that it was read from
};

/// Rows by method and conditions: `val`, `val[vals=30]`, `*[scene=horse, budget=64spp]`.
///
/// A method is named by its id, or by what its id is before the sweep values, which means all of
/// them; `*` is every method. A condition's key is a swept value, a parameter, `renderer`,
/// `preset`, `scene` (with or without its sweep values) or `budget`; numbers compare as numbers.
/// A row that lacks the key does not match.
struct RowSelector {
  std::string method = "*";
  std::vector<RowCondition> conditions;
  std::size_t position = 0;  ///< in the text that it was read from
  std::string text;          ///< as it was written

  bool matches(const RowFacts& row) const;
};

/// Reads a selector that starts at `position` of `text` and moves `position` behind it.
/// @param place  of the text; messages say the column within it
/// @throws base::InputError with the place of the character that is wrong
RowSelector read_row_selector(std::string_view text, std::size_t& position,
                              const base::Place& place);
/// A text that holds nothing else.
RowSelector parse_row_selector(std::string_view text, const base::Place& place);

/// Indices of the rows that match.
/// @throws base::InputError with the place if no row has the method, or one of the keys: names
///   those that exist. An empty result is no error: the values may be those of another profile.
std::vector<std::size_t> select_rows(const std::vector<RowFacts>& rows, const RowSelector& selector,
                                     const base::Place& place);

/// Whether two numbers stand in a relation.
bool holds(double left, RowCondition::Relation relation, double right);

/// The place `position` characters into a text that starts at `place`.
base::Place place_within(const base::Place& place, std::size_t position);

/// A number if the whole text is one.
std::optional<double> parsed_number(std::string_view text);
/// A number, or 1 and 0 for true and false; nothing for text.
std::optional<double> number_of(const base::ParameterValue& value);
/// "30", "0.5", "true", "ray".
std::string text_of(const base::ParameterValue& value);

}  // namespace results
