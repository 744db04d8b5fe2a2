#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "results/claims/expression.h"
#include "results/claims/function_table.h"

namespace results::claims {
namespace {

using Kind = Expression::Kind;
using Relation = RowCondition::Relation;

constexpr std::array<std::pair<std::string_view, Relation>, 6> kRelations{{
    {"<=", Relation::less_or_equal},
    {">=", Relation::greater_or_equal},
    {"!=", Relation::unequal},
    {"=", Relation::equal},
    {"<", Relation::less},
    {">", Relation::greater},
}};

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// A quantity's name runs on over these: gather/visibility, flip.p99@full, visible-difference.
bool is_name_character(char c) {
  return is_digit(c) || is_letter(c) || std::string_view("_-./@").find(c) != std::string_view::npos;
}

/// What may stand where a value is read.
enum class Scope {
  values,  ///< of the whole run: functions of rows
  rows     ///< of every row: names of quantities
};

/// Recursive descent: sum of products of factors.
class ExpressionReader {
 public:
  ExpressionReader(std::string_view text, const base::Place& place) : text_(text), place_(place) {}

  Expression read() {
    Expression expression = read_sum(Scope::values);
    if (position_ < text_.size()) fail("+ - * / or the end");
    return expression;
  }

 private:
  char peek() {
    while (position_ < text_.size() && is_space(text_[position_])) ++position_;
    return position_ < text_.size() ? text_[position_] : '\0';
  }

  bool take(char c) {
    if (peek() != c) return false;
    ++position_;
    return true;
  }

  [[noreturn]] void fail_at(std::size_t position, const std::string& message) const {
    throw base::InputError(place_within(place_, position),
                           fmt::format("\"{}\": {}", text_, message));
  }

  [[noreturn]] void fail(const std::string& accepted) {
    const std::string found = peek() == '\0' ? "the end" : fmt::format("\"{}\"", text_[position_]);
    fail_at(position_,
            fmt::format("{} at character {}; accepted: {}", found, position_ + 1, accepted));
  }

  Expression start(Kind kind) {
    peek();
    Expression expression;
    expression.kind = kind;
    expression.position = position_;
    return expression;
  }

  Expression finished(Expression expression) const {
    std::size_t end = position_;
    while (end > expression.position && is_space(text_[end - 1])) --end;
    expression.text = std::string(text_.substr(expression.position, end - expression.position));
    return expression;
  }

  /// Joins two sides of an operator.
  Expression joined(char sign, Expression left, Expression right) const {
    Expression whole;
    whole.kind = Kind::operation;
    whole.sign = sign;
    whole.position = left.position;
    whole.parts.push_back(std::move(left));
    whole.parts.push_back(std::move(right));
    return finished(std::move(whole));
  }

  Expression read_sum(Scope scope) {
    Expression sum = read_product(scope);
    while (peek() == '+' || peek() == '-') {
      const char sign = text_[position_++];
      sum = joined(sign, std::move(sum), read_product(scope));
    }
    return sum;
  }

  Expression read_product(Scope scope) {
    Expression product = read_factor(scope);
    while (peek() == '*' || peek() == '/') {
      const char sign = text_[position_++];
      product = joined(sign, std::move(product), read_factor(scope));
    }
    return product;
  }

  Expression read_factor(Scope scope) {
    const char next = peek();
    if (next == '-') {
      Expression negation = start(Kind::operation);
      negation.sign = '-';
      ++position_;
      negation.parts.push_back(read_factor(scope));
      return finished(std::move(negation));
    }
    if (next == '(') {
      const std::size_t open = position_++;
      Expression inside = read_sum(scope);
      if (!take(')')) fail(") or + - * /");
      inside.position = open;
      return finished(std::move(inside));
    }
    if (is_digit(next) || next == '.') return read_number();
    if (scope == Scope::rows) return read_name();
    if (is_letter(next)) return read_call(scope);
    fail("a number, -, ( or a function, e.g. median(val, total_s)");
  }

  Expression read_number() {
    Expression number = start(Kind::number);
    const bool is_negative = take('-');
    const char* const begin = text_.data() + position_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), number.number);
    if (error != std::errc() || (*begin != '.' && !is_digit(*begin))) fail("a number");
    position_ += static_cast<std::size_t>(end - begin);
    if (is_negative) number.number = -number.number;
    return finished(std::move(number));
  }

