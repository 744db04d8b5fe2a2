#include "tests/renderers/clustered_visibility/cluster_oracle.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/geometric.hpp>

#include "renderers/shadow_maps/hemisphere_projection.h"

namespace test_clustered_visibility {

namespace {

std::vector<int> indices_of(const std::vector<NearestCluster>& nearest) {
  std::vector<int> indices;
  indices.reserve(nearest.size());
  for (const NearestCluster& entry : nearest) indices.push_back(entry.index);
  return indices;
}

/// Sums over the members of one cluster.
struct MemberSums {
  glm::dvec3 position{0.0};
  glm::dvec3 normal{0.0};
  int count = 0;
};

std::vector<MemberSums> sum_members(const std::vector<OracleLight>& lights,
                                    const std::vector<int>& assignments,
                                    std::size_t cluster_count) {
  std::vector<MemberSums> sums(cluster_count);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (assignments[i] < 0) continue;
    MemberSums& own = sums[static_cast<std::size_t>(assignments[i])];
    own.position += lights[i].position;
    own.normal += lights[i].normal;
    ++own.count;
  }
  return sums;
}

/// Lowest and highest coordinate, and the variance, along one axis.
struct AxisSpread {
  double width_m = 0.0;
  double variance_m2 = 0.0;
};

AxisSpread axis_spread(const std::vector<glm::dvec3>& members, const glm::dvec3& origin,
                       const glm::dvec3& axis) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  double mean = 0.0;
  const auto count = static_cast<double>(members.size());
  for (const glm::dvec3& member : members) {
    const double coordinate = glm::dot(member - origin, axis);
    lowest = std::min(lowest, coordinate);
    highest = std::max(highest, coordinate);
    mean += coordinate / count;
  }
  double variance = 0.0;
  for (const glm::dvec3& member : members) {
    const double deviation = glm::dot(member - origin, axis) - mean;
    variance += deviation * deviation / count;
  }
  return {highest - lowest, variance};
}

}  // namespace

double cluster_distance(const ClusterRule& rule, const OracleLight& light,
                        const OracleCluster& cluster) {
  const double length_m = glm::length(light.position - cluster.position);
  const double cosine = std::clamp(glm::dot(light.normal, cluster.normal), -1.0, 1.0);
  return rule.weight_position * length_m / rule.position_unit_m +
         rule.weight_normal * std::acos(cosine) / rule.angle_unit_rad;
}

NearestCluster nearest_cluster(const ClusterRule& rule, const OracleLight& light,
                               const std::vector<OracleCluster>& clusters) {
  assert(!clusters.empty());
  constexpr double kNone = std::numeric_limits<double>::infinity();
  NearestCluster nearest{-1, kNone, kNone};
  double second = kNone;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const double distance = cluster_distance(rule, light, clusters[k]);
    if (distance < nearest.distance) {
      second = nearest.distance;
      nearest.index = static_cast<int>(k);
      nearest.distance = distance;
    } else {
      second = std::min(second, distance);
    }
  }
  nearest.margin = second - nearest.distance;
  return nearest;
}

std::vector<NearestCluster> assign_lights(const ClusterRule& rule,
                                          const std::vector<OracleLight>& lights,
                                          const std::vector<OracleCluster>& clusters) {
  std::vector<NearestCluster> nearest;
  nearest.reserve(lights.size());
  for (const OracleLight& light : lights) {
    nearest.push_back(light.is_valid ? nearest_cluster(rule, light, clusters) : NearestCluster{});
  }
  return nearest;
}

std::vector<OracleCluster> mean_step(const std::vector<OracleLight>& lights,
                                     const std::vector<int>& assignments,
                                     const std::vector<OracleCluster>& clusters) {
  assert(assignments.size() == lights.size());
  const std::vector<MemberSums> sums = sum_members(lights, assignments, clusters.size());
  std::vector<OracleCluster> moved = clusters;
  for (std::size_t k = 0; k < moved.size(); ++k) {
    moved[k].count = sums[k].count;
    if (sums[k].count == 0) continue;
    const auto count = static_cast<double>(sums[k].count);
    moved[k].position = sums[k].position / count;
    const glm::dvec3 normal = sums[k].normal / count;
    if (glm::length(normal) >= kShortestMeanNormal) moved[k].normal = glm::normalize(normal);
  }
  return moved;
}

