#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"
#include "tests/renderers/area_shadows/polygon_irradiance.h"

/// The renderer `per-pixel-shadows` against closed forms and the path tracer.
namespace renderers::test {
namespace {

constexpr int kSide_px = 24;

Frame shadows(const scene::Scene& scene, std::vector<std::string> settings = {},
              int side_px = kSide_px) {
  return render(scene, {.renderer = "per-pixel-shadows",
                        .settings = std::move(settings),
                        .width_px = side_px,
                        .height_px = side_px,
                        .samples = 0});
}

/// Pixels on the floor: the lamp's back hides some.
bool shows_floor(const Frame& frame, int x, int y) { return aov(frame, "albedo").at(x, y) == 1.0F; }

TEST(PerPixelShadows, AnUnoccludedLampGivesThePolygonsIrradiance) {
  const LampOverFloor lamp;
  const SceneBuilder builder = lamp.scene();
  const Frame frame = shadows(builder.scene);
  int pixels = 0;
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 0; x < kSide_px; ++x) {
      if (!shows_floor(frame, x, y)) continue;
      const double expected = lamp.irradiance(lamp.point(x, y, kSide_px));
      EXPECT_NEAR(irradiance_at(frame.radiance, x, y), expected, 0.005 * expected);
      ++pixels;
    }
  }
  EXPECT_GT(pixels, kSide_px * kSide_px * 9 / 10);
  EXPECT_EQ(counter(frame, "fragments"), kSide_px * kSide_px);
  // All of the floor; those that graze the lamp from its own back may end there.
  EXPECT_GE(counter(frame, "unhidden_rays"), 64.0 * pixels);
  EXPECT_LE(counter(frame, "unhidden_rays"), counter(frame, "shadow_rays"));
}

/// Where the wrong side of the light would shine, nothing does.
TEST(PerPixelShadows, BackSidesOfLampsAreDark) {
  LampOverFloor lamp;
  SceneBuilder builder = lamp.scene();
  const int white = builder.add_material(lambert(glm::vec3(1.0F)));
  builder.add_quad({-2, 3, -2}, {0, 0, 4}, {4, 0, 0}, white);  // above the lamp, seen from above
  const Frame frame = shadows(builder.scene);
  for (const float value : frame.radiance.pixels) EXPECT_EQ(value, 0.0F);
  EXPECT_EQ(counter(frame, "shadow_rays"), 0.0);
}

/// A half plane between lamp and floor, its edge along z at x = 0: the floor sees the part of the
/// lamp beyond the edge, which is a rectangle again.
TEST(PerPixelShadows, APenumbraHasTheProfileOfTheLampsVisiblePart) {
  const LampOverFloor lamp;
  constexpr double kSheet_m = 0.75;
  SceneBuilder builder = lamp.scene();
  const int black = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({0, static_cast<float>(kSheet_m), -9}, {9, 0, 0}, {0, 0, 18}, black);
  const Frame frame = shadows(builder.scene, {"light_points=1024"}, 48);
  int partly = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) {
      if (!shows_floor(frame, x, y)) continue;
      const glm::dvec3 at = lamp.point(x, y, 48);
      // The edge as the floor's point projects it to the lamp's height.
      const double edge = at.x * (1.0 - lamp.height_m / kSheet_m);
      const double low = -lamp.half_lamp_m;
      const double high = std::clamp(edge, low, lamp.half_lamp_m);
      const double h = lamp.height_m;
      const double z = lamp.half_lamp_m;
      const double expected =
          high > low ? polygon_irradiance(at, {0, 1, 0},
                                          {{low, h, -z}, {high, h, -z}, {high, h, z}, {low, h, z}})
                     : 0.0;
      const double whole = lamp.irradiance(at);
      EXPECT_NEAR(irradiance_at(frame.radiance, x, y), expected, 0.012 * whole) << x << ", " << y;
      if (expected > 0.1 * whole && expected < 0.9 * whole) ++partly;
    }
  }
  EXPECT_GT(partly, 60);
  EXPECT_LT(counter(frame, "unhidden_rays"), counter(frame, "shadow_rays"));
}

