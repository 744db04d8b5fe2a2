#include "results/claims/judgement.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "perception/base/units.h"
#include "results/claims/row_functions.h"
#include "results/statistics.h"

namespace results::claims {
namespace {

using Kind = Expectation::Kind;

constexpr std::size_t kFewestForTrend = 3;

Verdict verdict_of(const Expectation& expectation, const Number& number) {
  const Interval interval = interval_of(number).value_or(Interval{number.value, number.value});
  if (expectation.includes(interval.low) && expectation.includes(interval.high)) {
    return Verdict::reproduced;
  }
  const bool is_outside = expectation.is_below(interval.high) || expectation.is_above(interval.low);
  return is_outside ? Verdict::not_reproduced : Verdict::inconclusive;
}

/// The verdict on one number. @param what  names it in the reason; "" for the claim's only one
Judgement judge_number(const Expectation& expectation, const Number& number,
                       const std::string& what) {
  const Verdict verdict = verdict_of(expectation, number);
  if (verdict == Verdict::reproduced) return {verdict, ""};
  const char* words = verdict == Verdict::not_reproduced ? "is not" : "may be or may not be";
  return {verdict,
          fmt::format("{}{} {} {}", what.empty() ? "" : what + ": ",
                      format_number(number.value, interval_of(number)), words, expectation.text)};
}

/// The worst of several: one that is not reproduced, else one that is inconclusive.
void add(Judgement judgement, Judgement& all) {
  if (all.verdict == Verdict::not_reproduced || judgement.verdict == Verdict::reproduced) return;
  if (all.verdict == Verdict::reproduced || judgement.verdict == Verdict::not_reproduced) {
    all = std::move(judgement);
  }
}

Number difference(const Number& left, const Number& right) {
  const std::array<const Number*, 2> both{&left, &right};
  return combine(both, [](std::span<const double> in) { return in[0] - in[1]; });
}

Expectation above_zero() {
  Expectation expectation;
  expectation.low = 0.0;
  expectation.includes_low = false;
  expectation.text = "> 0";
  return expectation;
}

std::string pair_text(const Element& greater, const Element& less) {
  return fmt::format("{} less {}", greater.label, less.label);
}

Judgement judge_order(const Value& value, bool is_increasing) {
  Judgement all{Verdict::reproduced, ""};
  for (std::size_t i = 0; i + 1 < value.elements.size(); ++i) {
    const Element& greater = value.elements[is_increasing ? i + 1 : i];
    const Element& less = value.elements[is_increasing ? i : i + 1];
    add(judge_number(above_zero(), difference(greater.number, less.number),
                     pair_text(greater, less)),
        all);
  }
  return all;
}

/// Whether the first is the greatest, or the least, of all.
Judgement judge_extreme(const Value& value, bool is_largest) {
  Judgement all{Verdict::reproduced, ""};
  const Element& first = value.elements.front();
  for (std::size_t i = 1; i < value.elements.size(); ++i) {
    const Element& greater = is_largest ? first : value.elements[i];
    const Element& less = is_largest ? value.elements[i] : first;
    add(judge_number(above_zero(), difference(greater.number, less.number),
                     pair_text(greater, less)),
        all);
  }
  return all;
}

Judgement judge_trend(const Value& value, bool is_rising) {
  if (value.elements.size() < kFewestForTrend) {
    throw base::InputError(fmt::format("a trend needs at least {} values; there are {}",
                                       kFewestForTrend, value.elements.size()));
  }
  std::vector<double> places;
  std::vector<Number> numbers;
  for (const Element& element : value.elements) {
    places.push_back(element.x.value_or(static_cast<double>(places.size())));
    numbers.push_back(element.number);
  }
  const Number correlation = reduce(numbers, [&](std::span<const double> values) {
    return rank_correlation(places, values).value_or(0.0);
  });
  Expectation trend;
  (is_rising ? trend.low : trend.high) = is_rising ? kTrendCorrelation : -kTrendCorrelation;
  trend.text = fmt::format(
      "{} {}", is_rising ? ">=" : "<=", is_rising ? kTrendCorrelation : -kTrendCorrelation);
  return judge_number(trend, correlation, "Spearman's correlation");
}

Judgement judge_bound(const Expectation& expectation, const Value& value) {
  Judgement all{Verdict::reproduced, ""};
  for (const Element& element : value.elements) {
    add(judge_number(expectation, element.number, value.is_list ? element.label : ""), all);
  }
  return all;
}

/// "gather" of "gather/visibility"; "" of a top-level stage.
std::string parent_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

bool is_same_or_within(const std::string& path, const std::string& outer) {
  return path == outer || path.starts_with(outer + "/");
}

/// Whether time of a stage is compared with that of the named ones.
bool is_beside(const std::string& path, const std::vector<Quantity>& stages) {
  if (("/" + path + "/").find("/readback/") != std::string::npos) return false;
  const bool overlaps = std::any_of(stages.begin(), stages.end(), [&](const Quantity& stage) {
    return is_same_or_within(path, stage.name) || is_same_or_within(stage.name, path);
  });
  if (overlaps) return false;
  const std::string parent = parent_of(path);
  return parent.empty() || std::any_of(stages.begin(), stages.end(), [&](const Quantity& stage) {
           return parent_of(stage.name) == parent;
         });
}

}  // namespace

Judgement judge(const Expectation& expectation, const Value& value) {
  switch (expectation.kind) {
    case Kind::bound:
      return judge_bound(expectation, value);
    case Kind::increasing:
    case Kind::decreasing:
      return judge_order(value, expectation.kind == Kind::increasing);
    case Kind::rises:
    case Kind::falls:
      return judge_trend(value, expectation.kind == Kind::rises);
    case Kind::largest:
    case Kind::smallest:
      return judge_extreme(value, expectation.kind == Kind::largest);
    case Kind::printed:
      break;
  }
  return {Verdict::printed, ""};
}

Value shares_beside(const Expression& share, Evaluation& evaluation) {
  const std::vector<std::size_t> rows = selected_rows(share.parts.front(), evaluation);
  const std::vector<Quantity> stages = stages_of(share.parts.back(), evaluation);
  std::set<std::string> rivals;
  for (const std::size_t row : rows) {
    for (const std::string& path : evaluation.numbers.stage_paths(row)) {
      if (is_beside(path, stages)) rivals.insert(path);
    }
  }
  if (rivals.empty()) {
    throw base::InputError(fmt::format("{}: there is no other stage", share.text));
  }
  Value shares;
  shares.is_list = true;
  shares.elements.push_back(
      {share.parts.back().text, std::nullopt, median_share(rows, stages, true, evaluation)});
  for (const std::string& path : rivals) {
    Quantity rival = stages.front();
    rival.name = rival.text = path;
    const Number number = median_share(rows, std::span(&rival, 1), false, evaluation);
    add_part(evaluation, fmt::format("share of {}", path), number, rows.size());
    shares.elements.push_back({path, std::nullopt, number});
  }
  return shares;
}

std::string interval_note(const Number& number) {
  if (number.single_rows.empty()) return "";
  if (number.replicates.empty()) {
    return "rests on the value: no row behind it has two repetitions or seeds";
  }
  const std::size_t count = number.single_rows.size();
  return fmt::format("the interval leaves out {} {} of a single sample", count,
                     count == 1 ? "row" : "rows");
}

std::string format_number(double value, const std::optional<Interval>& interval) {
  constexpr int kDigits = 4;
  const std::string text = base::format_significant(value, kDigits);
  if (!interval) return text;
  return fmt::format("{} [{}, {}]", text, base::format_significant(interval->low, kDigits),
                     base::format_significant(interval->high, kDigits));
}

}  // namespace results::claims
