#include "renderers/clustered_visibility/light_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "renderers/clustered_visibility/convolution_maps.h"
#include "tests/renderers/clustered_visibility/cluster_oracle.h"
#include "tests/renderers/clustered_visibility/light_bench.h"
#include "tests/renderers/many_lights/gl_fixture.h"

/// What area lights say about their clusters, and lights sorted by cluster.
namespace test_clustered_visibility {
namespace {

class AreaLightsTest : public renderers::test::GlTest {
 protected:
  Clustered cluster(const LightSet& lights, const cv::ClusterSettings& settings) const {
    return cluster_on_device(context(), lights, settings);
  }
  /// The lights as `sort_runs` leaves them.
  std::vector<VirtualLight> sorted(const LightSet& lights, int interleave,
                                   std::vector<int>& assignments) const {
    const auto buffer = buffer_of(context(), lights);
    cv::LightClusters clusters(context(), {.clusters = 12});
    assignments = update(clusters, buffer, lights).assignments;
    clusters.sort_runs({&buffer, lights.count(), lights.bounds}, interleave);
    return clusters.sorted().read<VirtualLight>(lights.lights.size());
  }
};

void expect_extent(const LightSet& lights, const Clustered& result, std::size_t k, AreaRule rule) {
  const cv::AreaLight& area = result.area_lights[k];
  const auto members =
      member_positions(oracle_lights(lights), result.assignments, static_cast<int>(k));
  const OracleCluster center{glm::dvec3(area.position), glm::dvec3(area.axis), 0};
  const double diagonal_m = static_cast<double>(lights.bounds.diagonal_m());
  const ClusterExtent extent = cluster_extent(members, center, rule, 1e-6 * diagonal_m);
  EXPECT_NEAR(area.shape.z, extent.area_m2, 1e-6 * diagonal_m * diagonal_m) << k;
  EXPECT_NEAR(area.shape.z, extent.area_m2, 1e-4 * extent.area_m2 + 1e-10) << k;
  EXPECT_NEAR(area.shape.x, extent.size_m, 1e-4 * extent.size_m) << k;
  // Below 0: of what is so low, the map leaves out backs alone.
  EXPECT_NEAR(-area.axis.w, extent.height_m, 1e-6 * diagonal_m) << k;
}

TEST_F(AreaLightsTest, SizeAndHeightAreTheOracles) {
  for (const LightSet& lights : {box_lights(300), sphere_lights(300)}) {
    for (const bool is_covariance : {false, true}) {
      const auto result = cluster(
          lights, {.clusters = 12,
                   .normal_weight = 0.1F,
                   .area = is_covariance ? cv::AreaFrom::covariance : cv::AreaFrom::rectangle});
      double highest_m = 0.0;
      for (std::size_t k = 0; k < 12; ++k) {
        expect_extent(lights, result, k,
                      is_covariance ? AreaRule::covariance : AreaRule::bounding_rectangle);
        highest_m = std::max(highest_m, -static_cast<double>(result.area_lights[k].axis.w));
      }
      EXPECT_GT(highest_m, 0.05) << "some have lights above their plane";
    }
  }
}

TEST_F(AreaLightsTest, TheClipHeightIsAboveZeroWhereAllIsClipped) {
  const LightSet lights = sphere_lights(300);
  const auto behind = cluster(lights, {.clusters = 12}).area_lights;
  const auto all = cluster(lights, {.clusters = 12, .clip = cv::Clip::all}).area_lights;
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_GT(all[k].axis.w, 0.0F);
    EXPECT_EQ(all[k].axis.w, -behind[k].axis.w);
  }
}

TEST_F(AreaLightsTest, FarthestCornerOfTheSceneIsFarDepth) {
  const LightSet lights = sphere_lights(300);
  const glm::dvec3 least(lights.bounds.least);
  const glm::dvec3 greatest(lights.bounds.greatest);
  for (const cv::AreaLight& area : cluster(lights, {.clusters = 12}).area_lights) {
    double farthest_m = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::bvec3 is_high(corner & 1, corner & 2, corner & 4);
      const glm::dvec3 position = glm::mix(least, greatest, is_high);
      farthest_m = std::max(farthest_m, glm::distance(position, glm::dvec3(area.position)));
    }
    EXPECT_NEAR(area.shape.y * farthest_m, 0.9, 1e-6);
  }
  EXPECT_EQ(cv::kFarDepth, 0.9F);
}

