#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "metrics/metric_list.h"
#include "perception/viewing_conditions.h"
#include "tests/renderers/scene_builder.h"

/// A dark room beside a lit one, both seen at once: cells of the grid reach through the wall, and
/// vertices lie within it.
namespace renderers::test {
namespace {

/// Metres between the rooms; 0 is a wall without thickness.
class DarkRoom : public testing::TestWithParam<float> {};

constexpr int kWidthPx = 48;
constexpr int kHeightPx = 24;

/// Two rooms that are open towards the camera; floor, ceiling and back wall are common to both.
scene::Scene two_rooms(float wall_m) {
  SceneBuilder builder;
  const int gray = builder.add_material(lambert(glm::vec3(0.6F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(10.0F)));
  builder.add_quad({-4, 0, 2}, {8, 0, 0}, {0, 0, -4}, gray);
  builder.add_quad({-4, 3, -2}, {8, 0, 0}, {0, 0, 4}, gray);
  builder.add_quad({-4, 0, -2}, {8, 0, 0}, {0, 3, 0}, gray);
  builder.add_quad({-4, 0, 2}, {0, 0, -4}, {0, 3, 0}, gray);
  builder.add_quad({4, 0, -2}, {0, 0, 4}, {0, 3, 0}, gray);
  builder.add_quad({-0.5F * wall_m, 0, -2}, {0, 0, 4}, {0, 3, 0}, gray);
  if (wall_m > 0.0F) builder.add_quad({0.5F * wall_m, 0, 2}, {0, 0, -4}, {0, 3, 0}, gray);
  builder.add_quad({-2.5F, 2.9F, -0.5F}, {1, 0, 0}, {0, 0, 1}, lamp);
  builder.look({0.0F, 1.5F, 7.5F}, {0.0F, 1.5F, 0.0F}, 35.0F);
  return builder.scene;
}

Frame rendered(const scene::Scene& scene, const std::string& renderer,
               std::vector<std::string> settings) {
  return render(scene, {.renderer = renderer,
                        .settings = std::move(settings),
                        .width_px = kWidthPx,
                        .height_px = kHeightPx,
                        .samples = 16});
}

/// The greatest value of the map right of the wall, where a picture is black.
float greatest_in_the_dark(const perception::Image& map) {
  float greatest = 0.0F;
  for (int y = 0; y < map.height_px; ++y) {
    for (int x = map.width_px / 2 + 1; x < map.width_px; ++x) {
      for (int c = 0; c < map.channel_count(); ++c) greatest = std::max(greatest, map.at(x, y, c));
    }
  }
  return greatest;
}

/// What a viewer sees of an image's dark half who compares it with black.
float seen_in_the_dark(const perception::Image& image) {
  perception::Image truth = image;
  for (int y = 0; y < truth.height_px; ++y) {
    for (int x = truth.width_px / 2 + 1; x < truth.width_px; ++x) {
      for (int c = 0; c < truth.channel_count(); ++c) truth.at(x, y, c) = 0.0F;
    }
  }
  const auto judge = metrics::parse_metric_choice("visible-difference", {});
  return greatest_in_the_dark(
      *metrics::score(judge, {truth, image}, perception::ViewingConditions{}).map);
}

TEST_P(DarkRoom, PathTracingFindsItBlack) {
  const Frame frame = rendered(two_rooms(GetParam()), "path", {});
  EXPECT_EQ(greatest_in_the_dark(frame.radiance), 0.0F);
  EXPECT_GT(mean_of(frame.radiance), 0.1);
}

TEST_P(DarkRoom, GathersLeakNothingThatIsSeen) {
  const scene::Scene scene = two_rooms(GetParam());
  for (const char* renderer : {"final-gather", "grid-final-gather"}) {
    const Frame few = rendered(scene, renderer, {"link_budget=1000"});
    const Frame many = rendered(scene, renderer, {"link_budget=30000"});
    EXPECT_GT(mean_of(many.radiance), 0.1) << renderer;
    // In thresholds.
    EXPECT_LT(seen_in_the_dark(many.radiance), 1.0F) << renderer;
    // Links between surfaces that reach into both rooms bring a mean of both.
    EXPECT_GT(seen_in_the_dark(few.radiance), 1.0F) << renderer;
  }
}

INSTANTIATE_TEST_SUITE_P(Walls, DarkRoom, testing::Values(0.0F, 0.1F));

}  // namespace
}  // namespace renderers::test
