#include "renderers/final_gather/sender_points.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "renderers/final_gather/sender_transfer.h"
#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"

/// Points on patches and clusters, by area and by power.
namespace renderers::test {
namespace {

using final_gather::Receiver;
using final_gather::SenderPoint;
using final_gather::SenderPoints;
using final_gather::SenderTransfer;

/// A floor below a small lamp beside large plates that are nearly dark, all of it one cluster.
SceneBuilder lamp_among_plates() {
  SceneBuilder builder;
  const int dark = builder.add_material(lambert(glm::vec3(0.05F)));
  const int lamp =
      builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F / std::numbers::pi_v<float>)));
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, dark);
  builder.add_quad({-0.1F, 2, -0.1F}, {0.2F, 0, 0}, {0, 0, 0.2F}, lamp);
  builder.add_quad({-2, 2.2F, -2}, {2, 0, 0}, {0, 0, 2}, dark);
  builder.add_quad({0, 2.4F, 0}, {2, 0, 0}, {0, 0, 2}, dark);
  return builder;
}

Receiver on_floor(const SolvedScene& solved) {
  Receiver receiver;
  receiver.point = solved.rays.point_on_triangle(0, 0, {0.3F, 0.4F});
  receiver.normal = {0, 1, 0};
  return receiver;
}

/// Light of the whole scene as one sender, by so many samples, and its error over many seeds.
struct Spread {
  double mean;
  double deviation;
};
Spread light_of_all(const SolvedScene& solved, bool by_power, double samples) {
  constexpr int kSeeds = 400;
  double sum = 0.0;
  double squares = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const SenderTransfer transfer(
        *solved.solution,
        {.points = {.by_power = by_power, .seed = static_cast<std::uint64_t>(seed)}});
    const auto light =
        static_cast<double>(transfer.whole(on_floor(solved), 0, samples).irradiance.x);
    sum += light;
    squares += light * light;
  }
  const double mean = sum / kSeeds;
  return {mean, std::sqrt(squares / kSeeds - mean * mean)};
}

TEST(SenderPoints, PowerFindsTheLampInACluster) {
  const SceneBuilder builder = lamp_among_plates();
  const SolvedScene solved(builder.scene, solver_settings(64));
  const Spread exact = light_of_all(solved, false, 2000.0);
  const Spread by_area = light_of_all(solved, false, 8.0);
  const Spread by_power = light_of_all(solved, true, 8.0);
  EXPECT_NEAR(by_power.mean, exact.mean, 0.02 * exact.mean);
  EXPECT_GT(by_area.deviation, 1.0 * exact.mean);  // the control: the lamp is mostly missed
  EXPECT_LT(by_power.deviation, 0.25 * exact.mean);
}

/// A side of one radiosity brings the cluster's mean: brighter ones are drawn more often instead.
TEST(SenderPoints, BringTheClustersMean) {
  const SceneBuilder builder = lamp_among_plates();
  const SolvedScene solved(builder.scene, solver_settings(64));
  const SenderPoints points(*solved.solution, {});
  const SenderPoints by_area(*solved.solution, {.by_power = false});
  const float mean = points.mean_radiosity(0).x;
  EXPECT_EQ(mean, solved.solution->field->radiosity()[0].x);
  int on_lamp = 0;
  int by_chance = 0;
  for (std::uint32_t i = 0; i < 100; ++i) {
    const SenderPoint point = points.fixed(0, i);
    if (point.side.surface.object == 1) {
      ++on_lamp;
      EXPECT_NEAR(point.radiosity.x, mean, 1e-5F * mean);
    }
    by_chance += by_area.fixed(0, i).side.surface.object == 1 ? 1 : 0;
  }
  EXPECT_GT(on_lamp, 50);
  EXPECT_LT(by_chance, 5);
}

/// The points that are kept are those that would be drawn, and go on as they do.
TEST(SenderPoints, KeptOnesAreThoseDrawn) {
  const SceneBuilder builder = closed_room();
  const SolvedScene solved(builder.scene, solver_settings(400));
  const SenderPoints points(*solved.solution, {});
  for (const auto& link : solved.solution->links.all()) {
    for (const std::uint32_t index : {0U, 5U, 31U, 32U, 400U}) {
      const SenderPoint kept = points.fixed(link.source, index);
      const SenderPoint drawn =
          points.at(link.source,
                    sender_position(points.settings().positions, points.key(link.source), index));
      ASSERT_EQ(kept.side.surface.position, drawn.side.surface.position);
      ASSERT_EQ(kept.side.normal, drawn.side.normal);
      ASSERT_EQ(kept.radiosity, drawn.radiosity);
    }
  }
  EXPECT_GT(points.memory_bytes(), 0);
}

/// The last number before 1 rounds up to the sum where much comes before: sides without weight are
/// not drawn, whichever come last.
TEST(SenderPoints, SidesWithoutWeightAreNotDrawn) {
  const SceneBuilder builder = closed_room();
  const SolvedScene solved(builder.scene, solver_settings(1));
  const std::size_t count = solved.tree().roots().size();
  constexpr float kLast = 0x1.fffffep-1F;
  for (const std::size_t bright : {std::size_t{0}, count / 2, count - 1}) {
    std::vector<double> before(count + 1, 1e9);
    for (std::size_t i = bright + 1; i <= count; ++i) before[i] = 1e9 + 1e-6;
    for (const float u : {0.0F, 0.5F, kLast}) {
      const auto point = solved.tree().sample(0, {u, 0.25F}, before);
      EXPECT_EQ(point.root, bright) << u;
      EXPECT_TRUE(std::isfinite(point.surface.position.x)) << u;
    }
  }
}

/// Nothing in a cluster sends light: by area.
TEST(SenderPoints, DarkClustersHavePoints) {
  SceneBuilder builder;
  const int black = builder.add_material(lambert(glm::vec3(0.0F)));
  builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, black);
  builder.add_point_light({0, 1, 0}, glm::vec3(1.0F));
  const SolvedScene solved(builder.scene, solver_settings(64));
  const SenderPoints points(*solved.solution, {});
  ASSERT_FALSE(solved.tree().at(0).is_patch);
  for (std::uint32_t i = 0; i < 8; ++i) {
    const SenderPoint point = points.fixed(0, i);
    EXPECT_NEAR(point.side.surface.position.y, 0.0F, 1e-6F);
    EXPECT_EQ(point.radiosity, glm::vec3(0.0F));
  }
}

}  // namespace
}  // namespace renderers::test
