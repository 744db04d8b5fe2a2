#include "tests/renderers/clustered_visibility/cluster_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace test_clustered_visibility {
namespace {

constexpr double kPi = std::numbers::pi;
const glm::dvec3 kX(1.0, 0.0, 0.0);
const glm::dvec3 kZ(0.0, 0.0, 1.0);

/// Point i of the Halton sequence in one base, van der Corput's radical inverse.
double radical_inverse(int i, int base) {
  double value = 0.0;
  for (double digit_value = 1.0 / base; i > 0; i /= base, digit_value /= base) {
    value += (i % base) * digit_value;
  }
  return value;
}

/// Lights where a spot in a unit cube shines into its corner at the origin: on three walls.
std::vector<OracleLight> corner_lights(int count) {
  std::vector<OracleLight> lights;
  for (int i = 1; i <= count; ++i) {
    const glm::dvec2 point(radical_inverse(i, 2) - 0.5, radical_inverse(i, 3) - 0.5);
    const glm::dvec3 direction =
        glm::normalize(glm::dvec3(-1.0) + point.x * glm::dvec3(1.0, -1.0, 0.0) +
                       point.y * glm::dvec3(1.0, 1.0, -2.0));
    int wall = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (direction[axis] < direction[wall]) wall = axis;
    }
    OracleLight light{glm::dvec3(0.5) - direction * (0.5 / direction[wall]), glm::dvec3(0.0), true};
    light.normal[wall] = 1.0;
    lights.push_back(light);
  }
  return lights;
}

ClusterRule cube_rule(double scale = 1.0) { return {0.7, 0.3, scale * std::numbers::sqrt3, kPi}; }

ClusterResult cluster_from(const ClusterRule& rule, const std::vector<OracleLight>& lights,
                           int cluster_count, int max_iterations = 100) {
  const std::vector<int> start = start_lights(lights, cluster_count, ClusterStart::stride);
  return cluster_lights(rule, lights, clusters_at(lights, start), max_iterations);
}

std::vector<OracleLight> scaled(std::vector<OracleLight> lights, double factor) {
  for (OracleLight& light : lights) light.position *= factor;
  return lights;
}

/// Lights on a line, all facing z.
std::vector<OracleLight> line_lights(const std::vector<double>& xs) {
  std::vector<OracleLight> lights;
  for (const double x : xs) lights.push_back({{x, 0.0, 0.0}, kZ, true});
  return lights;
}

/// Clusters with lights of more than one wall.
int mixed_clusters(const std::vector<OracleLight>& lights, const ClusterResult& result) {
  int mixed = 0;
  for (std::size_t k = 0; k < result.clusters.size(); ++k) {
    std::set<int> walls;
    for (std::size_t i = 0; i < lights.size(); ++i) {
      if (result.assignments[i] != static_cast<int>(k)) continue;
      walls.insert(lights[i].normal.x > 0.5 ? 0 : lights[i].normal.y > 0.5 ? 1 : 2);
    }
    if (walls.size() > 1) ++mixed;
  }
  return mixed;
}

TEST(ClusterOracle, DistanceMeasuresLengthAndAngleInTheirUnits) {
  const ClusterRule rule{0.7, 0.3, 10.0, kPi};
  // dx = 5 of 10, dalpha a quarter turn: 0.35 + 0.15.
  EXPECT_NEAR(cluster_distance(rule, {{3.0, 4.0, 0.0}, kX, true}, {{}, kZ, 1}), 0.5, 1e-15);
  EXPECT_NEAR(cluster_distance(rule, {{}, -kZ, true}, {{}, kZ, 1}), 0.3, 1e-15) << "half a turn";
  // Normals a rounding error too long must not give a NaN.
  EXPECT_EQ(cluster_distance(rule, {{}, (1.0 + 1e-9) * kZ, true}, {{}, kZ, 1}), 0.0);
}

