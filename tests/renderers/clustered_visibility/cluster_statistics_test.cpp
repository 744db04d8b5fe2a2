#include "renderers/clustered_visibility/cluster_statistics.h"

#include <gtest/gtest.h>

namespace renderers::clustered_visibility {
namespace {

/// Four lights on a floor and one on a wall, in two clusters; a third one is empty.
ClusterState floor_and_wall() {
  ClusterState state;
  const glm::vec4 up(0.0F, 1.0F, 0.0F, 0.0F);
  const glm::vec4 right(1.0F, 0.0F, 0.0F, 0.0F);
  for (int i = 0; i < 5; ++i) {
    many_lights::VirtualLight light;
    light.position = {static_cast<float>(i), 0.0F, 0.0F, 1.0F};
    light.geometric_normal = i == 4 ? right : up;
    state.lights.push_back(light);
  }
  state.assignments = {0, 0, 1, 1, 1};
  state.area_lights.resize(3);
  state.area_lights[0].position = {0.5F, 0.0F, 0.0F, 1.0F};
  state.area_lights[1].position = {3.0F, 0.0F, 0.0F, 1.0F};
  for (AreaLight& area : state.area_lights) area.axis = up;
  state.area_lights[0].shape.z = 1.0F;
  state.area_lights[1].shape.z = 3.0F;
  state.area_lights[1].axis.w = -0.25F;  // backs alone
  state.summary = {7, 1, 2};
  return state;
}

double value_of(const std::vector<std::pair<std::string, CounterValue>>& counters,
                const std::string& name) {
  for (const auto& [each, value] : counters) {
    if (each == name) return std::get<double>(value);
  }
  ADD_FAILURE() << name;
  return 0.0;
}

TEST(ClusterStatistics, AreThoseOfTheClustersWithLights) {
  const auto counters = cluster_counters(floor_and_wall(), 1);
  EXPECT_EQ(value_of(counters, "vals"), 2.0);
  EXPECT_EQ(value_of(counters, "cluster_iterations"), 7.0);
  EXPECT_EQ(value_of(counters, "cluster_converged"), 1.0);
  EXPECT_EQ(value_of(counters, "mixed_vals"), 1.0);  // the light on the wall
  EXPECT_NEAR(value_of(counters, "normal_spread_deg"), 90.0 / std::sqrt(5.0), 1e-4);
  EXPECT_EQ(value_of(counters, "val_area_m2"), 2.0);
  EXPECT_EQ(value_of(counters, "clip_height_m"), 0.25);
  EXPECT_EQ(value_of(counters, "lights_per_pixel"), 5.0);
  EXPECT_EQ(value_of(counters, "visibilities_per_pixel"), 2.0);
  EXPECT_EQ(value_of(counters, "point_vals"), 0.0);
  EXPECT_EQ(value_of(counters, "least_run"), 5.0);
  EXPECT_EQ(value_of(counters, "longest_run"), 5.0);
  ClusterState flat = floor_and_wall();
  flat.area_lights[0].shape.z = 0.0F;
  EXPECT_EQ(value_of(cluster_counters(flat, 1), "point_vals"), 1.0);
}

TEST(ClusterStatistics, RunsOfInterleavedPixelsHoldTheirShare) {
  ClusterState state = floor_and_wall();
  state.assignments = {0, 0, 1, -1, 1};  // runs of four classes: 0 | 0 | 1 | -1, 1
  const auto counters = cluster_counters(state, 2);
  EXPECT_EQ(value_of(counters, "lights_per_pixel"), 1.0);
  EXPECT_EQ(value_of(counters, "visibilities_per_pixel"), 1.0);
  EXPECT_EQ(value_of(counters, "least_run"), 1.0);
  EXPECT_EQ(value_of(counters, "longest_run"), 2.0);
}

TEST(ClusterStatistics, TellLightsOfOnePlane) {
  ClusterState state = floor_and_wall();
  EXPECT_FALSE(is_in_one_plane(state, 10.0)) << "one is on the wall";
  state.assignments[4] = -1;
  EXPECT_TRUE(is_in_one_plane(state, 10.0));
  state.lights[2].position.y = 0.01F;
  EXPECT_FALSE(is_in_one_plane(state, 10.0));
  state.assignments = {0, -1, -1, -1, -1};
  EXPECT_FALSE(is_in_one_plane(state, 10.0)) << "one light is no plane";
}

TEST(ClusterStatistics, ChangesAreThoseOfLightsAndClustersInBothStates) {
  const ClusterState before = floor_and_wall();
  ClusterState after = before;
  after.assignments = {0, 1, 1, 1, -1};
  after.area_lights[0].position.x += 1.0F;
  after.area_lights[2].position = {9.0F, 0.0F, 0.0F, 1.0F};  // was empty
  const auto changes = change_counters(before, after, 10.0);
  EXPECT_EQ(value_of(changes, "assignment_churn"), 0.25);
  EXPECT_NEAR(value_of(changes, "val_shift_p50"), 0.05, 1e-7);
  EXPECT_NEAR(value_of(changes, "val_shift_p95"), 0.095, 1e-7);
}

TEST(ClusterStatistics, OtherNumbersOfLightsHaveNoChange) {
  const ClusterState before = floor_and_wall();
  ClusterState after = before;
  after.assignments.push_back(0);
  EXPECT_TRUE(change_counters(before, after, 1.0).empty());
}

}  // namespace
}  // namespace renderers::clustered_visibility
