#include "renderers/clustered_visibility/cluster_statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "perception/base/quantile.h"
#include "renderers/many_lights/gather_settings.h"

namespace renderers::clustered_visibility {

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

struct NormalSpread {
  int mixed = 0;  ///< clusters
  double root_mean_square_deg = 0.0;
};

NormalSpread spread_of(const ClusterState& state) {
  std::vector<bool> is_mixed(state.area_lights.size(), false);
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < state.lights.size(); ++i) {
    if (state.assignments[i] < 0) continue;
    const auto cluster = static_cast<std::size_t>(state.assignments[i]);
    const glm::dvec3 normal(state.lights[i].geometric_normal);
    const glm::dvec3 axis(state.area_lights[cluster].axis);
    const double angle_deg = std::acos(std::clamp(glm::dot(normal, axis), -1.0, 1.0)) * kDegrees;
    if (angle_deg > kMixedAngle_deg) is_mixed[cluster] = true;
    sum += angle_deg * angle_deg;
    count += 1.0;
  }
  NormalSpread spread;
  spread.mixed = static_cast<int>(std::ranges::count(is_mixed, true));
  if (count > 0.0) spread.root_mean_square_deg = std::sqrt(sum / count);
  return spread;
}

struct RunMeans {
  double lights = 0.0;
  double clusters = 0.0;
  double least_run = 0.0;
  double longest_run = 0.0;
};

/// Lights with flux and clusters of a pixel's run, means over the classes of pixels; lengths of
/// runs, flux or not.
RunMeans run_means(const ClusterState& state, int interleave) {
  const int classes = interleave * interleave;
  const auto count = static_cast<int>(state.assignments.size());
  RunMeans means;
  for (int y = 0; y < interleave; ++y) {
    for (int x = 0; x < interleave; ++x) {
      const many_lights::LightRun run = many_lights::light_run(x, y, interleave, count);
      const double length = run.count;
      means.least_run = x + y == 0 ? length : std::min(means.least_run, length);
      means.longest_run = std::max(means.longest_run, length);
      std::vector<std::int32_t> clusters;
      for (int i = run.first; i < run.first + run.count; ++i) {
        const std::int32_t cluster = state.assignments[static_cast<std::size_t>(i)];
        if (cluster >= 0) clusters.push_back(cluster);
      }
      means.lights += static_cast<double>(clusters.size()) / classes;
      std::ranges::sort(clusters);
      const auto repeated = std::ranges::unique(clusters);
      means.clusters += static_cast<double>(clusters.size() - repeated.size()) / classes;
    }
  }
  return means;
}

bool has_lights(const AreaLight& area) { return area.position.w > 0.0F; }

}  // namespace

std::vector<std::pair<std::string, CounterValue>> cluster_counters(const ClusterState& state,
                                                                   int interleave) {
  double filled = 0.0;
  double area_m2 = 0.0;
  double clip_m = 0.0;
  double points = 0.0;
  for (const AreaLight& area : state.area_lights) {
    if (!has_lights(area)) continue;
    filled += 1.0;
    area_m2 += double{area.shape.z};
    clip_m = std::max(clip_m, std::abs(double{area.axis.w}));
    points += area.shape.z > 0.0F ? 0.0 : 1.0;
  }
  const NormalSpread spread = spread_of(state);
  const RunMeans means = run_means(state, interleave);
  return {{"vals", filled},
          {"cluster_iterations", static_cast<double>(state.summary.iterations)},
          {"cluster_converged", static_cast<double>(state.summary.has_converged)},
          {"mixed_vals", static_cast<double>(spread.mixed)},
          {"normal_spread_deg", spread.root_mean_square_deg},
          {"val_area_m2", filled > 0.0 ? area_m2 / filled : 0.0},
          {"point_vals", points},
          {"clip_height_m", clip_m},
          {"lights_per_pixel", means.lights},
          {"visibilities_per_pixel", means.clusters},
          {"least_run", means.least_run},
          {"longest_run", means.longest_run}};
}

bool is_in_one_plane(const ClusterState& state, double diagonal_m) {
  constexpr double kThinnest = 1e-5;  ///< of the diagonal
  constexpr double kEqualNormals = 1e-5;
  const many_lights::VirtualLight* first = nullptr;
  int count = 0;
  for (std::size_t i = 0; i < state.lights.size(); ++i) {
    if (state.assignments[i] < 0) continue;
    const many_lights::VirtualLight& light = state.lights[i];
    if (first == nullptr) first = &light;
    ++count;
    const glm::dvec3 normal(first->geometric_normal);
    const glm::dvec3 offset = glm::dvec3(light.position) - glm::dvec3(first->position);
    if (std::abs(glm::dot(offset, normal)) > kThinnest * diagonal_m) return false;
    if (glm::dot(normal, glm::dvec3(light.geometric_normal)) < 1.0 - kEqualNormals) return false;
  }
  return count > 1;
}

std::vector<std::pair<std::string, CounterValue>> change_counters(const ClusterState& before,
                                                                  const ClusterState& after,
                                                                  double diagonal_m) {
  if (before.assignments.size() != after.assignments.size() ||
      before.area_lights.size() != after.area_lights.size()) {
    return {};
  }
  double lit = 0.0;
  double moved = 0.0;
  for (std::size_t i = 0; i < after.assignments.size(); ++i) {
    if (before.assignments[i] < 0 || after.assignments[i] < 0) continue;
    lit += 1.0;
    moved += before.assignments[i] != after.assignments[i] ? 1.0 : 0.0;
  }
  std::vector<double> shifts;
  for (std::size_t c = 0; c < after.area_lights.size(); ++c) {
    if (!has_lights(before.area_lights[c]) || !has_lights(after.area_lights[c])) continue;
    shifts.push_back(glm::distance(glm::dvec3(before.area_lights[c].position),
                                   glm::dvec3(after.area_lights[c].position)) /
                     diagonal_m);
  }
  if (lit == 0.0 || shifts.empty()) return {};
  return {{"assignment_churn", moved / lit},
          {"val_shift_p50", base::quantile(shifts, 0.5)},
          {"val_shift_p95", base::quantile(shifts, 0.95)}};
}

}  // namespace renderers::clustered_visibility
