#include "renderers/ray_tracing/direct_light_pass.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::ray_tracing {
namespace {

using perception::Image;
using test::SceneBuilder;

constexpr int kSide_px = 16;

scene::Light spot_at(const glm::vec3& position, const glm::vec3& direction) {
  scene::Light spot;
  spot.type = scene::LightType::spot;
  spot.position = position;
  spot.intensity = {6, 5, 4};
  spot.direction = glm::normalize(direction);
  spot.inner_cone_rad = 0.3F;
  spot.outer_cone_rad = 0.5F;
  return spot;
}

int add_checkers(SceneBuilder& builder) {
  scene::Texture texture;
  texture.image = perception::make_rgb_image(4, 4, perception::Encoding::scene_linear);
  for (int i = 0; i < 16; ++i) {
    for (int c = 0; c < 3; ++c)
      texture.image.at(i % 4, i / 4, c) = (i + i / 4) % 2 == 0 ? 0.8F : 0.1F;
  }
  builder.scene.textures.push_back(texture);
  return static_cast<int>(builder.scene.textures.size()) - 1;
}

/// Three walls of a room, a box in it.
SceneBuilder open_room(const scene::Material& wall, const scene::Material& box) {
  SceneBuilder builder;
  const int walls = builder.add_material(wall);
  builder.add_quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, walls);
  builder.add_quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, walls);
  builder.add_quad({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, walls);
  builder.add_box({-0.4F, -1, -0.2F}, {0.2F, -0.3F, 0.4F}, builder.add_material(box), false);
  builder.look({0.3F, 0.2F, -3}, {0, -0.1F, 0}, 45.0F);
  return builder;
}

SceneBuilder spot_and_lamp() {
  SceneBuilder builder =
      open_room(test::lambert({0.7F, 0.6F, 0.5F}), test::lambert({0.2F, 0.3F, 0.6F}));
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.3F), {8, 7, 6}));
  builder.add_quad({-0.3F, 0.9F, -0.3F}, {0.6F, 0, 0}, {0, 0, 0.6F}, lamp);
  builder.add_quad({0.5F, 0.4F, 0.98F}, {0, 0.3F, 0}, {0.3F, 0, 0}, lamp);  // next to the wall
  builder.scene.lights.push_back(spot_at({0.8F, 0.9F, -0.8F}, {-1, -1.3F, 1.2F}));
  return builder;
}

SceneBuilder point_and_environment_on_glossy_texture() {
  SceneBuilder builder = open_room(test::lambert(glm::vec3(0.9F)),
                                   test::phong({0.2F, 0.3F, 0.2F}, glm::vec3(0.5F), 40.0F));
  builder.scene.materials[0].albedo_texture = add_checkers(builder);
  builder.add_point_light({0.6F, 0.2F, -0.4F}, {0.5F, 0.7F, 0.9F});
  auto environment = std::make_shared<scene::Environment>();
  environment->image = perception::make_rgb_image(16, 8, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < environment->image.pixels.size(); ++i) {
    environment->image.pixels[i] = i % 37 == 0 ? 4.0F : 0.2F;
  }
  builder.scene.environment = environment;
  return builder;
}

SceneBuilder everything() {
  SceneBuilder builder = point_and_environment_on_glossy_texture();
  scene::Material lamp = test::lambert(glm::vec3(0.3F), {8, 7, 6});
  lamp.emission_texture = add_checkers(builder);
  builder.add_quad({-0.3F, 0.9F, -0.3F}, {0.6F, 0, 0}, {0, 0, 0.6F}, builder.add_material(lamp));
  builder.add_sphere(
      {0.5F, -0.6F, -0.3F}, 0.35F, 12,
      builder.add_material(test::phong(glm::vec3(0.1F), {0.7F, 0.5F, 0.3F}, 200.0F)));
  builder.scene.lights.push_back(spot_at({0.8F, 0.9F, -0.8F}, {-1, -1.3F, 1.2F}));
  return builder;
}

DirectLight render_pass(const scene::Scene& scene, const DirectLightSettings& settings,
                        std::uint64_t seed = 1, std::uint32_t pass = 0) {
  StageTimer timer;
  const RayScene rays(scene, timer);
  return DirectLightPass(rays, settings).render({kSide_px, kSide_px, scene.camera, seed, pass});
}

/// Per-pixel mean and variance of that mean over independent seeds.
struct Estimate {
  std::vector<double> mean;
  std::vector<double> variance;
};

Estimate estimate(const scene::Scene& scene, const DirectLightSettings& settings, int seeds) {
  StageTimer timer;
  const RayScene rays(scene, timer);
  const DirectLightPass pass(rays, settings);
  std::vector<double> sum;
  std::vector<double> squares;
  for (int seed = 0; seed < seeds; ++seed) {
    const DirectLight light =
        pass.render({kSide_px, kSide_px, scene.camera, static_cast<std::uint64_t>(100 + seed), 0});
    sum.resize(light.radiance.pixels.size());
    squares.resize(light.radiance.pixels.size());
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const auto value = static_cast<double>(light.radiance.pixels[i]);
      sum[i] += value;
      squares[i] += value * value;
    }
  }
  Estimate made;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double mean = sum[i] / seeds;
    made.mean.push_back(mean);
    made.variance.push_back(std::max(0.0, squares[i] / seeds - mean * mean) / (seeds - 1));
  }
  return made;
}

