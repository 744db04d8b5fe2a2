#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "results/run_values.h"

namespace results {

/// An image on the way of a progressive renderer, or where it ended.
struct CurvePoint {
  double samples = 0.0;
  double time_s = 0.0;  ///< total_s at this image
  double error = 0.0;   ///< the score
};

/// Score over time of one seed, by rising time.
struct ConvergenceCurve {
  std::uint64_t seed = 1;
  std::vector<CurvePoint> points;
};

/// The curves of a row's seeds: the scored checkpoints of the first repetition, then the cell's own
/// image. A seed without checkpoints has no curve.
/// @param score  a score of the run, details included
std::vector<ConvergenceCurve> convergence_curves(const RunValues& values, std::size_t row,
                                                 const Quantity& score);

/// One value per curve that spans the time: a straight line in log time and log score between the
/// two points around it (linear in the score where one is not above 0).
std::vector<double> scores_at_time(std::span<const ConvergenceCurve> curves, double time_s);
/// One value per curve that comes from the worse side and reaches the score: when it first does.
/// @param is_falling  the score gets better by falling
std::vector<double> times_to_score(std::span<const ConvergenceCurve> curves, double score,
                                   bool is_falling);

/// The score after so many seconds: per seed as above, then the mean over seeds with Student's t
/// interval. Nothing where no curve spans the time: nothing is extrapolated.
std::optional<Estimate> score_at_time(std::span<const ConvergenceCurve> curves, double time_s);

/// The time at which a score is first reached, likewise; the geometric mean over seeds, its
/// interval that of the mean of logarithms.
/// @param is_falling  the score gets better by falling
std::optional<Estimate> time_to_score(std::span<const ConvergenceCurve> curves, double score,
                                      bool is_falling);

}  // namespace results
