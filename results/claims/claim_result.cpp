#include "results/claims/claim_result.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "results/claims/function_table.h"
#include "results/claims/judgement.h"
#include "results/json_fields.h"

namespace results::claims {

using nlohmann::ordered_json;

namespace {

constexpr std::array<Verdict, 5> kVerdicts{Verdict::reproduced, Verdict::not_reproduced,
                                           Verdict::inconclusive, Verdict::not_comparable,
                                           Verdict::printed};

/// The value of the measure; several measures are the elements of a list.
Value measured_value(const std::vector<Expression>& measures, Evaluation& evaluation) {
  if (measures.size() == 1) return evaluate_expression(measures.front(), evaluation);
  Value list;
  list.is_list = true;
  for (const Expression& measure : measures) {
    list.elements.push_back({measure.text, std::nullopt, evaluate_number(measure, evaluation)});
  }
  return list;
}

void require_finite(const Value& value) {
  for (const Element& element : value.elements) {
    if (std::isfinite(element.number.value)) continue;
    throw base::InputError(fmt::format("{}{} is not a finite number", element.label,
                                       element.label.empty() ? "the value" : ""));
  }
}

bool is_share(const std::vector<Expression>& measures) {
  return measures.size() == 1 && measures.front().kind == Expression::Kind::call &&
         measures.front().function->name == "share";
}

/// All rows behind a value that have one sample, and whether anything was drawn again.
std::string note_of(const Value& value) {
  std::vector<const Number*> numbers;
  for (const Element& element : value.elements) numbers.push_back(&element.number);
  return interval_note(combine(numbers, [](std::span<const double>) { return 0.0; }));
}

void add_reason(ClaimResult& result, const std::string& reason) {
  if (!reason.empty()) result.reason += (result.reason.empty() ? "" : "; ") + reason;
}

/// Fills in value, interval, verdict and reason. @throws base::InputError if there is no value
void measure_and_judge(ClaimResult& result, Evaluation& evaluation) {
  std::vector<Expression> measures;
  for (const std::string& text : result.claim.measures) {
    measures.push_back(parse_expression(text, {}));
  }
  const Expectation expectation = parse_expectation(result.claim.expect, {});
  Value value = measured_value(measures, evaluation);
  require_finite(value);
  if (value.is_list) {
    for (const Element& element : value.elements) {
      result.elements.push_back(
          {element.label, element.number.value, interval_of(element.number), 0});
    }
  } else {
    result.value = value.elements.front().number.value;
    result.interval = interval_of(value.elements.front().number);
  }
  const bool is_extreme = expectation.kind == Expectation::Kind::largest ||
                          expectation.kind == Expectation::Kind::smallest;
  if (is_extreme && is_share(measures)) value = shares_beside(measures.front(), evaluation);
  const Judgement judgement = judge(expectation, value);
  result.verdict = judgement.verdict;
  result.reason = judgement.reason;
  add_reason(result, note_of(value));
  if (!evaluation.left_out.empty()) {
    add_reason(result, fmt::format("left out at the noise of the reference: {}",
                                   fmt::join(evaluation.left_out, ", ")));
  }
}

/// What outweighs the numbers: the claim cannot be compared, or is of another profile.
void apply_scope(ClaimResult& result, const std::string& profile) {
  const Claim& claim = result.claim;
  if (claim.comparable == Comparable::no) {
    result.verdict = Verdict::not_comparable;
    result.reason = claim.comparable_reason;
    return;
  }
  const bool counts =
      claim.profiles.empty() ||
      std::find(claim.profiles.begin(), claim.profiles.end(), profile) != claim.profiles.end();
  if (counts) return;
  result.verdict = Verdict::inconclusive;
  const std::string reason =
      fmt::format("the run has profile {}; the claim counts for {}",
                  profile.empty() ? "none" : profile, fmt::join(claim.profiles, ", "));
  result.reason = result.reason.empty() ? reason : reason + "; " + result.reason;
}

ClaimResult evaluate_with(const Claim& claim, RowNumbers& numbers) {
  ClaimResult result;
  result.claim = claim;
  Evaluation evaluation{numbers, {}, claim.below_noise, {}};
  // A claim is to its suite what a cell is to a run: its failure is a record.
  try {
    measure_and_judge(result, evaluation);
  } catch (const base::InputError& error) {
    result.verdict = Verdict::inconclusive;
    result.reason = error.what();
  }
  result.parts = std::move(evaluation.parts);
  apply_scope(result, numbers.values().run().info->value("profile", ""));
  return result;
}

ordered_json to_json(const ClaimPart& part) {
  return {{"text", part.text},
          {"value", finite_or_null(part.value)},
          {"low", part.interval ? finite_or_null(part.interval->low) : ordered_json()},
          {"high", part.interval ? finite_or_null(part.interval->high) : ordered_json()},
          {"rows", part.rows}};
}

ordered_json to_json(const ClaimResult& result) {
  const Claim& claim = result.claim;
  ordered_json json{{"id", claim.id}, {"item", claim.item}, {"says", claim.says}};
  json["measure"] = claim.measures.size() == 1 ? ordered_json(claim.measures.front())
                                               : ordered_json(claim.measures);
  json["expect"] = claim.expect;
  json["profile"] = claim.profiles;
  json["comparable"] = claim.comparable_text();
  json["printed"] = claim.printed;
  json["criterion"] = claim.criterion;
  json["below_noise"] = claim.below_noise_text();
  std::string verdict = to_words(result.verdict);
  std::replace(verdict.begin(), verdict.end(), ' ', '_');
  json["verdict"] = verdict;
  json["reason"] = result.reason;
  json["value"] = result.value ? finite_or_null(*result.value) : ordered_json();
  json["low"] = result.interval ? finite_or_null(result.interval->low) : ordered_json();
  json["high"] = result.interval ? finite_or_null(result.interval->high) : ordered_json();
  json["elements"] = ordered_json::array();
  for (const ClaimPart& element : result.elements) json["elements"].push_back(to_json(element));
  json["parts"] = ordered_json::array();
  for (const ClaimPart& part : result.parts) json["parts"].push_back(to_json(part));
  return json;
}

}  // namespace

const char* to_words(Verdict verdict) {
  switch (verdict) {
    case Verdict::reproduced:
      return "reproduced";
    case Verdict::not_reproduced:
      return "not reproduced";
    case Verdict::inconclusive:
      return "inconclusive";
    case Verdict::not_comparable:
      return "not comparable";
    case Verdict::printed:
      break;
  }
  return "printed";
}

std::string format_value(const ClaimResult& result) {
  if (result.value) return format_number(*result.value, result.interval);
  constexpr std::size_t kMostElements = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(result.elements.size(), kMostElements); ++i) {
    text += (i == 0 ? "" : ", ") + format_number(result.elements[i].value, std::nullopt);
  }
  return result.elements.size() > kMostElements ? text + ", ..." : text;
}