TEST(ClusterOracle, NearestIsTheLowestIndexOfATieAndKnowsItsMargin) {
  const ClusterRule rule{1.0, 0.0, 1.0, kPi};
  const std::vector<OracleLight> centers = line_lights({5.0, 1.0, -1.0});
  const std::vector<OracleCluster> clusters = clusters_at(centers, {0, 1, 2});
  const NearestCluster tie = nearest_cluster(rule, {{}, kZ, true}, clusters);
  EXPECT_EQ(tie.index, 1);
  EXPECT_EQ(tie.margin, 0.0);
  const NearestCluster clear = nearest_cluster(rule, {{-0.5, 0.0, 0.0}, kZ, true}, clusters);
  EXPECT_EQ(clear.index, 2);
  EXPECT_DOUBLE_EQ(clear.distance, 0.5);
  EXPECT_DOUBLE_EQ(clear.margin, 1.0);
  EXPECT_TRUE(std::isinf(nearest_cluster(rule, centers[0], {clusters[0]}).margin));
}

TEST(ClusterOracle, MeanStepAveragesPositionsAndNormals) {
  const std::vector<OracleLight> lights{{{0.0, 0.0, 0.0}, kX, true}, {{2.0, 4.0, 6.0}, kZ, true}};
  const auto moved = mean_step(lights, {0, 0}, {OracleCluster{}});
  EXPECT_EQ(moved[0].position, glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_NEAR(glm::distance(moved[0].normal, glm::normalize(kX + kZ)), 0.0, 1e-15);
  EXPECT_EQ(moved[0].count, 2);
}

TEST(ClusterOracle, NormalsThatCancelLeaveTheOldOne) {
  // Two normals an angle phi apart have a mean of length cos(phi / 2).
  const auto mean_normal = [](double half_angle_rad) {
    const glm::dvec3 left(-std::sin(half_angle_rad), 0.0, std::cos(half_angle_rad));
    const glm::dvec3 right(std::sin(half_angle_rad), 0.0, std::cos(half_angle_rad));
    return mean_step({{{}, left, true}, {{4.0, 0.0, 0.0}, right, true}}, {0, 0},
                     {{glm::dvec3(9.0), kX, 2}})[0];
  };
  EXPECT_NEAR(glm::distance(mean_normal(std::acos(0.11)).normal, kZ), 0.0, 1e-14);
  EXPECT_EQ(mean_normal(std::acos(0.09)).normal, kX);
  EXPECT_NEAR(mean_normal(std::acos(0.09)).position.x, 2.0, 1e-15) << "the position moves anyway";
}

TEST(ClusterOracle, EmptyClusterKeepsItsCentreAndStillCompetes) {
  const ClusterRule rule{1.0, 0.0, 1.0, kPi};
  const OracleCluster far{{100.0, 0.0, 0.0}, kX, 7};
  const auto moved = mean_step(line_lights({1.0, 3.0}), {0, 0}, {OracleCluster{}, far});
  EXPECT_EQ(moved[1].position, far.position);
  EXPECT_EQ(moved[1].normal, far.normal);
  EXPECT_EQ(moved[1].count, 0);
  EXPECT_EQ(nearest_cluster(rule, {{99.0, 0.0, 0.0}, kZ, true}, moved).index, 1);
}

TEST(ClusterOracle, StartsAtEveryStrideOrAtThePrefix) {
  std::vector<OracleLight> lights(10);
  EXPECT_EQ(start_lights(lights, 3, ClusterStart::stride), (std::vector<int>{0, 3, 6}));
  EXPECT_EQ(start_lights(lights, 4, ClusterStart::stride), (std::vector<int>{0, 2, 5, 7}));
  EXPECT_EQ(start_lights(lights, 3, ClusterStart::prefix), (std::vector<int>{0, 1, 2}));
}

TEST(ClusterOracle, StartsSkipInvalidAndTakenLights) {
  std::vector<OracleLight> lights(6);
  for (const std::size_t invalid : {1U, 4U, 5U}) lights[invalid].is_valid = false;
  // Stride wants 0, 2, 4: 4 and 5 are invalid, 0 and 2 taken, after the last comes the first.
  EXPECT_EQ(start_lights(lights, 3, ClusterStart::stride), (std::vector<int>{0, 2, 3}));
  // Prefix wants 0, 1, 2: 2 stands in for 1, so 3 stands in for 2.
  EXPECT_EQ(start_lights(lights, 3, ClusterStart::prefix), (std::vector<int>{0, 2, 3}));
  EXPECT_EQ(start_lights(lights, 5, ClusterStart::prefix), (std::vector<int>{0, 2, 3}))
      << "no more valid lights";
}

TEST(ClusterOracle, FollowsAnExampleByHand) {
  const ClusterRule rule{1.0, 0.0, 1.0, kPi};
  const std::vector<OracleLight> lights = line_lights({0.0, 1.0, 10.0, 11.0});
  const std::vector<OracleCluster> start = clusters_at(lights, {0, 1});
  // {0} {1 10 11} -> 0, 22/3; {0 1} {10 11} -> 1/2, 21/2; the same again.
  const ClusterResult capped = cluster_lights(rule, lights, start, 1);
  EXPECT_EQ(capped.iterations, 1);
  EXPECT_FALSE(capped.is_converged);
  EXPECT_NEAR(capped.clusters[1].position.x, 22.0 / 3.0, 1e-14);
  EXPECT_EQ(capped.assignments, (std::vector<int>{0, 0, 1, 1})) << "to the centres after the step";
  EXPECT_EQ(capped.clusters[0].count, 2);
  const ClusterResult whole = cluster_lights(rule, lights, start);
  EXPECT_EQ(whole.iterations, 2);
  EXPECT_TRUE(whole.is_converged);
  EXPECT_DOUBLE_EQ(whole.clusters[0].position.x, 0.5);
  EXPECT_DOUBLE_EQ(whole.clusters[1].position.x, 10.5);
  EXPECT_DOUBLE_EQ(whole.margins[1], 9.0);
}

TEST(ClusterOracle, EndsAtAFixedPoint) {
  const std::vector<OracleLight> lights = corner_lights(512);
  const ClusterResult result = cluster_from(cube_rule(), lights, 30);
  ASSERT_TRUE(result.is_converged);
  EXPECT_GT(result.iterations, 3) << "or the test is trivial";
  const auto moved = mean_step(lights, result.assignments, result.clusters);
  for (std::size_t k = 0; k < moved.size(); ++k) {
    EXPECT_LT(glm::distance(moved[k].position, result.clusters[k].position), 1e-14);
    EXPECT_LT(glm::distance(moved[k].normal, result.clusters[k].normal), 1e-14);
    EXPECT_EQ(moved[k].count, result.clusters[k].count);
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto own = static_cast<std::size_t>(result.assignments[i]);
    const double distance = cluster_distance(cube_rule(), lights[i], result.clusters[own]);
    for (const OracleCluster& other : result.clusters) {
      EXPECT_LE(distance, cluster_distance(cube_rule(), lights[i], other));
    }
  }
  EXPECT_FALSE(cluster_from(cube_rule(), lights, 30, 1).is_converged);
}

TEST(ClusterOracle, AsManyClustersAsLightsGiveEachItsOwn) {
  const std::vector<OracleLight> lights = corner_lights(64);
  const ClusterResult result = cluster_from(cube_rule(), lights, 64);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    EXPECT_EQ(result.assignments[i], static_cast<int>(i));
    EXPECT_EQ(result.clusters[i].position, lights[i].position);
    EXPECT_GT(result.margins[i], 1e-4);
  }
}

