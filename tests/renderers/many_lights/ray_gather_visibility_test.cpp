#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/many_lights/ray_gather.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "tests/renderers/many_lights/ray_cast_inputs.h"
#include "tests/renderers/scene_builder.h"

/// Shadow rays of the gather: energy in closed rooms, acne, leaks, threads.
namespace renderers::many_lights {
namespace {

using ray_tracing::RayScene;
using ray_tracing::SurfacePoint;
using test::light_at;
using test::numbers;
using test::SceneBuilder;

/// Closed room, optionally with a floating block and one on the floor, without bottom.
SceneBuilder room(bool has_blocks) {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert(glm::vec3(0.7F)));
  builder.add_box({0, 0, 0}, {3, 2, 2.5F}, wall, true);
  if (has_blocks) {
    builder.add_box({0.6F, 0.7F, 0.5F}, {1.3F, 1.2F, 1.4F}, wall, false);
    builder.add_box({1.9F, 0.3F, 1.2F}, {2.3F, 1.5F, 1.9F}, wall, false);
  }
  return builder;
}

struct AreaReceivers {
  SurfaceImage surfaces;
  std::vector<double> area_m2;  ///< that each stands for
};

/// Points on the front sides of all triangles, `per_triangle` each.
AreaReceivers receivers_by_area(const RayScene& rays, std::uint32_t per_triangle) {
  const scene::Scene& scene = rays.scene();
  AreaReceivers made;
  made.surfaces =
      test::make_surfaces(static_cast<int>(per_triangle), static_cast<int>(rays.triangle_count()));
  std::size_t pixel = 0;
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    const auto triangles = scene.objects[object].mesh->triangles.size();
    for (std::uint32_t triangle = 0; triangle < triangles; ++triangle) {
      const auto area_m2 = static_cast<double>(rays.triangle_area_m2(object, triangle));
      for (std::uint32_t i = 0; i < per_triangle; ++i) {
        const glm::vec4 u = numbers(100 + pixel / per_triangle, i);
        const SurfacePoint point =
            rays.point_on_triangle(object, triangle, ray_tracing::uniform_triangle({u.x, u.y}));
        test::put_surface(scene, point, point.geometric_normal, made.surfaces, pixel++);
        made.area_m2.push_back(area_m2 / per_triangle);
      }
    }
  }
  return made;
}

/// Lights on the surfaces, at least 0.15 of a triangle's height from its edges: close to a corner
/// the irradiance next to a light has a peak that no small set of receivers resolves.
std::vector<VirtualLight> lights_on_surfaces(const RayScene& rays, std::uint32_t per_triangle) {
  const scene::Scene& scene = rays.scene();
  std::vector<VirtualLight> lights;
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    for (std::uint32_t triangle = 0; triangle < 2; ++triangle) {
      for (std::uint32_t i = 0; i < per_triangle; ++i) {
        const glm::vec4 u = numbers(5000 + 2 * object + triangle, i);
        const glm::vec2 weights = 0.15F + 0.55F * ray_tracing::uniform_triangle({u.x, u.y});
        const SurfacePoint point = rays.point_on_triangle(object, triangle, weights);
        lights.push_back(light_at(point.position, point.geometric_normal, {1, u.z, 0.5F}));
      }
    }
  }
  return lights;
}

struct Energy {
  double received = 0.0;
  double emitted = 0.0;
  std::uint64_t rays = 0;
  std::uint64_t occluded = 0;
  double ratio() const { return received / emitted; }
};

Energy energy_of(const RayScene& rays, bool has_visibility, float epsilon = kDefaultEpsilon) {
  const AreaReceivers receivers = receivers_by_area(rays, 2048);
  const std::vector<VirtualLight> lights = lights_on_surfaces(rays, 2);
  const auto result = gather_by_rays({.scene = rays.scene(),
                                      .surfaces = receivers.surfaces,
                                      .lights = lights,
                                      .rays = has_visibility ? &rays : nullptr,
                                      .epsilon = epsilon},
                                     {.interleave = 1});
  Energy energy;
  for (std::size_t i = 0; i < receivers.area_m2.size(); ++i) {
    energy.received += receivers.area_m2[i] * static_cast<double>(result.irradiance[i].x);
  }
  for (const VirtualLight& light : lights) energy.emitted += static_cast<double>(light.flux.x);
  energy.rays = result.rays;
  energy.occluded = result.occluded;
  return energy;
}

