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