struct Agreement {
  double mean_z = 0.0;     ///< of the image's mean
  double mean_z2 = 0.0;    ///< mean of the pixels' squared z
  double relative = 0.0;   ///< of the image's mean
  double precision = 0.0;  ///< standard error of `relative`
};

/// Compares with the path tracer's direct light, by the variances of both.
Agreement agreement(const scene::Scene& scene, const Estimate& made) {
  const Frame path = test::render(scene, {.settings = {"transport=direct"},
                                          .width_px = kSide_px,
                                          .height_px = kSide_px,
                                          .samples = 2048});
  const Image& variance = test::aov(path, "variance");
  double difference = 0.0;
  double sigma2 = 0.0;
  double total = 0.0;
  Agreement result;
  int pixels = 0;
  for (std::size_t i = 0; i < made.mean.size(); ++i) {
    const auto expected = static_cast<double>(path.radiance.pixels[i]);
    const double delta = made.mean[i] - expected;
    // Floats limit what noise-free pixels agree to.
    const double joint = made.variance[i] + static_cast<double>(variance.pixels[i]) +
                         1e-12 * expected * expected + 1e-20;
    difference += delta;
    sigma2 += joint;
    total += expected;
    result.mean_z2 += delta * delta / joint;
    ++pixels;
  }
  result.mean_z2 /= pixels;
  result.mean_z = difference / std::sqrt(sigma2);
  result.relative = difference / total;
  result.precision = std::sqrt(sigma2) / total;
  return result;
}

void expect_same_as_path(const SceneBuilder& builder, int light_samples,
                         ReflectedRays reflected_rays = ReflectedRays::always) {
  const DirectLightSettings settings{.pixel_rays = PixelRays::spread,
                                     .camera_rays = 64,
                                     .light_samples = light_samples,
                                     .reflected_rays = reflected_rays};
  const Agreement result = agreement(builder.scene, estimate(builder.scene, settings, 16));
  EXPECT_LT(std::fabs(result.mean_z), 4.5);
  EXPECT_LT(result.precision, 0.003);
  // Variances of 16 and 8 values: the mean of z2 is near 1.25 (measured 1.0 to 1.3).
  EXPECT_GT(result.mean_z2, 0.5);
  EXPECT_LT(result.mean_z2, 1.8);
}

TEST(DirectLightPass, SpotAndLampAreThePathTracersDirectLight) {
  expect_same_as_path(spot_and_lamp(), 1);
  expect_same_as_path(spot_and_lamp(), 3);
}

TEST(DirectLightPass, PointAndEnvironmentOnGlossyAndTextureAreThePathTracersDirectLight) {
  expect_same_as_path(point_and_environment_on_glossy_texture(), 1);
}

TEST(DirectLightPass, EverythingIsThePathTracersDirectLight) {
  expect_same_as_path(everything(), 2);
}

TEST(DirectLightPass, WithReflectedRaysFromGlossySurfacesAloneTheMeanStays) {
  expect_same_as_path(everything(), 1, ReflectedRays::glossy);
  const SceneBuilder lambert = spot_and_lamp();
  const DirectLightSettings settings{.reflected_rays = ReflectedRays::glossy};
  EXPECT_EQ(render_pass(lambert.scene, settings).counts.reflected, 0U);
  EXPECT_GT(render_pass(lambert.scene, {}).counts.reflected, 0U);
}

TEST(DirectLightPass, AMissingLightWouldShow) {
  SceneBuilder without = everything();
  const DirectLightSettings settings{.pixel_rays = PixelRays::spread, .camera_rays = 64};
  without.scene.lights[0].intensity *= 0.8F;  // the point light
  const Estimate dimmed = estimate(without.scene, settings, 16);
  const Agreement result = agreement(everything().scene, dimmed);
  EXPECT_GT(std::fabs(result.mean_z), 6.0);
  EXPECT_GT(result.mean_z2, 2.0);
}

TEST(DirectLightPass, PointLightFollowsCosineOverSquaredDistanceWithTwoRaysAPixel) {
  SceneBuilder builder;
  builder.add_quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0},
                   builder.add_material(test::lambert({0.2F, 0.4F, 0.8F})));
  builder.add_point_light({1, 2, -1}, {10, 20, 30});
  builder.look({3, 1, 2}, {0, 0, 0}, 0.01F);
  const DirectLight light = render_pass(builder.scene, {});
  const glm::dvec3 expected =
      glm::dvec3(2, 8, 24) * (2.0 / std::sqrt(6.0) / 6.0 / std::numbers::pi);
  for (std::size_t i = 0; i < light.radiance.pixels.size(); ++i) {
    const double e = expected[static_cast<int>(i % 3)];
    EXPECT_NEAR(static_cast<double>(light.radiance.pixels[i]), e, 1e-3 * e);
    EXPECT_EQ(light.seen.pixels[i], 0.0F);
  }
  EXPECT_EQ(light.counts.camera, light.radiance.pixel_count());
  EXPECT_EQ(light.counts.shadow, light.radiance.pixel_count());
  EXPECT_EQ(light.counts.reflected, 0U);
}

