#include "results/claims/expectation.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "results/row_selector.h"

namespace results::claims {
namespace {

using Kind = Expectation::Kind;

constexpr const char* kForms =
    ">= 0.95, <= 40%, > 1, < 1, = 16, = 34.1 within 5%, = 0.5 within 0.02, in 0.4..0.6, "
    "increasing, "
    "decreasing, rises, falls, largest, smallest, printed";

constexpr std::array<std::pair<std::string_view, Kind>, 7> kWords{{
    {"increasing", Kind::increasing},
    {"decreasing", Kind::decreasing},
    {"rises", Kind::rises},
    {"falls", Kind::falls},
    {"largest", Kind::largest},
    {"smallest", Kind::smallest},
    {"printed", Kind::printed},
}};

/// A number as it was written.
struct WrittenNumber {
  double value = 0.0;
  bool is_percent = false;
};

class ExpectationReader {
 public:
  ExpectationReader(std::string_view text, const base::Place& place) : text_(text), place_(place) {}

  Expectation read() {
    expectation_.text = std::string(text_);
    const bool is_word = std::any_of(kWords.begin(), kWords.end(),
                                     [&](const auto& word) { return take(word.first); });
    if (is_word) {
      read_word();
    } else {
      read_bound();
    }
    skip_space();
    if (position_ < text_.size()) fail();
    return expectation_;
  }

 private:
  void skip_space() {
    while (position_ < text_.size() &&
           std::isspace(static_cast<unsigned char>(text_[position_])) != 0) {
      ++position_;
    }
  }

  bool take(std::string_view word) {
    skip_space();
    if (text_.substr(position_, word.size()) != word) return false;
    position_ += word.size();
    return true;
  }

  [[noreturn]] void fail() const {
    const std::string found =
        position_ < text_.size() ? fmt::format("\"{}\"", text_[position_]) : "the end";
    throw base::InputError(place_within(place_, position_),
                           fmt::format("\"{}\": {} at character {}; accepted: {}", text_, found,
                                       position_ + 1, kForms));
  }

  WrittenNumber read_number() {
    skip_space();
    WrittenNumber number;
    const char* const begin = text_.data() + position_;
    // "0.4..0.6" ends the first number before the dots.
    const std::size_t dots = text_.find("..", position_);
    const char* const end_of_text =
        dots == std::string_view::npos ? text_.data() + text_.size() : text_.data() + dots;
    const auto [end, error] = std::from_chars(begin, end_of_text, number.value);
    if (error != std::errc() || !std::isfinite(number.value)) fail();
    position_ += static_cast<std::size_t>(end - begin);
    number.is_percent = position_ < text_.size() && text_[position_] == '%';
    if (number.is_percent) {
      ++position_;
      number.value /= 100.0;
    }
    return number;
  }

  void read_word() {
    const auto word = std::find_if(kWords.begin(), kWords.end(), [&](const auto& candidate) {
      return text_.substr(0, position_).ends_with(candidate.first);
    });
    expectation_.kind = word->second;
  }

  void read_bound() {
    if (take(">=")) {
      expectation_.low = read_number().value;
    } else if (take("<=")) {
      expectation_.high = read_number().value;
    } else if (take(">")) {
      expectation_.low = read_number().value;
      expectation_.includes_low = false;
    } else if (take("<")) {
      expectation_.high = read_number().value;
      expectation_.includes_high = false;
    } else if (take("=")) {
      read_equality();
    } else if (take("in")) {
      read_range();
    } else {
      fail();
    }
  }

  void read_equality() {
    const double value = read_number().value;
    double tolerance = kEqualityTolerance * std::abs(value);
    if (take("within")) {
      const WrittenNumber within = read_number();
      tolerance = within.is_percent ? within.value * std::abs(value) : within.value;
    }
    expectation_.low = value - tolerance;
    expectation_.high = value + tolerance;
  }

  void read_range() {
    expectation_.low = read_number().value;
    if (!take("..")) fail();
    const std::size_t position = position_;
    expectation_.high = read_number().value;
    if (expectation_.high >= expectation_.low) return;
    position_ = position;
    fail();
  }

  std::string_view text_;
  const base::Place& place_;
  std::size_t position_ = 0;
  Expectation expectation_;
};

}  // namespace

bool Expectation::is_below(double value) const { return includes_low ? value < low : value <= low; }

bool Expectation::is_above(double value) const {
  return includes_high ? value > high : value >= high;
}

bool Expectation::includes(double value) const { return !is_below(value) && !is_above(value); }

Expectation parse_expectation(std::string_view text, const base::Place& place) {
  return ExpectationReader(text, place).read();
}

}  // namespace results::claims
