#include "renderers/clustered_visibility/light_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/renderers/clustered_visibility/cluster_oracle.h"
#include "tests/renderers/clustered_visibility/light_bench.h"
#include "tests/renderers/many_lights/gl_fixture.h"

namespace test_clustered_visibility {
namespace {

class LightClustersTest : public renderers::test::GlTest {
 protected:
  Clustered cluster(const LightSet& lights, const cv::ClusterSettings& settings) const {
    return cluster_on_device(context(), lights, settings);
  }
};

/// The area lights are at the means of the lights that are assigned to them.
void expect_means(const LightSet& lights, const Clustered& result) {
  const std::vector<OracleCluster> none(result.area_lights.size());
  const auto means = mean_step(oracle_lights(lights), result.assignments, none);
  const double unit_m = static_cast<double>(lights.bounds.diagonal_m());
  for (std::size_t k = 0; k < means.size(); ++k) {
    const cv::AreaLight& area = result.area_lights[k];
    EXPECT_EQ(area.shape.w, static_cast<float>(means[k].count)) << k;
    EXPECT_EQ(area.position.w, means[k].count > 0 ? 1.0F : 0.0F) << k;
    if (means[k].count == 0) continue;
    EXPECT_LT(glm::distance(glm::dvec3(area.position), means[k].position), 1e-6 * unit_m) << k;
    EXPECT_LT(glm::distance(glm::dvec3(area.axis), means[k].normal), 1e-6) << k;
  }
}

TEST_F(LightClustersTest, ScatteredSumsLeaveOutWhatHasNoFluxAndStartWarm) {
  LightSet lights = box_lights(200);
  darken(lights, 2, 1);
  cv::ClusterSettings settings{.clusters = 9, .sums = cv::ClusterSums::scatter, .is_warm = true};
  const auto buffer = buffer_of(context(), lights);
  cv::LightClusters clusters(context(), settings);
  const Clustered cold = update(clusters, buffer, lights);
  expect_means(lights, cold);
  EXPECT_EQ(std::ranges::count(cold.assignments, -1), 100);
  EXPECT_EQ(cold.summary.filled, 9);
  EXPECT_EQ(cold.summary.has_converged, 1);
  EXPECT_GT(cold.summary.iterations, 2);
  const Clustered warm = update(clusters, buffer, lights);
  EXPECT_EQ(warm.summary.iterations, 1) << "settled at once";
  EXPECT_EQ(warm.assignments, cold.assignments);

  darken(lights, 1, 0);
  const Clustered dark = update(clusters, buffer_of(context(), lights), lights);
  EXPECT_EQ(dark.summary.filled, 0);
  EXPECT_EQ(std::ranges::count(dark.assignments, -1), 200);
}

TEST_F(LightClustersTest, EveryStepIsTheOracles) {
  LightSet lights = box_lights(300);
  darken(lights, 7, 3);
  using cv::ClusterStart;
  using cv::ClusterSums;
  for (const auto& [start, sums] : {std::pair{ClusterStart::prefix, ClusterSums::integer},
                                    std::pair{ClusterStart::stride, ClusterSums::integer},
                                    std::pair{ClusterStart::prefix, ClusterSums::scatter},
                                    std::pair{ClusterStart::stride, ClusterSums::scatter}}) {
    cv::ClusterSettings settings{.clusters = 12, .start = start, .iterations = 30, .sums = sums};
    ASSERT_GT(least_margin(lights, settings), kNearTie) << "choose another set";
    const ClusterResult whole = oracle_clusters(lights, settings);
    ASSERT_TRUE(whole.is_converged);
    ASSERT_GE(whole.iterations, 5) << "or the test is trivial";
    for (int steps = 1; steps <= whole.iterations + 2; ++steps) {
      settings.iterations = steps;
      const ClusterResult expected = oracle_clusters(lights, settings);
      const Clustered result = cluster(lights, settings);
      EXPECT_EQ(result.assignments, expected.assignments) << steps;
      EXPECT_EQ(result.summary.iterations, std::min(steps, whole.iterations + 1));
      EXPECT_EQ(result.summary.has_converged, steps > whole.iterations ? 1 : 0) << steps;
      expect_means(lights, result);
    }
  }
}

TEST_F(LightClustersTest, CurvedSurfacesDifferFromTheOracleInNearTiesOnly) {
  const LightSet lights = sphere_lights(400);
  // Cosines near 1 are rounded to 6e-8: angles of 3e-4, 3e-5 of the distance.
  constexpr double kNearTieOfCurved = 5e-5;
  const cv::ClusterSettings settings{.clusters = 16, .iterations = 1};
  const ClusterResult expected = oracle_clusters(lights, settings);
  const Clustered result = cluster(lights, settings);
  int near_ties = 0;
  for (std::size_t i = 0; i < lights.lights.size(); ++i) {
    if (expected.margins[i] < kNearTieOfCurved) {
      ++near_ties;
    } else {
      EXPECT_EQ(result.assignments[i], expected.assignments[i]) << i;
    }
  }
  EXPECT_LT(near_ties, 4);
}

TEST_F(LightClustersTest, EndAtAFixedPoint) {
  const LightSet lights = sphere_lights(500);
  const cv::ClusterSettings settings{.clusters = 20, .iterations = 60};
  const Clustered result = cluster(lights, settings);
  ASSERT_EQ(result.summary.has_converged, 1);
  EXPECT_GT(result.summary.iterations, 4) << "or the test is trivial";
  EXPECT_EQ(result.summary.filled, 20);
  expect_means(lights, result);
  std::vector<OracleCluster> centers;
  for (const cv::AreaLight& area : result.area_lights) {
    centers.push_back({glm::dvec3(area.position), glm::dvec3(area.axis), 0});
  }
  const auto oracle = oracle_lights(lights);
  const ClusterRule rule = oracle_rule(lights, settings);
  for (std::size_t i = 0; i < oracle.size(); ++i) {
    const auto own = static_cast<std::size_t>(result.assignments[i]);
    EXPECT_LE(cluster_distance(rule, oracle[i], centers[own]),
              nearest_cluster(rule, oracle[i], centers).distance + 5e-5)
        << i;
  }
}

TEST_F(LightClustersTest, AreTheSameInEveryRun) {
  const LightSet lights = sphere_lights(1500);
  const cv::ClusterSettings settings{.clusters = 30, .iterations = 10};
  const Clustered first = cluster(lights, settings);
  for (int run = 0; run < 2; ++run) EXPECT_TRUE(is_same(cluster(lights, settings), first));
}

TEST_F(LightClustersTest, StartSkipsLightsWithoutFlux) {
  LightSet lights = box_lights(60);
  for (const std::size_t dark : {0U, 1U, 7U, 30U, 31U, 32U, 58U, 59U}) {
    lights.lights[dark].position.w = 0.0F;
  }
  const auto oracle = oracle_lights(lights);
  for (const cv::ClusterStart start : {cv::ClusterStart::prefix, cv::ClusterStart::stride}) {
    const cv::ClusterSettings settings{.clusters = 16, .start = start, .iterations = 1};
    const auto rule =
        start == cv::ClusterStart::prefix ? ClusterStart::prefix : ClusterStart::stride;
    const auto seeds = start_lights(oracle, 16, rule);
    const Clustered result = cluster(lights, settings);
    EXPECT_EQ(result.assignments, oracle_clusters(lights, settings).assignments);
    for (std::size_t k = 0; k < seeds.size(); ++k) {
      EXPECT_EQ(result.assignments[static_cast<std::size_t>(seeds[k])], static_cast<int>(k));
    }
  }
}

TEST_F(LightClustersTest, AsManyAsLightsGiveEachItsOwn) {
  const LightSet lights = sphere_lights(64);
  const Clustered result = cluster(lights, {.clusters = 64});
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_EQ(result.assignments[i], static_cast<int>(i));
    const cv::AreaLight& area = result.area_lights[i];
    EXPECT_EQ(area.position, lights.lights[i].position) << "to the last bit";
    EXPECT_EQ(glm::vec3(area.axis), glm::vec3(lights.lights[i].geometric_normal));
    EXPECT_EQ(area.shape.z, 0.0F);
    EXPECT_GT(area.shape.x, 0.0F) << "a least size";
  }
}

TEST_F(LightClustersTest, OneTakesAll) {
  LightSet lights = box_lights(100);
  darken(lights, 9, 2);
  const Clustered result = cluster(lights, {.clusters = 1});
  EXPECT_EQ(result.area_lights[0].shape.w, 89.0F);
  EXPECT_EQ(result.summary.iterations, 2) << "the second finds nothing to change";
  const auto all = mean_step(oracle_lights(lights), result.assignments, {OracleCluster{}});
  EXPECT_LT(glm::distance(glm::dvec3(result.area_lights[0].position), all[0].position), 1e-5);
  EXPECT_EQ(glm::vec3(result.area_lights[0].axis), glm::vec3(lights.lights[0].geometric_normal))
      << "opposite walls leave no mean normal: that of the start stays";
}

TEST_F(LightClustersTest, OrderOfLightsDoesNotMatter) {
  constexpr int kLights = 300;
  constexpr int kClusters = 14;
  const cv::ClusterSettings settings{.clusters = kClusters, .iterations = 30};
  const LightSet lights = box_lights(kLights);
  // The first lights, which the clusters start from, change places among themselves.
  const auto place = [](int i) {
    return i < kClusters ? kClusters - 1 - i
                         : kClusters + 5 * (i - kClusters) % (kLights - kClusters);
  };
  LightSet shuffled = lights;
  for (int i = 0; i < kLights; ++i) {
    shuffled.lights[static_cast<std::size_t>(place(i))] =
        lights.lights[static_cast<std::size_t>(i)];
  }
  const Clustered a = cluster(lights, settings);
  const Clustered b = cluster(shuffled, settings);
  EXPECT_GT(a.summary.iterations, 5);
  EXPECT_EQ(a.summary.iterations, b.summary.iterations);
  for (int i = 0; i < kLights; ++i) {
    EXPECT_EQ(b.assignments[static_cast<std::size_t>(place(i))],
              kClusters - 1 - a.assignments[static_cast<std::size_t>(i)])
        << i;
  }
}

TEST_F(LightClustersTest, ScaleOfTheSceneDoesNotMatter) {
  const LightSet lights = box_lights(300);
  const cv::ClusterSettings settings{.clusters = 12, .iterations = 30};
  ASSERT_GT(least_margin(lights, settings), kNearTie) << "choose another set";
  const Clustered result = cluster(lights, settings);
  // Powers of two round alike.
  for (const float factor : {1024.0F, 1.0F / 1024.0F, 1000.0F, 0.001F}) {
    const Clustered other = cluster(scaled(lights, factor), settings);
    EXPECT_EQ(other.assignments, result.assignments) << factor;
    EXPECT_EQ(other.summary.iterations, result.summary.iterations) << factor;
  }
}

}  // namespace
}  // namespace test_clustered_visibility
