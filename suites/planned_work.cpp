#include "suites/planned_work.h"

#include <algorithm>

namespace suites {
namespace {

/// Samples that a repetition is taken for if its budget does not count any.
constexpr double kAssumedSamples = 64.0;
/// One metric on one image takes about as long as so many samples per pixel.
constexpr double kScoreSamples = 3.0;

double pixels_of(const SuiteScene& scene) {
  return static_cast<double>(scene.size_px.width) * static_cast<double>(scene.size_px.height);
}

}  // namespace

double work_of_reference(const SuiteScene& scene, std::int64_t stored_samples) {
  const std::int64_t missing = std::max<std::int64_t>(0, scene.reference.samples - stored_samples);
  return pixels_of(scene) * static_cast<double>(missing);
}

double work_of_repetition(const PlannedCell& cell) {
  if (cell.unsupported) return 0.0;
  const double samples =
      cell.budget.samples ? static_cast<double>(*cell.budget.samples) : kAssumedSamples;
  return pixels_of(*cell.scene) * samples * static_cast<double>(cell.frames.size());
}

double work_of_score(const PlannedCell& cell) { return pixels_of(*cell.scene) * kScoreSamples; }

}  // namespace suites