  /// A function's name: letters, digits and _.
  std::string_view read_function_name() {
    const std::size_t begin = position_;
    while (position_ < text_.size() &&
           (is_letter(text_[position_]) || is_digit(text_[position_]) || text_[position_] == '_')) {
      ++position_;
    }
    return text_.substr(begin, position_ - begin);
  }

  Expression read_call(Scope scope) {
    Expression call = start(Kind::call);
    const std::string_view name = read_function_name();
    call.function = find_function(name);
    if (call.function == nullptr) {
      std::vector<std::string> known;
      for (const Function& function : function_table()) known.emplace_back(function.name);
      fail_at(call.position, base::unknown_name("function", name, known));
    }
    if (scope == Scope::rows && call.function->elementwise == nullptr) {
      fail_at(call.position, fmt::format("{} is no function of a row's quantities; accepted there: "
                                         "abs, sqrt, log2",
                                         name));
    }
    if (!take('(')) fail(call.function->signature);
    read_arguments(call, scope);
    return finished(std::move(call));
  }

  void read_arguments(Expression& call, Scope scope) {
    const Function& function = *call.function;
    for (std::size_t i = 0; i < function.arguments.size(); ++i) {
      if (i > 0 && !take(',')) fail(fmt::format(", as in {}", function.signature));
      if (peek() == ')') fail(function.signature);
      call.parts.push_back(read_argument(function.arguments[i], scope));
    }
    const bool repeats = function.arguments.back() == ArgumentKind::values;
    while (repeats && take(',')) call.parts.push_back(read_argument(ArgumentKind::values, scope));
    if (!take(')')) fail(fmt::format(") as in {}", function.signature));
  }

  Expression read_argument(ArgumentKind kind, Scope scope) {
    switch (kind) {
      case ArgumentKind::rows:
        return read_rows();
      case ArgumentKind::quantity:
        return read_quantity();
      case ArgumentKind::stages:
        return read_stages();
      case ArgumentKind::condition:
        return read_condition();
      case ArgumentKind::number:
        return read_number();
      case ArgumentKind::formula:
      case ArgumentKind::axis:
        return read_sum(Scope::rows);
      default:
        return read_sum(scope);
    }
  }

  Expression read_rows() {
    Expression rows = start(Kind::rows);
    rows.selector = read_row_selector(text_, position_, place_);
    return finished(std::move(rows));
  }

  /// A name, in ' ' if it has other characters: 'relmse,trim=0.001'. Of a function: its call.
  Expression read_name() {
    Expression quantity = start(Kind::quantity);
    if (take('\'')) {
      const std::size_t close = text_.find('\'', position_);
      if (close == std::string_view::npos) fail("a name with its closing '");
      quantity.name = std::string(text_.substr(position_, close - position_));
      position_ = close + 1;
      return finished(std::move(quantity));
    }
    if (!is_letter(peek())) fail("the name of a quantity, e.g. total_s, gather/visibility, relmse");
    const std::size_t begin = position_;
    while (position_ < text_.size() && is_name_character(text_[position_])) ++position_;
    quantity.name = std::string(text_.substr(begin, position_ - begin));
    if (peek() != '(') return finished(std::move(quantity));
    position_ = begin;
    return read_call(Scope::rows);
  }

  Expression read_quantity() {
    Expression quantity = read_name();
    if (quantity.kind == Kind::quantity) return quantity;
    fail_at(quantity.position,
            fmt::format("\"{}\" is a formula; accepted here: one quantity", quantity.text));
  }

  Expression read_stages() {
    Expression stages = read_quantity();
    while (take('+')) stages = joined('+', std::move(stages), read_quantity());
    return stages;
  }

  Expression read_condition() {
    Expression condition = start(Kind::condition);
    condition.parts.push_back(read_sum(Scope::rows));
    peek();
    const auto relation =
        std::find_if(kRelations.begin(), kRelations.end(), [&](const auto& candidate) {
          return text_.substr(position_, candidate.first.size()) == candidate.first;
        });
    if (relation == kRelations.end()) fail("= != < <= > >= and a number");
    position_ += relation->first.size();
    condition.relation = relation->second;
    condition.number = read_number().number;
    return finished(std::move(condition));
  }

  std::string_view text_;
  const base::Place& place_;
  std::size_t position_ = 0;
};

}  // namespace

Expression parse_expression(std::string_view text, const base::Place& place) {
  return ExpressionReader(text, place).read();
}

}  // namespace results::claims
