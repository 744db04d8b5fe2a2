#include "results/figures/step_differences.h"

#include <map>
#include <vector>

#include "results/score_summary.h"

namespace results::figures {

namespace {

/// The score of each seed, over its frames.
std::map<std::uint64_t, double> scores_by_seed(const FigureRun& run, std::size_t row,
                                               const Quantity& score) {
  std::map<std::uint64_t, std::vector<Sample>> samples;
  for (const Sample& sample : run.samples(row, score)) samples[sample.seed].push_back(sample);
  std::map<std::uint64_t, double> scores;
  for (const auto& [seed, of_seed] : samples) {
    scores[seed] = values_over_frames(of_seed, is_sequence_metric(score.name)).front();
  }
  return scores;
}

}  // namespace

std::optional<Estimate> score_difference(const FigureRun& run, std::size_t row, std::size_t before,
                                         const Quantity& score) {
  const auto scores = scores_by_seed(run, row, score);
  const auto scores_before = scores_by_seed(run, before, score);
  std::vector<double> differences;
  for (const auto& [seed, value] : scores) {
    const auto same_seed = scores_before.find(seed);
    if (same_seed != scores_before.end()) differences.push_back(value - same_seed->second);
  }
  if (differences.size() > 1) return mean_with_interval(differences);
  const std::optional<Estimate> value = run.estimate(row, score);
  const std::optional<Estimate> value_before = run.estimate(before, score);
  if (!value || !value_before) return std::nullopt;
  const double difference = value->value - value_before->value;
  return Estimate{difference, difference, difference, 1};
}

}  // namespace results::figures
