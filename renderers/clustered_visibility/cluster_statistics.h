#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "renderers/clustered_visibility/light_clusters.h"
#include "renderers/contract/renderer.h"
#include "renderers/many_lights/virtual_light.h"

namespace renderers::clustered_visibility {

/// One state of the clusters, on the CPU.
struct ClusterState {
  std::vector<many_lights::VirtualLight> lights;
  std::vector<std::int32_t> assignments;
  std::vector<AreaLight> area_lights;
  ClusterSummary summary;
};

/// A light belongs to another plane than its cluster if its normal is farther than this from the
/// cluster's.
inline constexpr double kMixedAngle_deg = 30.0;

/// Counters of a state:
///  vals                 clusters with lights
///  cluster_iterations, cluster_converged (0 or 1)
///  mixed_vals           those with a light of another plane (`kMixedAngle_deg`)
///  normal_spread_deg    root mean square angle between a light's normal and its cluster's
///  val_area_m2          mean area of those with lights
///  point_vals           those without an area: one light, or all in a line
///  clip_height_m        greatest clip height of a map, whatever it leaves out below (`Clip`)
///  lights_per_pixel, visibilities_per_pixel   of the runs of an interleaved gather, mean
///  least_run, longest_run   lights of a pixel's run, flux or not; differ where n^2 does not divide
///  N
/// @param interleave  n of gather_settings.h
std::vector<std::pair<std::string, CounterValue>> cluster_counters(const ClusterState& state,
                                                                   int interleave);

/// Several lights have flux, and all lie in one plane and face one way.
bool is_in_one_plane(const ClusterState& state, double diagonal_m);

/// Counters of a change from one state of a sequence to the next:
///  assignment_churn     share of the lights with flux in both that are in another cluster
///  val_shift_p50, val_shift_p95   way of the clusters that have lights in both, in diagonals
/// None if the numbers of lights or clusters differ.
std::vector<std::pair<std::string, CounterValue>> change_counters(const ClusterState& before,
                                                                  const ClusterState& after,
                                                                  double diagonal_m);

}  // namespace renderers::clustered_visibility
