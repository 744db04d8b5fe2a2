#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"
#include "tests/renderers/scene_builder.h"

/// The renderer `light-propagation` through its contract, against the path tracer.
namespace renderers::test {
namespace {

using Settings = std::vector<std::string>;
constexpr int kSide_px = 24;

/// A room with a red wall on the picture's left and a green one on its right; with a lamp or not.
SceneBuilder room(bool has_lamp = true) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.7F)));
  const int red = builder.add_material(lambert({0.7F, 0.1F, 0.1F}));
  const int green = builder.add_material(lambert({0.1F, 0.7F, 0.1F}));
  builder.add_quad({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);
  builder.add_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);
  builder.add_quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white);
  builder.add_quad({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, green);
  builder.add_quad({1, -1, -1}, {0, 0, 2}, {0, 2, 0}, red);
  if (has_lamp) {
    const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(8.0F)));
    builder.add_quad({-0.3F, 0.95F, -0.3F}, {0.6F, 0, 0}, {0, 0, 0.6F}, lamp);
  }
  builder.look({0, 0, -3.2F}, {0, 0, 0}, 40.0F);
  return builder;
}

Frame propagated(const scene::Scene& scene, Settings settings = {}) {
  const bool has_cells =
      std::ranges::any_of(settings, [](const std::string& s) { return s.starts_with("cells="); });
  if (!has_cells) settings.insert(settings.end(), {"cells=12", "steps=24"});
  return render(scene, {.renderer = "light-propagation",
                        .settings = std::move(settings),
                        .width_px = kSide_px,
                        .height_px = kSide_px,
                        .samples = 0});
}

/// Sum of a channel over columns [begin, end).
double sum_of(const perception::Image& image, int channel, int begin = 0, int end = kSide_px) {
  double sum = 0.0;
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = begin; x < end; ++x) sum += static_cast<double>(image.at(x, y, channel));
  }
  return sum;
}

/// The volume diffuses and blocks too much: the mean is right to a factor, colours in order.
TEST(LightPropagation, BleedsTheColoursOfThePathTracersBounce) {
  const SceneBuilder builder = room();
  const Frame frame = propagated(builder.scene, {"part=indirect"});
  const Frame truth =
      render(builder.scene, {.settings = {"transport=one_bounce", "part=indirect", "pixel=centre"},
                             .width_px = kSide_px,
                             .height_px = kSide_px,
                             .samples = 64});
  for (int c = 0; c < 3; ++c) {
    const double ratio = sum_of(frame.radiance, c) / sum_of(truth.radiance, c);
    EXPECT_GT(ratio, 0.4) << c;
    EXPECT_LT(ratio, 1.6) << c;
  }
  // Redness across the white back wall.
  for (const Frame* picture : {&frame, &truth}) {
    const double left = sum_of(picture->radiance, 0, 6, 9) / sum_of(picture->radiance, 1, 6, 9);
    const double right =
        sum_of(picture->radiance, 0, 15, 18) / sum_of(picture->radiance, 1, 15, 18);
    EXPECT_GT(left, 1.1 * right);
  }
  // Control: without blockers light goes on through the walls and comes back.
  const Frame open = propagated(builder.scene, {"part=indirect", "geometry_volume=false"});
  EXPECT_GT(sum_of(open.radiance, 1), 1.3 * sum_of(frame.radiance, 1));
}

TEST(LightPropagation, NoIndirectLightWithoutDirectLight) {
  const Frame frame = propagated(room(false).scene);
  for (const float value : frame.radiance.pixels) EXPECT_EQ(value, 0.0F);
  EXPECT_GT(counter(frame, "surface_samples"), 100.0);
}

TEST(LightPropagation, PartsAddUp) {
  SceneBuilder builder = room();
  builder.add_point_light({0.2F, 0.1F, -0.2F}, glm::vec3(0.5F));
  const Frame all = propagated(builder.scene);
  const Frame indirect = propagated(builder.scene, {"part=indirect"});
  EXPECT_EQ(indirect.radiance.pixels, aov(all, "indirect").pixels);
  for (std::size_t i = 0; i < all.radiance.pixels.size(); ++i) {
    EXPECT_NEAR(all.radiance.pixels[i], aov(all, "direct").pixels[i] + indirect.radiance.pixels[i],
                1e-6F);
  }
  // The point light feeds the volume, too.
  EXPECT_GT(sum_of(indirect.radiance, 2),
            1.05 * sum_of(propagated(room().scene, {"part=indirect"}).radiance, 2));
}