TEST(RayGatherVisibility, AllEnergyArrivesInAClosedRoom) {
  const SceneBuilder builder = room(false);
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  const Energy energy = energy_of(rays, true);
  EXPECT_NEAR(energy.ratio(), 1.0, 0.005);
  // Nothing stands between two points of a convex room: whatever blocks is a surface's own acne.
  EXPECT_GT(energy.rays, 100'000U);
  EXPECT_EQ(energy.occluded, 0U);
}

TEST(RayGatherVisibility, AllEnergyArrivesInAClosedRoomWithBlocks) {
  const SceneBuilder builder = room(true);
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  const Energy energy = energy_of(rays, true);
  EXPECT_NEAR(energy.ratio(), 1.0, 0.005);
  EXPECT_GT(energy.occluded, energy.rays / 20);
  // Without visibility the blocks' far sides are lit through them.
  EXPECT_GT(energy_of(rays, false).ratio(), 1.05);
}

/// Moves the receivers off their surfaces, in and out, as a rasteriser's rounding would.
void shake(SurfaceImage& surfaces, float amplitude_m) {
  for (std::uint32_t i = 0; i < surfaces.position.size(); ++i) {
    const glm::vec4 u = numbers(77, i);
    const float distance_m = amplitude_m * (2.0F * u.x - 1.0F);
    surfaces.position[i] += distance_m * glm::vec4(glm::vec3(surfaces.geometric_normal[i]), 0);
  }
}

/// Share of wrongly occluded rays between shaken receivers and lights of an empty room.
double acne(const RayScene& rays, float shake_diagonals, float epsilon) {
  AreaReceivers receivers = receivers_by_area(rays, 512);
  const float diagonal_m = glm::distance(rays.box_min(), rays.box_max());
  shake(receivers.surfaces, shake_diagonals * diagonal_m);
  const std::vector<VirtualLight> lights = lights_on_surfaces(rays, 2);
  const auto result = gather_by_rays({.scene = rays.scene(),
                                      .surfaces = receivers.surfaces,
                                      .lights = lights,
                                      .rays = &rays,
                                      .epsilon = epsilon},
                                     {.interleave = 1});
  return static_cast<double>(result.occluded) / static_cast<double>(result.rays);
}

TEST(RayGatherVisibility, EpsilonCoversTheErrorOfPositions) {
  const SceneBuilder builder = room(false);
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  for (const float shake_diagonals : {0.0F, 1e-6F, 1e-5F}) {
    EXPECT_EQ(acne(rays, shake_diagonals, kDefaultEpsilon), 0.0) << shake_diagonals;
  }
  EXPECT_GT(acne(rays, 1e-5F, 1e-6F), 0.1) << "an epsilon below the error must show";
}

TEST(RayGatherVisibility, EpsilonHardlyChangesTheEnergy) {
  const SceneBuilder builder = room(true);
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  const double ratio = energy_of(rays, true).ratio();
  // Measured: +3e-5 and -4e-4.
  EXPECT_NEAR(energy_of(rays, true, 1e-5F).ratio(), ratio, 1e-4);
  EXPECT_NEAR(energy_of(rays, true, 1e-3F).ratio(), ratio, 1e-3);
  EXPECT_LT(energy_of(rays, true, 0.03F).ratio(), ratio - 0.01) << "a huge epsilon must show";
}

/// Receivers on one side of a wall, on it and near where it meets the room; lights on the other.
GatheredLight light_through_wall(float thickness_m, float epsilon) {
  SceneBuilder builder = room(false);
  builder.add_box({1.5F, -0.1F, -0.1F}, {1.5F + thickness_m, 2.1F, 2.6F}, 0, false);
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  constexpr std::uint32_t kReceivers = 1024;
  SurfaceImage surfaces = test::make_surfaces(kReceivers, 1);
  std::vector<VirtualLight> lights;
  for (std::uint32_t i = 0; i < kReceivers; ++i) {
    const glm::vec4 u = numbers(9, i);
    const float distance_m = 0.2F * u.x * u.x * u.x;
    const bool is_on_wall = i % 2 == 0;
    const glm::vec3 normal = is_on_wall ? glm::vec3(-1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 position = is_on_wall ? glm::vec3(1.5F, distance_m, 2.5F * u.y)
                                          : glm::vec3(1.5F - distance_m, 0, 2.5F * u.y);
    surfaces.position[i] = {position, 1};
    surfaces.geometric_normal[i] = {normal, 0};
    surfaces.shading_normal[i] = {glm::normalize(normal + glm::vec3(0.3F, 0.2F, 0)), 0};
    if (i >= 128) continue;
    const float along = 1.5F + thickness_m + 0.3F * u.z * u.z;
    lights.push_back(light_at({along, 0, 2.5F * u.w}, {0, 1, 0}, glm::vec3(1.0F)));
    lights.push_back(light_at({along, 2, 2.5F * u.w}, {0, -1, 0}, glm::vec3(1.0F)));
    lights.push_back(light_at({3, 2 * u.y, 2.5F * u.w}, {-1, 0, 0}, glm::vec3(1.0F)));
  }
  return gather_by_rays({.scene = builder.scene,
                         .surfaces = surfaces,
                         .lights = lights,
                         .rays = &rays,
                         .epsilon = epsilon},
                        {.interleave = 1});
}

TEST(RayGatherVisibility, NoLightLeaksThroughAWallThickerThanTheMargins) {
  // The default margin is 0.44 mm here.
  const GatheredLight tight = light_through_wall(0.002F, kDefaultEpsilon);
  EXPECT_GT(tight.rays, 100'000U);
  EXPECT_EQ(tight.occluded, tight.rays);
  const GatheredLight leaking = light_through_wall(0.002F, 1e-3F);
  EXPECT_LT(leaking.occluded, leaking.rays) << "margins beyond the wall must leak";
}

TEST(RayGatherVisibility, NoThreadCountChangesABit) {
  SceneBuilder builder = room(true);
  builder.look({1.5F, 1.9F, 0.1F}, {1.6F, 0.5F, 1.5F}, 80.0F);
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  const SurfaceImage surfaces = test::cast_surfaces(rays, 19, 23);
  const std::vector<VirtualLight> lights = lights_on_surfaces(rays, 3);
  const RayGatherInput input{
      .scene = builder.scene, .surfaces = surfaces, .lights = lights, .rays = &rays};
  const auto gather = [&](int threads) {
    const base::ThreadLimit limit(threads);
    return gather_by_rays(input, {.interleave = 2});
  };
  const GatheredLight one = gather(1);
  for (const int threads : {2, 4}) {
    const GatheredLight other = gather(threads);
    EXPECT_EQ(one.irradiance, other.irradiance);
    EXPECT_EQ(one.rays, other.rays);
    EXPECT_EQ(one.occluded, other.occluded);
  }
}

}  // namespace
}  // namespace renderers::many_lights
