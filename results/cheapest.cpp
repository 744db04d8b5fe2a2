#include "results/cheapest.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/units.h"
#include "results/convergence.h"

namespace results {

using nlohmann::ordered_json;

namespace {

Quantity find_score(const RunValues& run, const std::string& metric, const std::string& against) {
  const std::string text = against == "full" ? metric + "@full" : metric;
  Quantity score = run.find_quantity(text, base::Place{"--metric"});
  if (score.kind != Quantity::Kind::score) {
    throw base::InputError(base::Place{"--metric"}, fmt::format("\"{}\" is no score", metric));
  }
  const metrics::MetricDescription* info = metric_info_of(score.name);
  if (info != nullptr && info->better == metrics::Better::higher) {
    throw base::InputError(base::Place{"--metric"},
                           fmt::format("{} is better when it is higher; accepted: an error, "
                                       "better when it is lower",
                                       metric));
  }
  return score;
}

/// Whether an error can be told to be below the limit.
void judge_visibility(const SummaryRow& row, const Quantity& score, double limit,
                      Candidate& candidate) {
  const Estimate& value = *candidate.score;
  const ScoreSummary* summary = row.find_score(score.name, score.against);
  const bool is_floor_above =
      summary != nullptr && score.detail.empty() && summary->noise_floor.value_or(0.0) > limit;
  if (value.low > limit || (value.count < 2 && value.value > limit)) {
    candidate.visibility = Visibility::above;
  } else if (value.high > limit) {
    candidate.visibility = Visibility::undecided;
    candidate.reason = "its interval reaches across the limit; more seeds make it narrower";
  } else {
    candidate.visibility = Visibility::below;
  }
  // The reference's noise adds to an error: one below the limit is below it all the same.
  if (candidate.visibility == Visibility::above && is_floor_above) {
    candidate.visibility = Visibility::undecided;
    candidate.reason =
        "the reference's own noise is above the limit; `discern ref extend` lowers it";
  }
}

Candidate candidate_of(const RunValues& run, std::size_t index, const Quantity& score,
                       double limit) {
  const SummaryRow& row = run.summary().rows[index];
  Candidate candidate;
  candidate.method = row.method;
  candidate.budget = row.budget;
  candidate.time_s = row.is_sequence ? row.next_frames.p50_s : row.total_s;
  candidate.score = run.estimate(index, score);
  if (row.has_failure()) {
    candidate.reason = format_statuses(row);
  } else if (candidate.score && candidate.time_s) {
    judge_visibility(row, score, limit, candidate);
  } else {
    candidate.reason = format_statuses(row);
  }
  return candidate;
}

/// Where the curves of all seeds reach the limit before their end.
std::optional<Candidate> candidate_on_curve(const RunValues& run, std::size_t index,
                                            const Quantity& score, double limit) {
  const SummaryRow& row = run.summary().rows[index];
  const std::vector<ConvergenceCurve> curves = convergence_curves(run, index, score);
  if (curves.empty() || times_to_score(curves, limit, true).size() < curves.size()) return {};
  Candidate candidate;
  candidate.method = row.method;
  candidate.budget = row.budget;
  candidate.time_s = time_to_score(curves, limit, true);
  candidate.score = Estimate{limit, limit, limit, 1};
  candidate.visibility = Visibility::below;
  candidate.is_on_curve = true;
  return candidate;
}

void mark_cheapest(std::vector<Candidate>& candidates) {
  std::ranges::stable_sort(candidates, std::less<>(), [](const Candidate& candidate) {
    const double time_s =
        candidate.time_s ? candidate.time_s->value : std::numeric_limits<double>::infinity();
    return std::pair(candidate.visibility != Visibility::below, time_s);
  });
  if (candidates.empty() || candidates.front().visibility != Visibility::below) return;
  Candidate& cheapest = candidates.front();
  cheapest.is_cheapest = true;
  for (Candidate& other : candidates) {
    if (&other == &cheapest || other.visibility != Visibility::below) continue;
    const bool has_noise = cheapest.time_s->count > 1 && other.time_s->count > 1;
    other.is_tied = !has_noise || other.time_s->low <= cheapest.time_s->high;
  }
}

std::string verdict_of(const Candidate& candidate) {
  if (candidate.is_cheapest) return "cheapest";
  if (candidate.is_tied) {
    return candidate.time_s->count > 1 ? "below, as fast within the noise"
                                       : "below; one repetition tells no noise";
  }
  std::string text = to_string(candidate.visibility);
  if (!candidate.reason.empty()) text += ": " + candidate.reason;
  return text;
}

}  // namespace

std::string to_string(Visibility visibility) {
  switch (visibility) {
    case Visibility::below:
      return "below";
    case Visibility::undecided:
      return "undecided";
    case Visibility::above:
      return "above";
    case Visibility::unknown:
      break;
  }
  return "unknown";
}

std::vector<CheapestOfScene> cheapest_settings(const RunValues& run, const std::string& metric,
                                               const std::string& against, double limit) {
  const Quantity score = find_score(run, metric, against);
  std::vector<CheapestOfScene> scenes;
  const std::vector<SummaryRow>& rows = run.summary().rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (scenes.empty() || scenes.back().scene != rows[i].scene) {
      scenes.push_back({rows[i].scene, {}});
    }
    std::vector<Candidate>& candidates = scenes.back().candidates;
    candidates.push_back(candidate_of(run, i, score, limit));
    if (auto on_curve = candidate_on_curve(run, i, score, limit)) {
      candidates.push_back(std::move(*on_curve));
    }
  }
  for (CheapestOfScene& scene : scenes) mark_cheapest(scene.candidates);
  return scenes;
}