ClaimResult evaluate(const Claim& claim, const RunValues& values) {
  RowNumbers numbers(values);
  return evaluate_with(claim, numbers);
}

std::vector<ClaimResult> evaluate(std::span<const Claim> claims, const RunValues& values) {
  RowNumbers numbers(values);
  std::vector<ClaimResult> results;
  for (const Claim& claim : claims) results.push_back(evaluate_with(claim, numbers));
  return results;
}

std::vector<std::pair<Verdict, std::size_t>> count_verdicts(std::span<const ClaimResult> results) {
  std::vector<std::pair<Verdict, std::size_t>> counts;
  for (const Verdict verdict : kVerdicts) {
    const auto count =
        std::count_if(results.begin(), results.end(),
                      [&](const ClaimResult& result) { return result.verdict == verdict; });
    if (count > 0) counts.emplace_back(verdict, static_cast<std::size_t>(count));
  }
  return counts;
}

std::string format_counts(std::span<const ClaimResult> results) {
  std::string text;
  for (const auto& [verdict, count] : count_verdicts(results)) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", to_words(verdict), count);
  }
  return text;
}

bool all_reproduced(std::span<const ClaimResult> results) {
  bool has_reproduced = false;
  for (const ClaimResult& result : results) {
    if (result.verdict == Verdict::not_reproduced || result.verdict == Verdict::inconclusive) {
      return false;
    }
    has_reproduced = has_reproduced || result.verdict == Verdict::reproduced;
  }
  return has_reproduced;
}

ordered_json to_json(std::span<const ClaimResult> results) {
  ordered_json counts = ordered_json::object();
  for (const auto& [verdict, count] : count_verdicts(results)) {
    std::string key = to_words(verdict);
    std::replace(key.begin(), key.end(), ' ', '_');
    counts[key] = count;
  }
  ordered_json claims = ordered_json::array();
  for (const ClaimResult& result : results) claims.push_back(to_json(result));
  return {{"schema", 1},
          {"counts", std::move(counts)},
          {"all_reproduced", all_reproduced(results)},
          {"claims", std::move(claims)}};
}

}  // namespace results::claims