/// All that lights can be: two lamps, one textured, environment, a point light, gloss and smooth
/// normals.
SceneBuilder every_light() {
  SceneBuilder builder;
  scene::Texture checks;
  checks.image = perception::make_rgb_image(2, 2, perception::Encoding::scene_linear);
  checks.image.pixels = {1.0F, 0.8F, 0.6F, 0.2F, 0.3F, 0.4F, 0.2F, 0.3F, 0.4F, 1.0F, 0.8F, 0.6F};
  builder.scene.textures.push_back(checks);
  scene::Material screen = lambert(glm::vec3(0.1F), glm::vec3(6.0F));
  screen.emission_texture = 0;
  const int cloth = builder.add_material(lambert({0.7F, 0.6F, 0.5F}));
  const int gloss = builder.add_material(phong(glm::vec3(0.3F), glm::vec3(0.4F), 8.0F));
  const int textured = builder.add_material(screen);
  const int lamp = builder.add_material(lambert(glm::vec3(0.3F), {3.0F, 4.0F, 5.0F}));
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, cloth);
  builder.add_quad({-2, 0, 2}, {0, 3, 0}, {4, 0, 0}, gloss);
  builder.add_quad({-1.9F, 0.3F, -1}, {0, 1.2F, 0}, {0, 0, 1.5F}, textured);
  builder.add_quad({0.4F, 2.4F, 0.2F}, {0.8F, 0, 0}, {0, 0, 0.6F}, lamp);
  builder.add_sphere({0.2F, 0.5F, 0.6F}, 0.5F, 24, cloth);
  builder.add_box({-1.0F, 0.0F, 0.2F}, {-0.5F, 0.9F, 0.7F}, cloth, false);
  builder.add_point_light({1.2F, 1.5F, -0.5F}, glm::vec3(2.0F));
  builder.set_environment({0.2F, 0.25F, 0.3F});
  builder.look({0.3F, 1.3F, -4.0F}, {0, 0.8F, 0.5F}, 45.0F);
  return builder;
}

TEST(PerPixelShadows, ManyPointsGiveThePathTracersPicture) {
  const SceneBuilder builder = every_light();
  const Frame truth = render(builder.scene, {.settings = {"transport=direct", "pixel=centre"},
                                             .width_px = kSide_px,
                                             .height_px = kSide_px,
                                             .samples = 512});
  const Frame many = shadows(builder.scene, {"light_points=1024"}, kSide_px);
  const Frame paper = shadows(builder.scene);
  const double few_error = relative_rmse(paper.radiance, truth.radiance);
  const double many_error = relative_rmse(many.radiance, truth.radiance);
  EXPECT_LT(many_error, 0.01);
  EXPECT_LT(few_error, 0.06);
  EXPECT_LT(many_error, 0.5 * few_error);
  EXPECT_EQ(counter(many, "area_lights"), 3.0);
}

TEST(PerPixelShadows, AMirroredLampShinesTheSame) {
  SceneBuilder builder = LampOverFloor{}.scene();
  const Frame straight = shadows(builder.scene);
  // The lamp is symmetric in x: mirrored, its triangles are clockwise, and its front stays below.
  builder.scene.objects[1].to_world[0][0] = -1.0F;
  const Frame mirrored = shadows(builder.scene);
  EXPECT_LT(relative_rmse(mirrored.radiance, straight.radiance), 0.005);
}

TEST(PerPixelShadows, SameBytesForEveryNumberOfThreads) {
  const SceneBuilder builder = every_light();
  RenderRequest request{.renderer = "per-pixel-shadows", .samples = 0, .threads = 1};
  const Frame one = render(builder.scene, request);
  request.threads = 3;
  EXPECT_EQ(render(builder.scene, request).radiance.pixels, one.radiance.pixels);
  request.seed = 2;
  EXPECT_NE(render(builder.scene, request).radiance.pixels, one.radiance.pixels);
}

TEST(PerPixelShadows, ScenesWithoutLightOrSurfaces) {
  SceneBuilder empty;
  empty.set_environment(glm::vec3(0.25F));
  for (const float value : shadows(empty.scene).radiance.pixels) EXPECT_NEAR(value, 0.25F, 1e-6F);
  SceneBuilder dark;
  dark.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, dark.add_material(lambert(glm::vec3(1.0F))));
  dark.look({0, 3, 0}, {0, 0, 0}, 30.0F);
  for (const float value : shadows(dark.scene).radiance.pixels) EXPECT_EQ(value, 0.0F);
}

TEST(PerPixelShadows, SaysWhatItCannotDo) {
  const SceneBuilder builder = LampOverFloor{}.scene();
  EXPECT_EQ(tests::input_error_of([&] { shadows(builder.scene, {"light_points=100"}); }),
            "per-pixel-shadows: light_points is 100; accepted: powers of two");
}

}  // namespace
}  // namespace renderers::test
