#include "results/row_selector.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <variant>

#include <fmt/format.h>

#include "perception/base/names.h"

namespace results {
namespace {

bool is_name_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
}

/// Reads one selector; keeps where it is.
class SelectorReader {
 public:
  SelectorReader(std::string_view text, std::size_t& position, const base::Place& place)
      : text_(text), position_(position), place_(place) {}

  RowSelector read() {
    RowSelector selector;
    skip_space();
    selector.position = position_;
    if (peek() == '*') {
      ++position_;
    } else {
      selector.method = read_name("a method, e.g. val[vals=30], or *");
    }
    if (peek() == '[') read_conditions(selector);
    selector.text = std::string(text_.substr(selector.position, position_ - selector.position));
    return selector;
  }

 private:
  char peek() const { return position_ < text_.size() ? text_[position_] : '\0'; }

  void skip_space() {
    while (std::isspace(static_cast<unsigned char>(peek())) != 0) ++position_;
  }

  [[noreturn]] void fail(const std::string& accepted) const {
    const std::string found =
        position_ < text_.size() ? fmt::format("\"{}\"", text_[position_]) : "the end";
    throw base::InputError(place_within(place_, position_),
                           fmt::format("\"{}\": {} at character {}; accepted: {}", text_, found,
                                       position_ + 1, accepted));
  }

  std::string read_name(const char* accepted) {
    const std::size_t start = position_;
    while (is_name_character(peek())) ++position_;
    if (position_ == start) fail(accepted);
    return std::string(text_.substr(start, position_ - start));
  }

  /// Any text between single quotes, such as a budget: 'relmse=0.05'.
  std::string read_quoted() {
    const std::size_t close = text_.find('\'', position_ + 1);
    if (close == std::string_view::npos) fail("a text with its closing '");
    const std::string value(text_.substr(position_ + 1, close - position_ - 1));
    position_ = close + 1;
    return value;
  }

  /// A value may hold brackets of its own where it is a scene's id: room[light=high].
  std::string read_value() {
    skip_space();
    if (peek() == '\'') return read_quoted();
    const std::size_t start = position_;
    while (is_name_character(peek()) || peek() == '+') {
      if (text_.substr(position_, 2) == "..") break;
      ++position_;
    }
    if (position_ == start) fail("a value");
    if (peek() == '[') {
      const std::size_t close = text_.find(']', position_);
      if (close == std::string_view::npos) fail("a value with its closing ]");
      position_ = close + 1;
    }
    return std::string(text_.substr(start, position_ - start));
  }

  RowCondition::Relation read_relation() {
    using Relation = RowCondition::Relation;
    static constexpr std::array<std::pair<std::string_view, Relation>, 7> kRelations{{
        {"<=", Relation::less_or_equal},
        {">=", Relation::greater_or_equal},
        {"!=", Relation::unequal},
        {"==", Relation::equal},
        {"=", Relation::equal},
        {"<", Relation::less},
        {">", Relation::greater},
    }};
    skip_space();
    for (const auto& [sign, relation] : kRelations) {
      if (text_.substr(position_, sign.size()) != sign) continue;
      position_ += sign.size();
      return relation;
    }
    fail("= != < <= > >=");
  }

  void read_conditions(RowSelector& selector) {
    do {
      ++position_;
      skip_space();
      RowCondition condition;
      condition.position = position_;
      condition.key = read_name("a condition, e.g. vals=30");
      condition.relation = read_relation();
      read_alternatives(condition);
      selector.conditions.push_back(std::move(condition));
      skip_space();
    } while (peek() == ',');
    if (peek() != ']') fail(", or ]");
    ++position_;
  }

  void read_alternatives(RowCondition& condition) {
    using Relation = RowCondition::Relation;
    const bool has_many =
        condition.relation == Relation::equal || condition.relation == Relation::unequal;
    for (;;) {
      const std::string low = read_value();
      std::string high = low;
      if (has_many && text_.substr(position_, 2) == "..") {
        position_ += 2;
        high = read_value();
      }
      condition.values.emplace_back(low, high);
      skip_space();
      if (!has_many || peek() != '|') return;
      ++position_;
    }
  }