TEST(LightPropagation, TwiceTheSamplesChangeLittle) {
  const scene::Scene scene = room().scene;
  const Frame some = propagated(scene, {"part=indirect"});
  const Frame twice = propagated(scene, {"part=indirect", "samples_per_face=8"});
  EXPECT_GT(counter(twice, "surface_samples"), 1.6 * counter(some, "surface_samples"));
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(sum_of(twice.radiance, c), sum_of(some.radiance, c),
                0.02 * sum_of(some.radiance, c));
  }
}

/// Two rooms and a wall between them as thick as a cell; the lamp is in one, the camera in one.
Frame look_into(bool has_lamp_in_view, const Settings& settings) {
  constexpr float kWall_m = 4.0F / 30.0F;  // 32 cells, their margin included
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.7F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(8.0F)));
  builder.add_box({-2, -1, -1}, {2, 1, 1}, white, true);
  builder.add_box({-0.5F * kWall_m, -1, -1}, {0.5F * kWall_m, 1, 1}, white, false);
  builder.add_quad({-1.3F, 0.95F, -0.3F}, {0.6F, 0, 0}, {0, 0, 0.6F}, lamp);
  const float x = has_lamp_in_view ? -1.0F : 1.0F;
  builder.look({x, 0, -0.95F}, {x, -0.2F, 1}, 70.0F);
  return propagated(builder.scene, settings);
}

/// What a wall of one cell lets through, wherever cells lie: its two sides block light that meets
/// their fronts, in two bands of spherical harmonics. Nothing should be seen in the room without a
/// lamp.
TEST(LightPropagation, AWallOfOneCellLeaksAStatedShare) {
  for (const char* shift : {"0", "0.3", "0.6"}) {
    const Settings settings{"cells=32", "steps=64", "part=indirect",
                            std::string("grid_shift=") + shift};
    const double lit = sum_of(look_into(true, settings).radiance, 1);
    const double leak = sum_of(look_into(false, settings).radiance, 1) / lit;
    RecordProperty(std::string("leak_") + shift, std::to_string(leak));
    EXPECT_LT(leak, 0.1) << shift;
    // Control: without blockers the wall is not there.
    Settings open = settings;
    open.emplace_back("geometry_volume=false");
    EXPECT_GT(sum_of(look_into(false, open).radiance, 1) / lit, 2.0 * leak) << shift;
  }
}

/// Where the cells lie is no part of the scene, and yet the picture hangs on it: its mean by a
/// quarter here, as walls lie now on faces of cells, now within them.
TEST(LightPropagation, WhereCellsLieChangesTheMeanByLessThanHalf) {
  const scene::Scene scene = room().scene;
  const double unmoved = sum_of(propagated(scene, {"part=indirect"}).radiance, 1);
  for (const char* shift : {"0.25", "0.5", "0.75"}) {
    const Frame moved = propagated(scene, {"part=indirect", std::string("grid_shift=") + shift});
    EXPECT_NEAR(sum_of(moved.radiance, 1) / unmoved, 1.0, 0.5) << shift;
    EXPECT_NE(sum_of(moved.radiance, 1), unmoved) << shift;
  }
}

TEST(LightPropagation, SlicesAreOfTheVolume) {
  const Frame frame = propagated(room().scene, {"part=indirect"});
  EXPECT_EQ(aov(frame, "volume_slices").width_px, kSide_px);
  EXPECT_GT(sum_of(aov(frame, "volume_slices"), 1), 0.1);
}

TEST(LightPropagation, SameBytesForEveryNumberOfThreads) {
  const SceneBuilder builder = room();
  RenderRequest request{.renderer = "light-propagation",
                        .settings = {"cells=12", "steps=8"},
                        .samples = 0,
                        .threads = 1};
  const Frame one = render(builder.scene, request);
  request.threads = 3;
  EXPECT_EQ(render(builder.scene, request).radiance.pixels, one.radiance.pixels);
}

TEST(LightPropagation, AnEmptySceneIsItsEnvironment) {
  SceneBuilder builder;
  builder.set_environment(glm::vec3(0.25F));
  for (const float value : propagated(builder.scene).radiance.pixels) {
    EXPECT_NEAR(value, 0.25F, 1e-6F);
  }
}

TEST(LightPropagation, SaysWhatItCannotDo) {
  EXPECT_EQ(tests::input_error_of([] { propagated(room().scene, {"light_points=20"}); }),
            "light-propagation: light_points is 20; accepted: powers of two");
}

}  // namespace
}  // namespace renderers::test