TEST(DirectLightPass, FixedRaysGoThroughTheCentrePlusTheOffset) {
  // A lamp that fills the picture: radiance is its texture where the ray meets it.
  SceneBuilder builder;
  scene::Material lamp = test::lambert(glm::vec3(0.0F), glm::vec3(2.0F));
  lamp.emission_texture = add_checkers(builder);
  builder.add_quad({-2, -2, 1}, {0, 4, 0}, {4, 0, 0}, builder.add_material(lamp));
  builder.look({0, 0, -1}, {0, 0, 1}, 50.0F);
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  const LightSampler lights(rays);
  const CameraRays camera(builder.scene.camera, kSide_px, kSide_px);
  for (const glm::vec2& offset : {glm::vec2(0.0F), glm::vec2(0.3F, -0.45F)}) {
    const DirectLight light = render_pass(builder.scene, {.offset_px = offset});
    for (int y = 0; y < kSide_px; ++y) {
      for (int x = 0; x < kSide_px; ++x) {
        const Ray ray = camera.through(static_cast<float>(x) + (0.5F + offset.x),
                                       static_cast<float>(y) + (0.5F + offset.y));
        Hit hit;
        ASSERT_TRUE(rays.intersect(ray, hit));
        EXPECT_EQ(light.radiance.at(x, y), lights.emission(hit, -ray.direction).x);
        EXPECT_EQ(light.seen.at(x, y), light.radiance.at(x, y));
      }
    }
  }
}

TEST(DirectLightPass, SeenIsEmissionAndEnvironmentAlone) {
  SceneBuilder builder = spot_and_lamp();
  builder.set_environment({1, 2, 3});
  builder.add_quad({-0.8F, 0.2F, -1.2F}, {0, 0.5F, 0}, {0.5F, 0, 0}, 2);
  const DirectLight light = render_pass(builder.scene, {});
  int lamp = 0;
  int sky = 0;
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 0; x < kSide_px; ++x) {
      const float seen = light.seen.at(x, y);
      lamp += seen == 8.0F ? 1 : 0;
      sky += seen == 1.0F ? 1 : 0;
      EXPECT_TRUE(seen == 8.0F || seen == 1.0F || seen == 0.0F) << seen;
      if (seen == 1.0F) {
        EXPECT_EQ(light.radiance.at(x, y), 1.0F);
      }
      EXPECT_GE(light.radiance.at(x, y), seen);
    }
  }
  EXPECT_GT(lamp, 4);
  EXPECT_GT(sky, 4);
}

TEST(DirectLightPass, PassesContinueTheSamples) {
  const SceneBuilder builder = everything();
  DirectLightSettings settings{.pixel_rays = PixelRays::spread, .camera_rays = 4};
  const DirectLight whole = render_pass(builder.scene, settings);
  settings.camera_rays = 1;
  std::vector<float> sum(whole.radiance.pixels.size());
  for (std::uint32_t pass = 0; pass < 4; ++pass) {
    const DirectLight part = render_pass(builder.scene, settings, 1, pass);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += 0.25F * part.radiance.pixels[i];
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    EXPECT_NEAR(sum[i], whole.radiance.pixels[i], 1e-5F * whole.radiance.pixels[i]);
  }
}

TEST(DirectLightPass, SeedsDifferAndThreadsDoNot) {
  const SceneBuilder builder = everything();
  const auto render = [&](int threads, std::uint64_t seed) {
    const base::ThreadLimit limit(threads);
    return render_pass(builder.scene, {}, seed).radiance.pixels;
  };
  const std::vector<float> one = render(1, 1);
  EXPECT_EQ(one, render(2, 1));
  EXPECT_EQ(one, render(4, 1));
  EXPECT_NE(one, render(1, 2));
}

TEST(DirectLightPass, RefusesCountsBelowOne) {
  const scene::Scene scene;
  StageTimer timer;
  const RayScene rays(scene, timer);
  EXPECT_EQ(tests::input_error_of([&] { DirectLightPass(rays, {.camera_rays = 0}); }),
            "direct light pass: camera_rays is 0; accepted: 1 and more");
  EXPECT_EQ(tests::input_error_of([&] { DirectLightPass(rays, {.light_samples = -2}); }),
            "direct light pass: light_samples is -2; accepted: 1 and more");
}

}  // namespace
}  // namespace renderers::ray_tracing
