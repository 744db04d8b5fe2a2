#include "renderers/clustered_visibility/light_clusters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/renderers/clustered_visibility/light_bench.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/many_lights/light_oracle.h"

/// Lights without flux, odd numbers of lights and clusters, calls one after the other.
namespace test_clustered_visibility {
namespace {

class LightClustersEdgeTest : public renderers::test::GlTest {
 protected:
  Clustered cluster(const LightSet& lights, const cv::ClusterSettings& settings) const {
    return cluster_on_device(context(), lights, settings);
  }
  Clustered update(cv::LightClusters& clusters, const LightSet& lights) const {
    const auto buffer = buffer_of(context(), lights);
    return test_clustered_visibility::update(clusters, buffer, lights);
  }
};

bool is_finite(const glm::vec4& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

void expect_empty(const cv::AreaLight& area) {
  EXPECT_EQ(area.position, glm::vec4(0.0F));
  EXPECT_NEAR(glm::length(glm::vec3(area.axis)), 1.0F, 1e-6F) << "the map's frame needs one";
  EXPECT_EQ(area.shape, glm::vec4(0.0F));
  EXPECT_EQ(area.flux, glm::vec4(0.0F));
}

TEST_F(LightClustersEdgeTest, LightsWithoutFluxNeverMoveACentre) {
  const LightSet lights = box_lights(200);
  const cv::ClusterSettings settings{.clusters = 10, .iterations = 30};
  const Clustered without = cluster(lights, settings);
  LightSet more = lights;
  const VirtualLight far =
      renderers::test::flat_light({3.9, 2.9, 2.4}, {0, 0, -1}, glm::dvec3(7.0));
  for (const int place : {200, 120, 10}) {
    more.lights.insert(more.lights.begin() + place, far);
    more.lights.insert(more.lights.begin() + place, VirtualLight{});
  }
  EXPECT_NE(cluster(more, settings).area_lights[0].shape, without.area_lights[0].shape)
      << "lights with flux must show";
  for (VirtualLight& light : more.lights) {
    if (light.position == far.position) light.position.w = 0.0F;
  }
  Clustered with = cluster(more, settings);
  for (const std::size_t i : {10U, 11U, 122U, 123U, 204U, 205U}) {
    EXPECT_EQ(with.assignments[i], -1) << i;
  }
  std::erase(with.assignments, -1);
  EXPECT_TRUE(is_same(with, without));
}

TEST_F(LightClustersEdgeTest, WithoutAnyFluxAllAreEmpty) {
  for (const cv::ClusterStart start : {cv::ClusterStart::prefix, cv::ClusterStart::stride}) {
    LightSet lights = box_lights(70);
    darken(lights, 1, 0);
    const Clustered result = cluster(lights, {.clusters = 8, .start = start});
    EXPECT_EQ(result.assignments, std::vector<int>(70, -1));
    EXPECT_EQ(result.summary.filled, 0);
    EXPECT_EQ(result.summary.has_converged, 1);
    for (const cv::AreaLight& area : result.area_lights) expect_empty(area);
  }
}

TEST_F(LightClustersEdgeTest, MoreThanLightsLeaveTheLastOnesEmpty) {
  LightSet lights = box_lights(20);
  darken(lights, 2, 1);
  const Clustered result = cluster(lights, {.clusters = 16});
  EXPECT_EQ(result.summary.filled, 10);
  for (std::size_t k = 0; k < 10; ++k) EXPECT_EQ(result.area_lights[k].shape.w, 1.0F) << k;
  for (std::size_t k = 10; k < 16; ++k) expect_empty(result.area_lights[k]);
}

TEST_F(LightClustersEdgeTest, EqualLightsShareTheFirstOfEqualCentres) {
  LightSet lights = box_lights(1);
  lights.lights.resize(40, lights.lights[0]);
  const Clustered result = cluster(lights, {.clusters = 5});
  EXPECT_EQ(result.assignments, std::vector<int>(40, 0));
  EXPECT_EQ(result.summary.filled, 1);
  EXPECT_EQ(result.area_lights[0].position, lights.lights[0].position);
  for (const cv::AreaLight& area : result.area_lights) {
    for (const glm::vec4& v : {area.position, area.axis, area.shape, area.flux}) {
      EXPECT_TRUE(is_finite(v));
    }
  }
}

TEST_F(LightClustersEdgeTest, OneLight) {
  const LightSet lights = box_lights(1);
  const Clustered result = cluster(lights, {.clusters = 3});
  EXPECT_EQ(result.assignments, std::vector<int>{0});
  EXPECT_EQ(result.area_lights[0].position, lights.lights[0].position);
  EXPECT_EQ(glm::vec3(result.area_lights[0].flux), glm::vec3(lights.lights[0].flux));
  expect_empty(result.area_lights[1]);
}

TEST_F(LightClustersEdgeTest, LightsOfOnePlane) {
  LightSet lights = box_lights(300);
  for (VirtualLight& light : lights.lights) {
    light.position.z = 0.0F;
    light.geometric_normal = glm::vec4(0.0F, 0.0F, 1.0F, 0.0F);
  }
  lights.bounds.greatest.z = 0.0F;
  const cv::ClusterSettings settings{.clusters = 9, .iterations = 40};
  ASSERT_GT(least_margin(lights, settings), kNearTie) << "choose another set";
  const Clustered result = cluster(lights, settings);
  EXPECT_EQ(result.assignments, oracle_clusters(lights, settings).assignments);
  for (const cv::AreaLight& area : result.area_lights) {
    EXPECT_LT(glm::distance(glm::vec3(area.axis), glm::vec3(0, 0, 1)), 1e-6F);
    EXPECT_LT(area.axis.w, 1e-6F) << "nothing above the plane";
    EXPECT_GT(area.shape.z, 0.1F);
  }
}

TEST_F(LightClustersEdgeTest, MoreLightsThanThreads) {
  const LightSet lights = box_lights(5000);
  const cv::ClusterSettings settings{.clusters = 24, .iterations = 4};
  const ClusterResult expected = oracle_clusters(lights, settings);
  const Clustered result = cluster(lights, settings);
  int differing = 0;
  int near_ties = 0;
  for (std::size_t i = 0; i < lights.lights.size(); ++i) {
    if (result.assignments[i] != expected.assignments[i]) ++differing;
    if (expected.margins[i] < 1e-4) ++near_ties;
  }
  // A few near ties move the centres of 200 lights by little, other near ties follow.
  EXPECT_LE(differing, near_ties);
  EXPECT_LT(near_ties, 20);
  EXPECT_EQ(counts_of(result.assignments, 24).back(),
            static_cast<int>(result.area_lights.back().shape.w));
}

TEST_F(LightClustersEdgeTest, TurnsOfOneDispatchDoNotMatter) {
  const LightSet lights = sphere_lights(3000);
  cv::ClusterSettings settings{.clusters = 40, .iterations = 200, .most_turns = 1 << 30};
  const Clustered at_once = cluster(lights, settings);
  ASSERT_EQ(at_once.summary.has_converged, 1);
  ASSERT_GT(at_once.summary.iterations, 15);
  // One iteration a dispatch; a few of them, the last dispatch with fewer.
  for (const int most_turns : {1, 1500}) {
    settings.most_turns = most_turns;
    EXPECT_TRUE(is_same(cluster(lights, settings), at_once)) << most_turns;
    settings.iterations = 11;
    const Clustered capped = cluster(lights, settings);
    EXPECT_EQ(capped.summary.iterations, 11);
    EXPECT_EQ(capped.summary.has_converged, 0);
    settings.most_turns = 1 << 30;
    EXPECT_TRUE(is_same(capped, cluster(lights, settings))) << most_turns;
    settings.iterations = 200;
  }
}

TEST_F(LightClustersEdgeTest, AlmostAllLightsWithoutFluxAreSkipped) {
  LightSet lights = box_lights(cv::kMostLights);
  const int dark = cv::kMostLights - cv::kMostClusters;
  for (int i = 0; i < dark; ++i) {
    lights.lights[static_cast<std::size_t>(i)].position.w = 0.0F;
  }
  for (const cv::ClusterStart start : {cv::ClusterStart::prefix, cv::ClusterStart::stride}) {
    const Clustered result =
        cluster(lights, {.clusters = cv::kMostClusters, .start = start, .iterations = 1});
    EXPECT_EQ(result.summary.filled, cv::kMostClusters);
    for (int i = 0; i < cv::kMostLights; ++i) {
      ASSERT_EQ(result.assignments[static_cast<std::size_t>(i)], i < dark ? -1 : i - dark) << i;
    }
  }
}

TEST_F(LightClustersEdgeTest, AsManyClustersAsAreAllowed) {
  const LightSet lights = box_lights(1024);
  const cv::ClusterSettings settings{.clusters = cv::kMostClusters, .iterations = 2};
  const ClusterResult expected = oracle_clusters(lights, settings);
  const Clustered result = cluster(lights, settings);
  int differing = 0;
  for (std::size_t i = 0; i < lights.lights.size(); ++i) {
    if (result.assignments[i] == expected.assignments[i]) continue;
    ++differing;
    EXPECT_LT(expected.margins[i], kNearTie) << i;
  }
  EXPECT_LT(differing, 3);
}

TEST_F(LightClustersEdgeTest, SumsOfTheMostLightsDoNotOverflow) {
  // All but one in the farthest corner: the greatest sums there can be.
  LightSet lights = box_lights(1);
  lights.lights[0] = renderers::test::flat_light({0, 0, 0}, {1, 0, 0}, glm::dvec3(1.0));
  lights.bounds.greatest = glm::vec3(4.0F);
  lights.lights.resize(cv::kMostLights,
                       renderers::test::flat_light({4, 4, 4}, {-1, 0, 0}, glm::dvec3(1.0)));
  const Clustered result = cluster(lights, {.clusters = 2, .iterations = 5});
  EXPECT_EQ(result.summary.has_converged, 1);
  EXPECT_EQ(result.summary.iterations, 2);
  EXPECT_EQ(counts_of(result.assignments, 2), (std::vector<int>{1, cv::kMostLights - 1}));
  // Every light is in its area light: software drivers end loops after 65,535 turns in all.
  EXPECT_EQ(result.area_lights[1].flux.x,
            static_cast<float>(cv::kMostLights - 1) * lights.lights[0].flux.x);
  EXPECT_EQ(glm::vec3(result.area_lights[1].position), glm::vec3(4.0F));
}

TEST_F(LightClustersEdgeTest, WarmStartSettlesAtOnceOnTheSameLights) {
  const LightSet lights = box_lights(300);
  cv::LightClusters clusters(context(), {.clusters = 12, .iterations = 30, .is_warm = true});
  const Clustered first = update(clusters, lights);
  ASSERT_EQ(first.summary.has_converged, 1);
  ASSERT_GT(first.summary.iterations, 3);
  const Clustered second = update(clusters, lights);
  EXPECT_EQ(second.summary.iterations, 1);
  EXPECT_TRUE(is_same(first, second));
  cv::LightClusters cold(context(), {.clusters = 12, .iterations = 30});
  update(cold, lights);
  EXPECT_EQ(update(cold, lights).summary.iterations, first.summary.iterations);
}

TEST_F(LightClustersEdgeTest, RestartForgets) {
  const LightSet before = box_lights(300, 1);
  const LightSet lights = box_lights(300);
  const cv::ClusterSettings settings{.clusters = 12, .iterations = 30, .is_warm = true};
  cv::LightClusters clusters(context(), settings);
  update(clusters, before);
  const Clustered warm = update(clusters, lights);
  const Clustered fresh = cluster(lights, settings);
  EXPECT_FALSE(is_same(warm, fresh)) << "or nothing is remembered";
  update(clusters, before);
  clusters.restart();
  EXPECT_TRUE(is_same(update(clusters, lights), fresh));
  update(clusters, before);
  update(clusters, box_lights(299));
  EXPECT_TRUE(is_same(update(clusters, lights), fresh)) << "so does another number of lights";
}

TEST_F(LightClustersEdgeTest, WarmStartGoesOnWhereTheLastCallWasCapped) {
  const LightSet lights = box_lights(300);
  const Clustered expected = cluster(lights, {.clusters = 12, .iterations = 40});
  ASSERT_EQ(expected.summary.has_converged, 1);
  for (const int iterations : {1, 2, 3}) {
    cv::LightClusters clusters(context(),
                               {.clusters = 12, .iterations = iterations, .is_warm = true});
    Clustered result;
    for (int call = 0; call < 40; ++call) result = update(clusters, lights);
    EXPECT_EQ(result.summary.has_converged, 1);
    EXPECT_TRUE(is_same(result, expected)) << iterations;
  }
}

TEST_F(LightClustersEdgeTest, WarmStartRecoversFromDarkness) {
  const LightSet lights = box_lights(100);
  LightSet dark = lights;
  darken(dark, 1, 0);
  LightSet dim = lights;
  for (VirtualLight& light : dim.lights) {
    if (light.position.x > 0.5F) light.position.w = 0.0F;
  }
  cv::LightClusters clusters(context(), {.clusters = 40, .iterations = 20, .is_warm = true});
  EXPECT_EQ(update(clusters, dark).summary.filled, 0);
  const int few = update(clusters, dim).summary.filled;
  EXPECT_GT(few, 5);
  EXPECT_LT(few, 40) << "fewer lights than clusters";
  EXPECT_GT(update(clusters, lights).summary.filled, few) << "clusters without a start get one";
  EXPECT_EQ(update(clusters, lights).summary.iterations, 1);
}

}  // namespace
}  // namespace test_clustered_visibility
