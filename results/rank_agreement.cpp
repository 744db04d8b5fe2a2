#include "results/rank_agreement.h"

#include <utility>

#include <fmt/format.h>

namespace results {

namespace {

bool is_better_higher(const Quantity& score) {
  const metrics::MetricDescription* info = metric_info_of(score.name);
  return info != nullptr && info->better == metrics::Better::higher;
}

/// -1 if row i is better, 1 if row j is, 0 if noise may have made the order.
int order_of(const Estimate& i, const Estimate& j, bool is_higher) {
  const bool is_i_below = i.high < j.low;
  const bool is_j_below = j.high < i.low;
  if (!is_i_below && !is_j_below) return 0;
  return is_i_below != is_higher ? -1 : 1;
}

TableCell words(std::string text) { return {std::move(text), std::nullopt, false, ""}; }

std::string name_of(const SummaryRow& row) { return fmt::format("{} {}", row.method, row.budget); }

}  // namespace

std::vector<RankAgreement> rank_agreement(const RunValues& run, const Quantity& a,
                                          const Quantity& b) {
  const bool is_a_higher = is_better_higher(a);
  const bool is_b_higher = is_better_higher(b);
  const std::vector<SummaryRow>& rows = run.summary().rows;
  std::vector<RankAgreement> scenes;
  for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    RankAgreement scene;
    scene.scene = rows[begin].scene;
    std::vector<std::pair<Estimate, Estimate>> scores;
    std::vector<std::size_t> indices;
    for (end = begin; end < rows.size() && rows[end].scene == scene.scene; ++end) {
      const auto score_a = run.estimate(end, a);
      const auto score_b = run.estimate(end, b);
      if (!score_a || !score_b) continue;
      scores.emplace_back(*score_a, *score_b);
      indices.push_back(end);
    }
    scene.rows = indices.size();
    for (std::size_t i = 0; i < indices.size(); ++i) {
      for (std::size_t j = i + 1; j < indices.size(); ++j) {
        const int by_a = order_of(scores[i].first, scores[j].first, is_a_higher);
        const int by_b = order_of(scores[i].second, scores[j].second, is_b_higher);
        if (by_a == 0 || by_b == 0) continue;
        ++scene.pairs;
        if (by_a == by_b) continue;
        scene.disagreements.push_back(by_a < 0 ? Disagreement{indices[i], indices[j]}
                                               : Disagreement{indices[j], indices[i]});
      }
    }
    if (scene.pairs > 0) {
      scene.tau = 1.0 - 2.0 * static_cast<double>(scene.disagreements.size()) /
                            static_cast<double>(scene.pairs);
    }
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

Table rank_agreement_table(const RunValues& run, const Quantity& a, const Quantity& b) {
  Table table;
  table.columns = {{"scene", "", Direction::none, false},
                   {"better by " + a.text, "", Direction::none, false},
                   {"better by " + b.text, "", Direction::none, false},
                   {a.text, "", Direction::none, true},
                   {b.text, "", Direction::none, true}};
  const auto both = [&](const Disagreement& pair, const Quantity& score) {
    return fmt::format("{} / {}", format_score(*run.estimate(pair.first, score)),
                       format_score(*run.estimate(pair.second, score)));
  };
  for (const RankAgreement& scene : rank_agreement(run, a, b)) {
    for (const Disagreement& pair : scene.disagreements) {
      table.rows.push_back({words(scene.scene), words(name_of(run.summary().rows[pair.first])),
                            words(name_of(run.summary().rows[pair.second])), words(both(pair, a)),
                            words(both(pair, b))});
    }
    table.notes.push_back(
        scene.tau ? fmt::format("{}: {} rows, {} pairs that both scores tell apart, {} of them in "
                                "opposite order, tau {:.2f}",
                                scene.scene, scene.rows, scene.pairs, scene.disagreements.size(),
                                *scene.tau)
                  : fmt::format("{}: {} rows, no pair that both scores tell apart", scene.scene,
                                scene.rows));
  }
  return table;
}

}  // namespace results
