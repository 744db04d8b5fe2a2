#include <cmath>
#include <cstring>
#include <iostream>
#include <memory>

#include <gtest/gtest.h>

#include "renderers/many_lights/gather.h"
#include "renderers/many_lights/geometry_aware_blur.h"
#include "renderers/many_lights/ray_gather.h"
#include "renderers/many_lights/shade.h"
#include "renderers/many_lights/virtual_light_generator.h"
#include "renderers/opengl/gpu_scene.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/many_lights/light_oracle.h"
#include "tests/renderers/scene_builder.h"

/// All passes in a row, from a scene to a picture.
namespace renderers::many_lights {
namespace {

/// A box with a glossy sphere, open to the front so that there is background.
scene::Scene room() {
  test::SceneBuilder builder;
  const int wall = builder.add_material(test::lambert({0.7F, 0.6F, 0.5F}));
  const int ball = builder.add_material(test::phong({0.2F, 0.3F, 0.4F}, glm::vec3(0.4F), 20.0F));
  builder.add_box({-1, -1, -1}, {1, 1, 1}, wall, true);
  builder.add_sphere({0.3F, -0.5F, 0.2F}, 0.45F, 24, ball);
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(6.0F)));
  builder.add_quad({-0.3F, 0.98F, -0.2F}, {0.6F, 0, 0}, {0, 0, 0.4F}, lamp);
  builder.add_point_light({-0.5F, 0.5F, -0.4F}, {1.0F, 0.8F, 0.6F});
  builder.scene.objects.erase(builder.scene.objects.begin() + 4);  // the wall at low z
  builder.look({0, 0, -4.2F}, {0, 0, 0}, 36.0F);
  return builder.scene;
}

constexpr int kWidth_px = 101;
constexpr int kHeight_px = 75;

/// One context's way from the scene to radiance; the parts stay for a look at them.
struct Rendering {
  explicit Rendering(std::shared_ptr<opengl::Context> context, int interleave)
      : settings{.interleave = interleave,
                 .geometry_clamp = 20.0F,
                 .with_glossy = true,
                 .camera_position = scene.camera.position},
        gpu(context),
        generator(context, {.light_count = 512, .emitters = {.area_light_points = 4}}),
        surfaces(context, kWidth_px, kHeight_px),
        gather(context) {
    StageTimer timer;
    gpu.load(scene, timer);
    generator.load(scene);
    generator.generate(gpu, 0, timer);
    surfaces.render(gpu, opengl::camera_view(scene.camera, kWidth_px, kHeight_px));
    gather.begin(surfaces, settings);
    gather.add(surfaces, gpu,
               {.lights = &generator.lights(), .count = 512, .first = 0, .batch = 512}, settings);
    Shade shade(context);
    shade.begin(kWidth_px, kHeight_px);
    shade.add(surfaces, gather.targets(), true, 1.0F);
    radiance = shade.radiance().read();
  }

  scene::Scene scene = room();
  GatherSettings settings;
  opengl::GpuScene gpu;
  VirtualLightGenerator generator;
  opengl::GeometryBuffer surfaces;
  Gather gather;
  std::vector<float> radiance;
};

double relative_rms(const std::vector<float>& a, const std::vector<float>& b) {
  double squares = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    squares += difference * difference;
    total += static_cast<double>(a[i]) * static_cast<double>(a[i]);
  }
  return std::sqrt(squares / total);
}

class ManyLightsPicture : public test::GlTest {};

TEST_F(ManyLightsPicture, GatherOfADrawnSceneEqualsTheOracle) {
  const Rendering rendering(context(), 4);
  const SurfaceImage surfaces = read_surfaces(rendering.surfaces);
  const auto lights = rendering.generator.lights().read<VirtualLight>(512);
  const auto expected =
      test::oracle_gather(surfaces, lights, rendering.scene.materials, rendering.settings);
  const auto irradiance = test::read_rgb(rendering.gather.targets().irradiance);
  const auto glossy = test::read_rgb(rendering.gather.targets().glossy);
  double largest = 0.0;
  double largest_glossy = 0.0;
  int background = 0;
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    largest = std::max(largest, expected.irradiance[i].x);
    largest_glossy = std::max(largest_glossy, expected.glossy[i].x);
    background += surfaces.position[i].w > 0.0F ? 0 : 1;
  }
  EXPECT_GT(largest_glossy, 0.0);
  EXPECT_GT(background, 0);
  for (std::size_t i = 0; i < irradiance.size(); ++i) {
    EXPECT_NEAR(irradiance[i].x, expected.irradiance[i].x, 2e-5 * largest);
    EXPECT_NEAR(glossy[i].x, expected.glossy[i].x, 1e-4 * largest_glossy);
  }
}

TEST_F(ManyLightsPicture, GatherEqualsTheOneByRaysWithoutRays) {
  const Rendering rendering(context(), 4);
  const SurfaceImage surfaces = read_surfaces(rendering.surfaces);
  const auto lights = rendering.generator.lights().read<VirtualLight>(512);
  const GatheredLight by_rays = gather_by_rays(
      {.scene = rendering.scene, .surfaces = surfaces, .lights = lights}, rendering.settings);
  const auto rgb_floats = [](const auto& pixels) {
    std::vector<float> values;
    for (const auto& pixel : pixels) {
      for (glm::length_t c = 0; c < 3; ++c) values.push_back(static_cast<float>(pixel[c]));
    }
    return values;
  };
  const GatherTargets& targets = rendering.gather.targets();
  EXPECT_LT(
      relative_rms(rgb_floats(by_rays.irradiance), rgb_floats(test::read_rgb(targets.irradiance))),
      1e-5);
  EXPECT_LT(relative_rms(rgb_floats(by_rays.glossy), rgb_floats(test::read_rgb(targets.glossy))),
            1e-4);
}

TEST_F(ManyLightsPicture, TwoRunsGiveTheSameBytes) {
  const Rendering first(context(), 8);
  const Rendering second(context(), 8);
  ASSERT_EQ(first.radiance.size(), second.radiance.size());
  EXPECT_EQ(std::memcmp(first.radiance.data(), second.radiance.data(),
                        first.radiance.size() * sizeof(float)),
            0);
}

TEST_F(ManyLightsPicture, PlatformsAgree) {
  const Rendering egl(context(), 8);
  const auto other = opengl::Context::create("osmesa");
  const Rendering osmesa(other, 8);
  const double difference = relative_rms(egl.radiance, osmesa.radiance);
  std::cout << "EGL against OSMesa: relative RMS " << difference << "\n";
  EXPECT_LT(difference, 1e-3);
}

TEST_F(ManyLightsPicture, BlurredInterleavedIsNearTheFullGather) {
  const Rendering full(context(), 1);
  Rendering interleaved(context(), 8);
  const auto blurred_against_full = [&](bool is_blurred) {
    if (is_blurred) {
      GeometryAwareBlur(context()).apply(
          interleaved.surfaces, {.kind = BlurKind::centred, .interleave = 8, .alpha_m = 0.35F},
          interleaved.gather.targets().irradiance);
    }
    return relative_rms(full.gather.targets().irradiance.read(),
                        interleaved.gather.targets().irradiance.read());
  };
  const double noisy = blurred_against_full(false);
  const double smooth = blurred_against_full(true);
  std::cout << "interleaved against full: relative RMS " << noisy << ", blurred " << smooth << "\n";
  EXPECT_GT(noisy, 0.1);
  EXPECT_LT(smooth, 0.25 * noisy);
}

}  // namespace
}  // namespace renderers::many_lights
