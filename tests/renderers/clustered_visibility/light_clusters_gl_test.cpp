#include "renderers/clustered_visibility/light_clusters.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <glm/geometric.hpp>

#include "renderers/clustered_visibility/convolution_maps.h"
#include "renderers/many_lights/gather_settings.h"
#include "tests/renderers/clustered_visibility/cluster_oracle.h"
#include "tests/renderers/many_lights/gl_fixture.h"

namespace renderers::clustered_visibility {
namespace {

using many_lights::VirtualLight;
using test_clustered_visibility::ClusterRule;
using test_clustered_visibility::OracleCluster;
using test_clustered_visibility::OracleLight;

constexpr double kNearTie = 1e-5;
constexpr float kSide_m = 2.0F;

/// Lights on floor, left and back wall of a box of 2 m around the origin's corner; every tenth has
/// no flux.
std::vector<VirtualLight> lights_in_box(int count, float scale = 1.0F) {
  test::Numbers numbers;
  std::vector<VirtualLight> lights;
  for (int i = 0; i < count; ++i) {
    VirtualLight light;
    const int wall = i % 3;
    glm::vec3 position(numbers.between(0.0, 2.0), numbers.between(0.0, 2.0),
                       numbers.between(0.0, 2.0));
    glm::vec3 normal(0.0F);
    position[wall] = 0.0F;
    normal[wall] = 1.0F;
    if (i % 10 != 9) {
      light.position = glm::vec4(scale * position, 1.0F);
      light.geometric_normal = light.shading_normal = glm::vec4(normal, 0.0F);
      light.flux = glm::vec4(1.0F + static_cast<float>(i % 5), 2.0F, 3.0F, 0.0F);
    }
    lights.push_back(light);
  }
  return lights;
}

std::vector<OracleLight> oracle_lights(const std::vector<VirtualLight>& lights) {
  std::vector<OracleLight> result;
  for (const VirtualLight& light : lights) {
    result.push_back(
        {glm::dvec3(light.position), glm::dvec3(light.geometric_normal), light.position.w > 0.0F});
  }
  return result;
}

scene::Box bounds_of(float scale = 1.0F) { return {glm::vec3(0.0F), glm::vec3(scale * kSide_m)}; }

ClusterRule rule_of(const ClusterSettings& settings, float scale = 1.0F) {
  return {double{settings.position_weight}, double{settings.normal_weight},
          double{bounds_of(scale).diagonal_m()}};
}

class LightClustersGl : public test::GlTest {
 protected:
  ClusterInput input(const std::vector<VirtualLight>& lights, float scale = 1.0F) {
    buffer_ = opengl::Buffer::of<VirtualLight>(context(), lights);
    return {&buffer_, static_cast<int>(lights.size()), bounds_of(scale)};
  }
  LightClusters clustered(const std::vector<VirtualLight>& lights, const ClusterSettings& settings,
                          float scale = 1.0F) {
    LightClusters clusters(context(), settings);
    clusters.update(input(lights, scale));
    return clusters;
  }

 private:
  opengl::Buffer buffer_;
};

TEST_F(LightClustersGl, ConvergeToTheOraclesClusters) {
  const std::vector<VirtualLight> lights = lights_in_box(512);
  for (const ClusterStart start : {ClusterStart::stride, ClusterStart::prefix}) {
    ClusterSettings settings{.clusters = 12, .start = start, .iterations = 100};
    const LightClusters clusters = clustered(lights, settings);
    EXPECT_EQ(clusters.read_summary().has_converged, 1);
    const std::vector<OracleLight> oracle = oracle_lights(lights);
    const auto begin = test_clustered_visibility::clusters_at(
        oracle,
        test_clustered_visibility::start_lights(
            oracle, settings.clusters,
            start == ClusterStart::stride ? test_clustered_visibility::ClusterStart::stride
                                          : test_clustered_visibility::ClusterStart::prefix));
    const auto truth =
        test_clustered_visibility::cluster_lights(rule_of(settings), oracle, begin, 100);
    const std::vector<std::int32_t> assignments = clusters.read_assignments();
    int different = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
      if (assignments[i] != truth.assignments[i]) ++different;
      EXPECT_EQ(assignments[i] < 0, i % 10 == 9);
    }
    EXPECT_EQ(different, 0);
    const std::vector<AreaLight> areas = clusters.read_area_lights();
    for (std::size_t c = 0; c < areas.size(); ++c) {
      EXPECT_LT(glm::distance(glm::dvec3(areas[c].position), truth.clusters[c].position), 1e-4);
      EXPECT_NEAR(glm::dot(glm::dvec3(areas[c].axis), truth.clusters[c].normal), 1.0, 1e-6);
      EXPECT_EQ(static_cast<int>(areas[c].shape.w), truth.clusters[c].count);
    }
  }
}

TEST_F(LightClustersGl, EveryLightIsInItsNearestClusterOfMeans) {
  const std::vector<VirtualLight> lights = lights_in_box(1500);  // more than a work group
  const ClusterSettings settings{.clusters = 30, .iterations = 200};
  const LightClusters clusters = clustered(lights, settings);
  ASSERT_EQ(clusters.read_summary().has_converged, 1);
  std::vector<OracleCluster> centers;
  for (const AreaLight& area : clusters.read_area_lights()) {
    centers.push_back(
        {glm::dvec3(area.position), glm::dvec3(area.axis), static_cast<int>(area.shape.w)});
  }
  const auto nearest =
      test_clustered_visibility::assign_lights(rule_of(settings), oracle_lights(lights), centers);
  const std::vector<std::int32_t> assignments = clusters.read_assignments();
  int ties = 0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (nearest[i].margin < kNearTie) {
      ++ties;
    } else {
      EXPECT_EQ(assignments[i], nearest[i].index) << i;
    }
  }
  EXPECT_LT(ties, 15);
}