TEST(ClusterOracle, OneClusterIsTheMean) {
  const std::vector<OracleLight> lights = corner_lights(64);
  const ClusterResult result = cluster_from(cube_rule(), lights, 1);
  glm::dvec3 mean(0.0);
  for (const OracleLight& light : lights) mean += light.position / 64.0;
  EXPECT_LT(glm::distance(result.clusters[0].position, mean), 1e-14);
  EXPECT_EQ(result.clusters[0].count, 64);
  EXPECT_EQ(result.iterations, 1);
}

TEST(ClusterOracle, OrdersOfLightsAndClustersDoNotMatter) {
  constexpr int kLights = 512;
  constexpr int kClusters = 30;
  const std::vector<OracleLight> lights = corner_lights(kLights);
  std::vector<int> seeds = start_lights(lights, kClusters, ClusterStart::stride);
  const ClusterResult result = cluster_lights(cube_rule(), lights, clusters_at(lights, seeds));
  // Light i moves to place 5 i mod 512; the seeds move along and are listed backwards.
  const auto place = [](int i) { return 5 * i % kLights; };
  std::vector<OracleLight> shuffled(lights.size());
  for (int i = 0; i < kLights; ++i) {
    shuffled[static_cast<std::size_t>(place(i))] = lights[static_cast<std::size_t>(i)];
  }
  std::reverse(seeds.begin(), seeds.end());
  for (int& seed : seeds) seed = place(seed);
  const ClusterResult other = cluster_lights(cube_rule(), shuffled, clusters_at(shuffled, seeds));
  for (int i = 0; i < kLights; ++i) {
    EXPECT_EQ(other.assignments[static_cast<std::size_t>(place(i))],
              kClusters - 1 - result.assignments[static_cast<std::size_t>(i)]);
  }
  EXPECT_EQ(other.iterations, result.iterations);
}

