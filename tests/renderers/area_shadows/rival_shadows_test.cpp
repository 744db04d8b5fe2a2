#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"
#include "tests/renderers/area_shadows/polygon_irradiance.h"
#include "tests/renderers/area_shadows/shadow_bench.h"

/// The renderers `nichols-shadows` and `grid-shadows`.
namespace renderers::test {
namespace {

using Settings = std::vector<std::string>;

/// A box on a floor before a wall under a lamp, with background.
scene::Scene corner_scene() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert({0.8F, 0.7F, 0.6F}));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(5.0F)));
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, white);
  builder.add_quad({-2, 0, 2}, {0, 1.5F, 0}, {4, 0, 0}, white);
  builder.add_quad({-0.6F, 2.4F, 0}, {0.4F, 0, 0}, {0, 0, 0.4F}, lamp);
  builder.add_box({-0.4F, 0.0F, 0.2F}, {0.3F, 0.8F, 0.8F}, white, false);
  builder.look({0.3F, 1.2F, -3.6F}, {0, 0.7F, 0.5F}, 45.0F);
  return builder.scene;
}

TEST(NicholsShadows, PixelsAloneGiveTheReferencesBits) {
  const scene::Scene scene = corner_scene();
  const Frame reference = picture_of(scene, "per-pixel-shadows");
  const Frame frame =
      picture_of(scene, "nichols-shadows", {"depth_threshold=0", "normal_threshold=0"});
  EXPECT_EQ(frame.radiance.pixels, reference.radiance.pixels);
  EXPECT_EQ(counter(frame, "shadow_rays"), counter(reference, "shadow_rays"));
}

TEST(NicholsShadows, ComesCloseToTheReferenceWithFewerRays) {
  const scene::Scene scene = corner_scene();
  const Frame reference = picture_of(scene, "per-pixel-shadows");
  double last_rays = counter(reference, "shadow_rays");
  double last_error = 0.0;
  for (const char* threshold : {"bit_threshold=1", "bit_threshold=8", "bit_threshold=48"}) {
    const Frame frame = picture_of(scene, "nichols-shadows", {threshold});
    const double error = relative_rmse(frame.radiance, reference.radiance);
    EXPECT_LT(error, 0.08) << threshold;
    EXPECT_GE(error, last_error) << threshold;
    EXPECT_LT(counter(frame, "shadow_rays"), last_rays) << threshold;
    last_rays = counter(frame, "shadow_rays");
    last_error = error;
  }
  EXPECT_GT(last_error, 0.0);
  const Frame nearest =
      picture_of(scene, "nichols-shadows", {"upsampling=nearest", "upsampled=irradiance"});
  const Frame passes = picture_of(scene, "nichols-shadows", {"upsampled=irradiance"});
  EXPECT_LT(relative_rmse(passes.radiance, reference.radiance),
            relative_rmse(nearest.radiance, reference.radiance));
}

/// Each middle is traced once: a picture without occluders costs a few rays per coarse block.
TEST(NicholsShadows, MiddlesAreTracedOnce) {
  LampOverFloor lamp;
  SceneBuilder builder = lamp.scene();
  builder.look({0, 1, 0}, {0, 0, 0}, 60.0F);  // below the lamp: floor alone
  const Frame frame = picture_of(builder.scene, "nichols-shadows", {"coarsest_level=4"});
  EXPECT_EQ(counter(frame, "shadow_rays"), 16.0 * 64.0);
  EXPECT_EQ(counter(frame, "fragments"), 16.0);
}

TEST(GridShadows, SpacingOneGivesTheReferencesBits) {
  const scene::Scene scene = corner_scene();
  const Frame reference = picture_of(scene, "per-pixel-shadows");
  const Frame frame = picture_of(scene, "grid-shadows", {"spacing=1", "upsampled=irradiance"});
  EXPECT_EQ(frame.radiance.pixels, reference.radiance.pixels);
}

TEST(GridShadows, ErrorGrowsWithTheSpacingAndEdgesStaySharp) {
  const scene::Scene scene = corner_scene();
  const Frame reference = picture_of(scene, "per-pixel-shadows", {}, 61);
  double last_error = 0.0;
  for (const char* spacing : {"spacing=2", "spacing=4", "spacing=8"}) {
    const Frame frame = picture_of(scene, "grid-shadows", {spacing}, 61);
    const double error = relative_rmse(frame.radiance, reference.radiance);
    EXPECT_GT(error, last_error) << spacing;
    EXPECT_LT(error, 0.2) << spacing;
    last_error = error;
    EXPECT_LT(counter(frame, "fragments"), 0.5 * counter(reference, "fragments"));
  }
}

/// What lies between nodes on a plain floor is exact when only visibility is interpolated.
TEST(GridShadows, AnOpenFloorNeedsNoNodeBesides) {
  LampOverFloor lamp;
  SceneBuilder builder = lamp.scene();
  builder.look({0, 1, 0}, {0, 0, 0}, 60.0F);
  const Frame frame = picture_of(builder.scene, "grid-shadows", {"spacing=16"}, 50);
  const Frame reference = picture_of(builder.scene, "per-pixel-shadows", {}, 50);
  EXPECT_EQ(counter(frame, "filled_pixels"), 0.0);
  EXPECT_EQ(counter(frame, "grid_nodes"), 25.0);
  EXPECT_LT(relative_rmse(frame.radiance, reference.radiance), 1e-6);
  const Frame smoothed =
      picture_of(builder.scene, "grid-shadows", {"spacing=16", "upsampled=irradiance"}, 50);
  EXPECT_GT(relative_rmse(smoothed.radiance, reference.radiance), 1e-3);
}

TEST(RivalShadows, SameBytesForEveryNumberOfThreads) {
  const scene::Scene scene = corner_scene();
  for (const char* renderer : {"nichols-shadows", "grid-shadows"}) {
    RenderRequest request{
        .renderer = renderer, .width_px = 40, .height_px = 40, .samples = 0, .threads = 1};
    const Frame one = render(scene, request);
    request.threads = 3;
    EXPECT_EQ(render(scene, request).radiance.pixels, one.radiance.pixels) << renderer;
  }
}

TEST(RivalShadows, SayWhatTheyCannotDo) {
  for (const std::string renderer : {"nichols-shadows", "grid-shadows"}) {
    EXPECT_EQ(
        tests::input_error_of([&] { picture_of(corner_scene(), renderer, {"light_points=48"}); }),
        renderer + ": light_points is 48; accepted: powers of two");
  }
}

}  // namespace
}  // namespace renderers::test