std::vector<int> start_lights(const std::vector<OracleLight>& lights, int cluster_count,
                              ClusterStart start) {
  const auto light_count = static_cast<long long>(lights.size());
  std::vector<bool> is_taken(lights.size(), false);
  std::vector<int> chosen;
  for (long long k = 0; k < cluster_count; ++k) {
    const long long first = start == ClusterStart::stride ? k * light_count / cluster_count : k;
    for (long long step = 0; step < light_count; ++step) {
      const auto index = static_cast<std::size_t>((first + step) % light_count);
      if (!lights[index].is_valid || is_taken[index]) continue;
      is_taken[index] = true;
      chosen.push_back(static_cast<int>(index));
      break;
    }
  }
  return chosen;
}

std::vector<OracleCluster> clusters_at(const std::vector<OracleLight>& lights,
                                       const std::vector<int>& light_indices) {
  std::vector<OracleCluster> clusters;
  clusters.reserve(light_indices.size());
  for (const int index : light_indices) {
    const OracleLight& light = lights[static_cast<std::size_t>(index)];
    clusters.push_back({light.position, light.normal, 0});
  }
  return clusters;
}

ClusterResult cluster_lights(const ClusterRule& rule, const std::vector<OracleLight>& lights,
                             const std::vector<OracleCluster>& start, int max_iterations) {
  ClusterResult result;
  result.clusters = start;
  std::vector<NearestCluster> nearest = assign_lights(rule, lights, start);
  result.assignments = indices_of(nearest);

  // Every turn begins with assignments to the centres as they are.
  while (result.iterations < max_iterations && !result.is_converged) {
    result.clusters = mean_step(lights, result.assignments, result.clusters);
    ++result.iterations;
    nearest = assign_lights(rule, lights, result.clusters);
    std::vector<int> assignments = indices_of(nearest);
    result.is_converged = assignments == result.assignments;
    result.assignments = std::move(assignments);
  }

  for (OracleCluster& cluster : result.clusters) cluster.count = 0;
  for (const NearestCluster& entry : nearest) {
    result.margins.push_back(entry.margin);
    if (entry.index >= 0) ++result.clusters[static_cast<std::size_t>(entry.index)].count;
  }
  return result;
}

std::vector<glm::dvec3> member_positions(const std::vector<OracleLight>& lights,
                                         const std::vector<int>& assignments, int cluster_index) {
  std::vector<glm::dvec3> positions;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (assignments[i] == cluster_index) positions.push_back(lights[i].position);
  }
  return positions;
}

ClusterExtent cluster_extent(const std::vector<glm::dvec3>& members, const OracleCluster& cluster,
                             AreaRule rule, double minimum_size_m) {
  ClusterExtent extent{0.0, minimum_size_m, 0.0};
  if (members.empty()) return extent;
  const glm::dmat3 frame = renderers::shadow_maps::hemisphere_frame(cluster.normal);
  const AxisSpread s = axis_spread(members, cluster.position, frame[0]);
  const AxisSpread t = axis_spread(members, cluster.position, frame[1]);
  extent.area_m2 = rule == AreaRule::bounding_rectangle
                       ? s.width_m * t.width_m
                       : std::sqrt(12.0 * s.variance_m2) * std::sqrt(12.0 * t.variance_m2);
  extent.size_m = std::max(std::sqrt(extent.area_m2), minimum_size_m);
  for (const glm::dvec3& member : members) {
    const double height = glm::dot(member - cluster.position, cluster.normal);
    extent.height_m = std::max(extent.height_m, height);
  }
  return extent;
}

}  // namespace test_clustered_visibility