TEST_F(LightClustersGl, GiveTheSameBitsInEveryRun) {
  const std::vector<VirtualLight> lights = lights_in_box(1024);
  const LightClusters once = clustered(lights, {});
  const LightClusters again = clustered(lights, {});
  EXPECT_EQ(once.read_assignments(), again.read_assignments());
  const auto first = once.read_area_lights();
  const auto second = again.read_area_lights();
  for (std::size_t c = 0; c < first.size(); ++c) {
    EXPECT_EQ(first[c].position, second[c].position);
    EXPECT_EQ(first[c].axis, second[c].axis);
    EXPECT_EQ(first[c].shape, second[c].shape);
  }
}

TEST_F(LightClustersGl, DoNotDependOnUnits) {
  const ClusterSettings settings{.clusters = 16};
  const auto metres = clustered(lights_in_box(600), settings).read_assignments();
  for (const float scale : {1024.0F, 1.0F / 1024.0F, 1000.0F}) {
    const auto scaled = clustered(lights_in_box(600, scale), settings, scale).read_assignments();
    int different = 0;
    for (std::size_t i = 0; i < metres.size(); ++i) different += metres[i] != scaled[i] ? 1 : 0;
    EXPECT_LE(different, scale == 1000.0F ? 12 : 0) << scale;
  }
}

TEST_F(LightClustersGl, SingleLightsKeepTheirBits) {
  const std::vector<VirtualLight> lights = lights_in_box(40);
  const ClusterSettings settings{.clusters = 36, .start = ClusterStart::prefix};
  const auto areas = clustered(lights, settings).read_area_lights();
  std::size_t cluster = 0;
  for (const VirtualLight& light : lights) {
    if (light.position.w == 0.0F) continue;
    const bool is_there = std::ranges::any_of(areas, [&](const AreaLight& area) {
      return glm::vec3(area.position) == glm::vec3(light.position) &&
             glm::vec3(area.axis) == glm::vec3(light.geometric_normal);
    });
    EXPECT_TRUE(is_there) << cluster++;
  }
}

TEST_F(LightClustersGl, WithoutLightsOrWithFewAreEmptyAndFinite) {
  const auto dark = clustered(std::vector<VirtualLight>(50), {.clusters = 4});
  EXPECT_EQ(dark.read_summary().filled, 0);
  for (const std::int32_t cluster : dark.read_assignments()) EXPECT_EQ(cluster, -1);
  std::vector<VirtualLight> few(50);
  few[7] = lights_in_box(1)[0];
  const auto areas = clustered(few, {.clusters = 4}).read_area_lights();
  EXPECT_EQ(std::ranges::count_if(areas, [](const auto& a) { return a.position.w > 0.0F; }), 1);
  for (const AreaLight& area : areas) {
    EXPECT_TRUE(std::isfinite(area.shape.x + area.shape.y + area.position.x + area.axis.x));
  }
}

TEST_F(LightClustersGl, StartWarmFromTheLastUnlessRestarted) {
  ClusterSettings settings{.clusters = 12, .iterations = 100, .is_warm = true};
  LightClusters clusters(context(), settings);
  const std::vector<VirtualLight> lights = lights_in_box(512);
  clusters.update(input(lights));
  const ClusterSummary cold = clusters.read_summary();
  EXPECT_GT(cold.iterations, 2);
  clusters.update(input(lights));
  EXPECT_EQ(clusters.read_summary().iterations, 1);
  clusters.restart();
  clusters.update(input(lights));
  EXPECT_EQ(clusters.read_summary().iterations, cold.iterations);
}