Table cheapest_table(const std::vector<CheapestOfScene>& scenes, const std::string& score,
                     double limit) {
  Table table;
  table.columns = {
      {"scene", "", Direction::none, false},  {"method", "", Direction::none, false},
      {"budget", "", Direction::none, false}, {"time", "median", Direction::lower, true},
      {score, "", Direction::lower, true},    {"verdict", "", Direction::none, false}};
  const auto words = [](std::string text) { return TableCell{std::move(text), {}, false, ""}; };
  for (const CheapestOfScene& scene : scenes) {
    for (const Candidate& candidate : scene.candidates) {
      table.rows.push_back(
          {words(scene.scene), words(candidate.method),
           words(candidate.is_on_curve ? "on the curve of " + candidate.budget : candidate.budget),
           words(candidate.time_s ? format_time(*candidate.time_s) : "-"),
           words(candidate.score ? format_score(*candidate.score) : "-"),
           words(verdict_of(candidate))});
    }
  }
  table.notes.push_back(fmt::format("below: the score's interval ends at or under {}",
                                    base::format_significant(limit, 4)));
  return table;
}

ordered_json to_json(const std::vector<CheapestOfScene>& scenes) {
  const auto number = [](const std::optional<Estimate>& estimate) {
    return estimate ? ordered_json(estimate->value) : ordered_json(nullptr);
  };
  ordered_json list = ordered_json::array();
  for (const CheapestOfScene& scene : scenes) {
    ordered_json candidates = ordered_json::array();
    for (const Candidate& candidate : scene.candidates) {
      candidates.push_back({{"method", candidate.method},
                            {"budget", candidate.budget},
                            {"on_curve", candidate.is_on_curve},
                            {"time_s", number(candidate.time_s)},
                            {"score", number(candidate.score)},
                            {"visibility", to_string(candidate.visibility)},
                            {"tied", candidate.is_tied},
                            {"reason", candidate.reason}});
    }
    const bool has_cheapest = !scene.candidates.empty() && scene.candidates.front().is_cheapest;
    ordered_json cheapest = has_cheapest ? candidates.front() : ordered_json(nullptr);
    list.push_back({{"scene", scene.scene},
                    {"cheapest", std::move(cheapest)},
                    {"candidates", std::move(candidates)}});
  }
  return list;
}

}  // namespace results