TEST(ClusterOracle, ScaleOfTheSceneDoesNotMatterInItsUnits) {
  const std::vector<OracleLight> lights = corner_lights(512);
  const std::vector<OracleLight> large = scaled(lights, 1000.0);
  const ClusterResult result = cluster_from(cube_rule(), lights, 30);
  EXPECT_EQ(cluster_from(cube_rule(1000.0), large, 30).assignments, result.assignments);
  EXPECT_NE(cluster_from(cube_rule(), large, 30).assignments, result.assignments)
      << "a unit that stays behind must show";
}

TEST(ClusterOracle, NormalsKeepWallsApart) {
  const std::vector<OracleLight> lights = corner_lights(1024);
  const ClusterRule by_position{1.0, 0.0, std::numbers::sqrt3, kPi};
  EXPECT_EQ(mixed_clusters(lights, cluster_from(cube_rule(), lights, 30)), 0);
  EXPECT_GT(mixed_clusters(lights, cluster_from(by_position, lights, 30)), 0);
  // Metres against radians: a large scene switches the normals off.
  const ClusterRule unitless{0.7, 0.3, 1.0, 1.0};
  const std::vector<OracleLight> large = scaled(lights, 555.0);
  EXPECT_GT(mixed_clusters(large, cluster_from(unitless, large, 30)), 0);
}

TEST(ClusterOracle, InvalidLightsNeverMoveACentre) {
  std::vector<OracleLight> lights = corner_lights(256);
  const ClusterResult without = cluster_from(cube_rule(), lights, 16);
  for (const std::size_t i : {0U, 100U, 255U}) {
    lights.insert(lights.begin() + static_cast<std::ptrdiff_t>(i), {glm::dvec3(0.9), -kX, false});
  }
  const auto with_them = [&] { return cluster_lights(cube_rule(), lights, without.clusters); };
  ClusterResult with = with_them();
  EXPECT_EQ(with.iterations, 1);
  EXPECT_EQ(with.assignments[0], -1);
  for (std::size_t k = 0; k < 16; ++k) {
    EXPECT_EQ(with.clusters[k].position, without.clusters[k].position);
    EXPECT_EQ(with.clusters[k].count, without.clusters[k].count);
  }
  for (OracleLight& light : lights) light.is_valid = true;
  with = with_them();
  EXPECT_TRUE(std::any_of(with.clusters.begin(), with.clusters.end(), [](const auto& cluster) {
    return glm::distance(cluster.position, glm::dvec3(0.9)) < 0.4;
  })) << "they would, were they valid";
}

TEST(ClusterOracle, MembersAreThoseAssigned) {
  const auto lights = line_lights({1.0, 2.0, 3.0});
  EXPECT_EQ(member_positions(lights, {1, -1, 1}, 1),
            (std::vector<glm::dvec3>{{1.0, 0.0, 0.0}, {3.0, 0.0, 0.0}}));
  EXPECT_TRUE(member_positions(lights, {1, -1, 1}, 0).empty());
}

}  // namespace
}  // namespace test_clustered_visibility
