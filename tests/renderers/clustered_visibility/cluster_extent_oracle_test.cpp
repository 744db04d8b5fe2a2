#include "tests/renderers/clustered_visibility/cluster_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "renderers/shadow_maps/hemisphere_projection.h"

namespace test_clustered_visibility {
namespace {

const glm::dvec3 kX(1.0, 0.0, 0.0);
const glm::dvec3 kZ(0.0, 0.0, 1.0);

TEST(ClusterExtentOracle, AreaOfARectangle) {
  for (const glm::dvec3& normal : {kZ, -kZ, kX, glm::normalize(glm::dvec3(1.0, -2.0, -3.0))}) {
    const glm::dmat3 frame = renderers::shadow_maps::hemisphere_frame(normal);
    const OracleCluster cluster{{1.0, 2.0, 3.0}, normal, 3};
    const std::vector<glm::dvec3> members{cluster.position + frame * glm::dvec3(-1.0, 0.0, 0.25),
                                          cluster.position + frame * glm::dvec3(2.0, 0.5, 0.75),
                                          cluster.position + frame * glm::dvec3(0.0, -1.5, -1.0)};
    const auto extent = cluster_extent(members, cluster, AreaRule::bounding_rectangle, 0.01);
    EXPECT_NEAR(extent.area_m2, 3.0 * 2.0, 1e-13);
    EXPECT_NEAR(extent.size_m, std::sqrt(6.0), 1e-13);
    EXPECT_NEAR(extent.height_m, 0.75, 1e-14);
  }
}

TEST(ClusterExtentOracle, CovarianceOfAGridIsNearlyItsRectangle) {
  // n points evenly from end to end have a variance of w^2 (n + 1) / (12 (n - 1)).
  std::vector<glm::dvec3> members;
  for (int i = 0; i < 11; ++i) {
    for (int k = 0; k < 5; ++k) members.push_back({0.2 * i, 0.25 * k, 0.0});
  }
  const OracleCluster cluster{{1.0, 0.5, 0.0}, kZ, 55};
  const auto area = [&](AreaRule rule) {
    return cluster_extent(members, cluster, rule, 0.0).area_m2;
  };
  EXPECT_NEAR(area(AreaRule::bounding_rectangle), 2.0, 1e-14);
  EXPECT_NEAR(area(AreaRule::covariance), 2.0 * std::sqrt(12.0 / 10.0 * 6.0 / 4.0), 1e-14);
  members.push_back({30.0, 0.5, 0.0});
  EXPECT_LT(area(AreaRule::covariance), 0.6 * area(AreaRule::bounding_rectangle)) << "an outlier";
}

TEST(ClusterExtentOracle, SmallClustersHaveTheMinimumSize) {
  for (const AreaRule rule : {AreaRule::bounding_rectangle, AreaRule::covariance}) {
    for (const int members : {0, 1}) {
      const std::vector<glm::dvec3> positions(static_cast<std::size_t>(members), {1.0, 1.0, -2.0});
      const ClusterExtent extent = cluster_extent(positions, OracleCluster{}, rule, 0.02);
      EXPECT_EQ(extent.area_m2, 0.0);
      EXPECT_EQ(extent.size_m, 0.02);
      EXPECT_EQ(extent.height_m, 0.0);
    }
  }
}

}  // namespace
}  // namespace test_clustered_visibility
