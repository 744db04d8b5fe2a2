#include "renderers/area_shadows/pcss_shadows.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "renderers/contract/devices.h"
#include "renderers/soft_shadows/percentage_closer.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/area_shadows/polygon_irradiance.h"
#include "tests/renderers/area_shadows/shadow_bench.h"

/// The renderer `pcss`: its map and its estimate by closed forms, its picture against rays.
namespace renderers::test {
namespace {

using soft_shadows::FlatLight;
using soft_shadows::LightDepthMap;
using soft_shadows::PcssSettings;

/// A lamp of 0.5 m at y = 2.5 that looks down, with or without a sheet at y = 1.25.
struct LampAndSheet {
  explicit LampAndSheet(bool has_sheet = true) {
    ShadowBench bench;
    bench.half_lamp_m = 0.25;
    bench.has_sheet = has_sheet;
    scene = bench.scene();
    rays = std::make_unique<ray_tracing::RayScene>(scene, timer);
    sets = ray_tracing::make_light_points(*rays, 256, 1);
    light = soft_shadows::flat_light(sets.front());
  }
  scene::Scene scene;
  StageTimer timer;
  std::unique_ptr<ray_tracing::RayScene> rays;
  std::vector<ray_tracing::LightPointSet> sets;
  FlatLight light;
};

TEST(FlatLight, IsTheSquareOfALamp) {
  const FlatLight light = LampAndSheet().light;
  EXPECT_NEAR(light.width_m, 0.5F, 0.005F);
  EXPECT_NEAR(light.centre.x, 0.0F, 0.002F);
  EXPECT_NEAR(light.centre.y, 2.5F, 1e-5F);
  EXPECT_NEAR(light.normal.y, -1.0F, 1e-6F);
}

/// Heights are distances from the light's plane, whatever the direction.
TEST(LightDepthMap, ShowsPlanesAtTheirHeight) {
  const LampAndSheet bench;
  const LightDepthMap map(*bench.rays, bench.light, 256);
  // The sheet is 0.25 m wide and the floor 6 m, both below the middle of the lamp.
  for (const float along : {-0.5F, 0.0F, 0.7F}) {
    const glm::vec3 on_sheet = bench.light.to_light({0.05F, 1.25F, along});
    EXPECT_NEAR(map.surface_towards(on_sheet).z, 1.25F, 1e-4F);
    const glm::vec3 on_floor = bench.light.to_light({1.5F, 0.0F, along});
    EXPECT_NEAR(map.surface_towards(on_floor).z, 2.5F, 1e-4F);
  }
  EXPECT_TRUE(std::isinf(map.surface_towards(bench.light.to_light({9.0F, 1.25F, 0.0F})).z))
      << "beside the floor";
  EXPECT_NEAR(static_cast<double>(map.ray_count()), 256.0 * 256.0 * 0.7854, 300.0);
}

/// Half of the lamp is seen from below the edge of a half plane; the penumbra is as wide as the
/// lamp where the edge is half way up, and grows with the lamp.
TEST(Pcss, AHalfPlanesPenumbraIsInClosedForm) {
  for (const double half_lamp_m : {0.05, 0.1, 0.2}) {
    ShadowBench bench;
    bench.half_lamp_m = half_lamp_m;
    bench.width_m = 4.0;
    bench.offset_m = 2.0;  // the shadow begins in the middle of the picture
    const Frame frame =
        picture_of(bench.scene(), "pcss", {"filter_side=16", "search_side=8", "map_px=512"});
    bench.has_sheet = false;
    const Frame open = picture_of(bench.scene(), "pcss", {"map_px=16"});
    double lit = 0.0;
    for (int x = 0; x < 64; ++x) {
      const double share = aov(frame, "irradiance").at(x, 32) / aov(open, "irradiance").at(x, 32);
      const double from_edge_m = (x + 0.5 - 32.0) / 32.0;
      lit += share;
      const double side = aov(frame, "irradiance").at(0, 32) > 0.0F ? -1.0 : 1.0;
      const double expected = std::clamp(0.5 + side * from_edge_m / (2.0 * half_lamp_m), 0.0, 1.0);
      EXPECT_NEAR(share, expected, 0.08) << half_lamp_m << " " << x;
    }
    EXPECT_NEAR(lit, 32.0, 1.0) << half_lamp_m;
  }
}

TEST(Pcss, WithoutOccludersIsTheUnoccludedLight) {
  ShadowBench bench;
  bench.has_sheet = false;
  const Frame frame = picture_of(bench.scene(), "pcss", {"map_px=256"});
  const Frame reference = picture_of(bench.scene(), "per-pixel-shadows");
  EXPECT_LT(relative_rmse(frame.radiance, reference.radiance), 1e-5);
  EXPECT_EQ(counter(frame, "shadow_rays"), counter(frame, "map_rays"));
}

TEST(Pcss, ABarsShadowIsThatOfRays) {
  ShadowBench bench;
  bench.half_lamp_m = 0.1;
  bench.angle_rad = 0.3;
  const Frame reference = picture_of(bench.scene(), "per-pixel-shadows");
  const Frame frame = picture_of(bench.scene(), "pcss", {"map_px=512"});
  EXPECT_LT(relative_rmse(frame.radiance, reference.radiance), 0.05);
  const Frame hard = picture_of(bench.scene(), "pcss", {"near_share=1", "map_px=512"});
  EXPECT_GT(relative_rmse(hard.radiance, reference.radiance), 0.1)
      << "the control: without a blocker search there is no penumbra";
}

/// A wall beside the lamp is at a slant to its light: its own texels must not shade it.
TEST(Pcss, WallsDoNotShadeThemselves) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.8F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  builder.add_quad({-2, -2, 2}, {0, 4, 0}, {4, 0, 0}, white);
  builder.add_quad({-0.2F, 2.5F, 1.0F}, {0.4F, 0, 0}, {0, 0, 0.4F}, lamp);
  builder.look({0, 0, -3}, {0, 0, 2}, 40.0F);
  const Frame reference = picture_of(builder.scene, "per-pixel-shadows");
  const auto error = [&](const char* setting) {
    const Frame frame = picture_of(builder.scene, "pcss", {setting, "map_px=128"});
    return relative_rmse(frame.radiance, reference.radiance);
  };
  EXPECT_LT(error("receiver_plane=true"), 1e-5);
  EXPECT_GT(error("receiver_plane=false"), 0.05) << "the control";
}

/// Before any map is made.
TEST(Pcss, RefusesMapsThatFillTheMemory) {
  SceneBuilder builder;
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  for (int i = 0; i < 17; ++i) {
    builder.add_quad({0.2F * static_cast<float>(i), 1, 0}, {0.1F, 0, 0}, {0, 0, 0.1F}, lamp);
  }
  builder.look({0, 0, -3}, {0, 0, 2}, 40.0F);
  EXPECT_EQ(tests::input_error_of([&] { picture_of(builder.scene, "pcss", {"map_px=8192"}, 8); }),
            "pcss: maps of 17 lights with map_px 8192 take 4.2 GiB; accepted: at most 4 GiB, lower "
            "map_px");
}

TEST(Pcss, SameBytesForEveryNumberOfThreads) {
  ShadowBench bench;
  RenderRequest request{.renderer = "pcss",
                        .settings = {"map_px=128"},
                        .width_px = 40,
                        .height_px = 40,
                        .samples = 0,
                        .threads = 1};
  const Frame one = render(bench.scene(), request);
  request.threads = 3;
  EXPECT_EQ(render(bench.scene(), request).radiance.pixels, one.radiance.pixels);
}

TEST(Pcss, SaysWhatItCannotDo) {
  SceneBuilder builder;
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  builder.add_sphere({0, 1, 0}, 0.5F, 16, lamp);
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, builder.add_material(lambert(glm::vec3(1))));
  builder.look({0, 1, -4}, {0, 0, 0}, 40.0F);
  EXPECT_THROW(picture_of(builder.scene, "pcss", {"map_px=16"}), UnsupportedError)
      << "a ball is not flat";
  EXPECT_EQ(
      tests::input_error_of([] { picture_of(ShadowBench().scene(), "pcss", {"light_points=48"}); }),
      "pcss: light_points is 48; accepted: powers of two");
}

}  // namespace
}  // namespace renderers::test