  std::string_view text_;
  std::size_t& position_;
  const base::Place& place_;
};

bool is_one_of(const base::ParameterValue& value, const RowCondition& condition) {
  const std::optional<double> number = number_of(value);
  return std::any_of(condition.values.begin(), condition.values.end(),
                     [&](const auto& alternative) {
                       const std::optional<double> low = parsed_number(alternative.first);
                       const std::optional<double> high = parsed_number(alternative.second);
                       if (number && low && high) return *number >= *low && *number <= *high;
                       return base::is_same_name(text_of(value), alternative.first);
                     });
}

bool is_met(const RowCondition& condition, const RowFacts& row) {
  const base::ParameterValue* value = row.find(condition.key);
  if (value == nullptr) return false;
  using Relation = RowCondition::Relation;
  if (condition.relation == Relation::equal || condition.relation == Relation::unequal) {
    bool is_equal = is_one_of(*value, condition);
    // A scene may be named without its sweep values.
    if (!is_equal && condition.key == "scene") is_equal = is_one_of(row.base_scene, condition);
    return is_equal == (condition.relation == Relation::equal);
  }
  const std::optional<double> left = number_of(*value);
  const std::optional<double> right = parsed_number(condition.values.front().first);
  return left && right && holds(*left, condition.relation, *right);
}

bool names_method(const RowFacts& row, const std::string& method) {
  return method == "*" || base::is_same_name(row.method, method) ||
         base::is_same_name(row.base_method, method);
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

}  // namespace

bool holds(double left, RowCondition::Relation relation, double right) {
  using Relation = RowCondition::Relation;
  switch (relation) {
    case Relation::less:
      return left < right;
    case Relation::less_or_equal:
      return left <= right;
    case Relation::greater:
      return left > right;
    case Relation::greater_or_equal:
      return left >= right;
    case Relation::equal:
    case Relation::unequal:
      break;
  }
  return left == right;
}

const base::ParameterValue* RowFacts::find(std::string_view key) const {
  for (const ParameterValues* values : {&sweep, &settings}) {
    for (const auto& [name, value] : *values) {
      if (base::is_same_name(name, key)) return &value;
    }
  }
  return nullptr;
}

bool RowSelector::matches(const RowFacts& row) const {
  return names_method(row, method) &&
         std::all_of(conditions.begin(), conditions.end(),
                     [&](const RowCondition& condition) { return is_met(condition, row); });
}

RowSelector read_row_selector(std::string_view text, std::size_t& position,
                              const base::Place& place) {
  return SelectorReader(text, position, place).read();
}

RowSelector parse_row_selector(std::string_view text, const base::Place& place) {
  std::size_t position = 0;
  RowSelector selector = read_row_selector(text, position, place);
  if (position == text.size()) return selector;
  throw base::InputError(
      place_within(place, position),
      fmt::format("\"{}\": \"{}\" follows a selector that is complete; accepted: "
                  "one method with its conditions, e.g. val[vals=30]",
                  text, text.substr(position)));
}

std::vector<std::size_t> select_rows(const std::vector<RowFacts>& rows, const RowSelector& selector,
                                     const base::Place& place) {
  std::vector<std::size_t> of_method;
  std::vector<std::string> methods;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    add_once(methods, rows[i].base_method);
    if (names_method(rows[i], selector.method)) of_method.push_back(i);
  }
  if (of_method.empty()) {
    throw base::InputError(place_within(place, selector.position),
                           base::unknown_name("method", selector.method, methods));
  }
  for (const RowCondition& condition : selector.conditions) {
    const bool is_known = std::any_of(of_method.begin(), of_method.end(), [&](std::size_t row) {
      return rows[row].find(condition.key) != nullptr;
    });
    if (is_known) continue;
    std::vector<std::string> keys;
    for (const std::size_t row : of_method) {
      for (const auto& [name, value] : rows[row].sweep) add_once(keys, name);
      for (const auto& [name, value] : rows[row].settings) add_once(keys, name);
    }
    throw base::InputError(place_within(place, condition.position),
                           base::unknown_name("key", condition.key, keys));
  }
  std::vector<std::size_t> selected;
  std::copy_if(of_method.begin(), of_method.end(), std::back_inserter(selected),
               [&](std::size_t row) { return selector.matches(rows[row]); });
  return selected;
}

base::Place place_within(const base::Place& place, std::size_t position) {
  base::Place within = place;
  if (within.line > 0) within.column += static_cast<int>(position);
  return within;
}

std::optional<double> parsed_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> number_of(const base::ParameterValue& value) {
  struct Number {
    std::optional<double> operator()(bool held) const { return held ? 1.0 : 0.0; }
    std::optional<double> operator()(std::int64_t held) const { return static_cast<double>(held); }
    std::optional<double> operator()(double held) const { return held; }
    std::optional<double> operator()(const std::string& held) const { return parsed_number(held); }
  };
  return std::visit(Number(), value);
}

std::string text_of(const base::ParameterValue& value) {
  return std::visit([](const auto& held) { return fmt::format("{}", held); }, value);
}

}  // namespace results