TEST_F(AreaLightsTest, FluxAndNumberAreSumsOverTheLights) {
  LightSet lights = box_lights(300);
  darken(lights, 5, 1);
  const Clustered result = cluster(lights, {.clusters = 12});
  const auto counts = counts_of(result.assignments, 12);
  int first = 0;
  glm::dvec3 all(0.0);
  for (std::size_t k = 0; k < 12; ++k) {
    glm::dvec3 flux(0.0);
    for (std::size_t i = 0; i < lights.lights.size(); ++i) {
      if (result.assignments[i] == static_cast<int>(k)) flux += glm::dvec3(lights.lights[i].flux);
    }
    const cv::AreaLight& area = result.area_lights[k];
    EXPECT_LT(glm::distance(glm::dvec3(area.flux), flux), 1e-6 * glm::length(flux)) << k;
    EXPECT_EQ(area.shape.w, static_cast<float>(counts[k])) << k;
    EXPECT_EQ(area.flux.w, static_cast<float>(first)) << k;
    first += counts[k];
    all += glm::dvec3(area.flux);
  }
  EXPECT_EQ(first, 240);
  glm::dvec3 expected(0.0);
  for (const VirtualLight& light : lights.lights) expected += glm::dvec3(light.flux);
  EXPECT_LT(glm::distance(all, expected), 1e-5) << "no light is lost";
}

/// Clusters with lights of more than one wall.
int mixed_clusters(const LightSet& lights, const Clustered& result) {
  int mixed = 0;
  for (std::size_t k = 0; k < result.area_lights.size(); ++k) {
    std::set<int> walls;
    for (std::size_t i = 0; i < lights.lights.size(); ++i) {
      if (result.assignments[i] != static_cast<int>(k)) continue;
      const glm::vec4& normal = lights.lights[i].geometric_normal;
      walls.insert(static_cast<int>(normal.x + 3.0F * normal.y + 9.0F * normal.z));
    }
    if (walls.size() > 1) ++mixed;
  }
  return mixed;
}

TEST_F(AreaLightsTest, NormalsKeepWallsApart) {
  const LightSet lights = box_lights(1000);
  const auto mixed = [&](float normal_weight) {
    return mixed_clusters(lights, cluster(lights, {.clusters = 30,
                                                   .normal_weight = normal_weight,
                                                   .start = cv::ClusterStart::stride}));
  };
  EXPECT_EQ(mixed(0.3F), 0);
  EXPECT_GT(mixed(0.0F), 9);
}

/// Indices of the lights of every run, sorted by cluster, lights without flux last.
std::vector<std::size_t> expected_order(const std::vector<int>& assignments, int runs) {
  std::vector<std::size_t> order(assignments.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) {
    return assignments[i] < 0 ? std::numeric_limits<int>::max() : assignments[i];
  };
  const auto count = static_cast<std::ptrdiff_t>(order.size());
  for (std::ptrdiff_t run = 0; run < runs; ++run) {
    std::stable_sort(order.begin() + run * count / runs, order.begin() + (run + 1) * count / runs,
                     [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  }
  return order;
}

TEST_F(AreaLightsTest, RunsAreSortedByCluster) {
  LightSet lights = box_lights(403);  // 403 is no multiple of 9 or 64
  darken(lights, 6, 4);
  for (const int interleave : {1, 3, 8}) {
    std::vector<int> assignments;
    const auto result = sorted(lights, interleave, assignments);
    const auto order = expected_order(assignments, interleave * interleave);
    int without_flux = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const VirtualLight& light = lights.lights[order[i]];
      EXPECT_EQ(result[i].position, light.position) << interleave << " " << i;
      EXPECT_EQ(result[i].geometric_normal, light.geometric_normal);
      EXPECT_EQ(result[i].shading_normal, light.shading_normal);
      EXPECT_EQ(glm::vec3(result[i].flux), glm::vec3(light.flux));
      EXPECT_EQ(result[i].flux.w, static_cast<float>(assignments[order[i]]));
      if (result[i].flux.w == -1.0F) ++without_flux;
    }
    EXPECT_EQ(without_flux, 67);
  }
}

TEST_F(AreaLightsTest, MoreRunsThanLightsLeaveEachAlone) {
  LightSet lights = box_lights(10);
  std::vector<int> assignments;
  const auto result = sorted(lights, 8, assignments);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(result[i].position, lights.lights[i].position);
    EXPECT_EQ(result[i].flux.w, static_cast<float>(assignments[i]));
  }
}

}  // namespace
}  // namespace test_clustered_visibility
