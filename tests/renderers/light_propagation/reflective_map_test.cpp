#include "renderers/light_propagation/reflective_map.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "renderers/contract/devices.h"
#include "tests/renderers/area_shadows/polygon_irradiance.h"
#include "tests/renderers/scene_builder.h"

/// Sources of light-propagation from reflective shadow maps of point and spot lights.
namespace renderers::light_propagation {
namespace {

using test::lambert;
using test::SceneBuilder;

constexpr int kRays = 16384;

/// A closed box of 2 m with a sheet in it.
SceneBuilder box() {
  SceneBuilder builder;
  const int grey = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_box({-1, -1, -1}, {1, 1, 1}, grey, true);
  builder.add_quad({-0.9F, 0.2F, -0.3F}, {0.5F, 0.2F, 0}, {0, 0.1F, 0.7F}, grey);
  return builder;
}

double injected_w(const scene::Scene& scene) {
  StageTimer timer;
  const ray_tracing::RayScene rays(scene, timer);
  const Grid grid = grid_around({rays.box_min(), rays.box_max()}, 16);
  const ReflectiveMap map = reflective_map(rays, kRays);
  return inject(grid, map.samples, map.light.samples).flux().y;
}

/// All light meets a surface: half of 4 pi I, and of a spot's cone what its falloff leaves.
TEST(ReflectiveMap, InjectsWhatTheLightsGive) {
  SceneBuilder point = box();
  point.add_point_light({0.3F, -0.2F, 0.4F}, glm::vec3(2.0F));
  EXPECT_NEAR(injected_w(point.scene), 0.5 * 4.0 * std::numbers::pi * 2.0, 1e-3 * 12.6);
  SceneBuilder spot = box();
  scene::Light light;
  light.type = scene::LightType::spot;
  light.position = {0, 0.5F, 0};
  light.direction = {0, -1, 0};
  light.intensity = glm::vec3(3.0F);
  light.inner_cone_rad = light.outer_cone_rad = 0.5F;
  spot.scene.lights.push_back(light);
  const double cone_sr = 2.0 * std::numbers::pi * (1.0 - std::cos(0.5));
  EXPECT_NEAR(injected_w(spot.scene), 0.5 * cone_sr * 3.0, 1e-3 * 2.4);
}

/// The same light gathered at samples on the surfaces: other noise, one picture.
TEST(ReflectiveMap, GivesThePictureOfGatheringSamples) {
  SceneBuilder builder = box();
  builder.add_point_light({0.1F, 0.6F, -0.3F}, glm::vec3(1.0F));
  builder.look({0, 0, -0.95F}, {0, -0.2F, 1}, 80.0F);
  const auto picture = [&](const char* sources) {
    return test::render(builder.scene,
                        {.renderer = "light-propagation",
                         .settings = {sources, "part=indirect", "cells=16", "steps=32"},
                         .width_px = 24,
                         .height_px = 24,
                         .samples = 0});
  };
  const Frame maps = picture("sources=rsm");
  const Frame gathered = picture("sources=poisson");
  EXPECT_LT(test::relative_rmse(maps.radiance, gathered.radiance), 0.06);
  EXPECT_EQ(test::counter(maps, "gather_rays"), 65536.0);
  EXPECT_GT(test::counter(maps, "surface_samples"), 60000.0);
}

TEST(ReflectiveMap, HasNoneOfAreaLights) {
  SceneBuilder builder = box();
  builder.add_quad({-0.2F, 0.9F, -0.2F}, {0.4F, 0, 0}, {0, 0, 0.4F},
                   builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F))));
  StageTimer timer;
  const ray_tracing::RayScene rays(builder.scene, timer);
  EXPECT_THROW(reflective_map(rays, kRays), UnsupportedError);
}

}  // namespace
}  // namespace renderers::light_propagation