TEST_F(LightClustersGl, NormalsKeepTheWallsOfABoxApart) {
  const std::vector<VirtualLight> lights = lights_in_box(1024);
  const auto mixed = [&](float normal_weight) {
    const LightClusters clusters =
        clustered(lights, {.clusters = 30, .normal_weight = normal_weight});
    std::map<std::int32_t, std::set<int>> walls;
    const auto assignments = clusters.read_assignments();
    for (std::size_t i = 0; i < lights.size(); ++i) {
      if (assignments[i] >= 0) walls[assignments[i]].insert(static_cast<int>(i % 3));
    }
    return std::ranges::count_if(walls, [](const auto& each) { return each.second.size() > 1; });
  };
  EXPECT_GT(mixed(0.0F), 0);
  EXPECT_EQ(mixed(0.3F), 0);
}

TEST_F(LightClustersGl, AreaLightsHaveTheOraclesSizes) {
  const std::vector<VirtualLight> lights = lights_in_box(512);
  const std::vector<OracleLight> oracle = oracle_lights(lights);
  using test_clustered_visibility::AreaRule;
  for (const AreaFrom from : {AreaFrom::rectangle, AreaFrom::covariance}) {
    // Without normals, so that clusters bend around the corners and lights lie above the planes.
    const LightClusters clusters =
        clustered(lights, {.clusters = 10, .normal_weight = 0.0F, .area = from});
    const auto assigned = clusters.read_assignments();
    const std::vector<int> assignments(assigned.begin(), assigned.end());
    const auto areas = clusters.read_area_lights();
    for (int c = 0; c < 10; ++c) {
      const AreaLight& area = areas[static_cast<std::size_t>(c)];
      const OracleCluster cluster{glm::dvec3(area.position), glm::dvec3(area.axis), 1};
      const auto extent = test_clustered_visibility::cluster_extent(
          test_clustered_visibility::member_positions(oracle, assignments, c), cluster,
          from == AreaFrom::rectangle ? AreaRule::bounding_rectangle : AreaRule::covariance, 1e-6);
      EXPECT_NEAR(area.shape.z, extent.area_m2, 1e-4 * (1.0 + extent.area_m2));
      EXPECT_NEAR(area.shape.x, extent.size_m, 1e-4);
      EXPECT_NEAR(area.axis.w, extent.height_m, 1e-5);
      const double farthest =
          glm::length(glm::max(glm::abs(glm::dvec3(area.position)),
                               glm::abs(glm::dvec3(area.position) - double{kSide_m})));
      EXPECT_NEAR(area.shape.y, double{kFarDepth} / farthest, 1e-5);
    }
  }
}

TEST_F(LightClustersGl, RunsAreSortedByClusterAndLoseNothing) {
  const std::vector<VirtualLight> lights = lights_in_box(250);  // no multiple of 9 or 64
  for (const int interleave : {1, 3, 8}) {
    const ClusterInput given = input(lights);
    LightClusters clusters(context(), {.clusters = 7});
    clusters.update(given);
    clusters.sort_runs(given, interleave);
    const auto assignments = clusters.read_assignments();
    const auto sorted = clusters.sorted().read<VirtualLight>(lights.size());
    for (int pixel = 0; pixel < interleave * interleave; ++pixel) {
      const many_lights::LightRun run =
          many_lights::light_run(pixel % interleave, pixel / interleave, interleave, 250);
      std::vector<int> order;
      for (int i = run.first; i < run.first + run.count; ++i) order.push_back(i);
      const auto key = [&](int i) {
        const std::int32_t cluster = assignments[static_cast<std::size_t>(i)];
        return cluster < 0 ? 7 : cluster;
      };
      std::ranges::stable_sort(order, [&](int a, int b) { return key(a) < key(b); });
      for (int i = 0; i < run.count; ++i) {
        const auto original = static_cast<std::size_t>(order[static_cast<std::size_t>(i)]);
        const VirtualLight& light = sorted[static_cast<std::size_t>(run.first + i)];
        EXPECT_EQ(light.position, lights[original].position);
        EXPECT_EQ(light.flux.x, lights[original].flux.x);
        EXPECT_EQ(light.flux.w, static_cast<float>(assignments[original]));
      }
    }
  }
}

}  // namespace
}  // namespace renderers::clustered_visibility
