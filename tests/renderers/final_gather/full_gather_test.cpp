#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"
#include "tests/renderers/scene_builder.h"

/// The renderer `final-gather` through its contract.
namespace renderers::test {
namespace {

using Settings = std::vector<std::string>;

Frame rendered(const scene::Scene& scene, const char* renderer, const Settings& settings,
               int threads = 0) {
  return render(scene, {.renderer = renderer,
                        .settings = settings,
                        .width_px = 16,
                        .height_px = 16,
                        .threads = threads});
}

/// Root of the mean of squared differences over that of the truth's squares, its noise taken off.
double relative_error(const perception::Image& image, const Frame& truth) {
  const perception::Image& variance = aov(truth, "variance");
  double difference = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const auto expected = static_cast<double>(truth.radiance.pixels[i]);
    const auto noise = static_cast<double>(variance.pixels[i]);
    difference += std::pow(static_cast<double>(image.pixels[i]) - expected, 2) - noise;
    size += expected * expected - noise;
  }
  return std::sqrt(std::max(0.0, difference) / size);
}

TEST(FullGather, IsCloserToThePathTracerThanTheSolutionItself) {
  SceneBuilder builder = closed_room();
  builder.add_point_light({-0.5F, 0.3F, -0.2F}, glm::vec3(0.4F));
  const Frame truth =
      render(builder.scene,
             {.settings = {"transport=diffuse"}, .width_px = 16, .height_px = 16, .samples = 4096});
  const Settings links{"link_budget=1000", "camera_rays=8"};
  Settings shown = links;
  shown.push_back("direct=solution");
  const double gathered =
      relative_error(rendered(builder.scene, "final-gather", links).radiance, truth);
  const double direct = relative_error(rendered(builder.scene, "radiosity", shown).radiance, truth);
  EXPECT_LT(gathered, 0.6 * direct) << direct;
  EXPECT_LT(gathered, 0.045);
}

/// A room of sixteen small lamps among dark blocks under the ceiling: few links, which end at
/// clusters of both.
SceneBuilder lamps_among_blocks() {
  SceneBuilder builder;
  const int gray = builder.add_material(lambert(glm::vec3(0.6F)));
  const int dark = builder.add_material(lambert(glm::vec3(0.1F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(40.0F)));
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F), gray, true);
  for (int i = 0; i < 16; ++i) {
    const glm::vec3 place(-0.75F + 0.5F * static_cast<float>(i % 4), 0.8F,
                          -0.75F + 0.5F * static_cast<float>(i / 4));
    builder.add_quad(place, {0.05F, 0, 0}, {0, 0, 0.05F}, lamp);
    builder.add_box(place + glm::vec3(0.15F, -0.1F, 0.0F), place + glm::vec3(0.3F, 0.1F, 0.3F),
                    dark, false);
  }
  builder.look({0.0F, -0.2F, -0.9F}, {0, -0.6F, 1}, 80.0F);
  return builder;
}

/// Few samples on a cluster find its lamps if they are drawn by power.
TEST(FullGather, KeepsTheLightOfClusters) {
  const SceneBuilder builder = lamps_among_blocks();
  const Frame truth =
      render(builder.scene,
             {.settings = {"transport=diffuse"}, .width_px = 16, .height_px = 16, .samples = 1024});
  const auto error_of = [&](const char* points) {
    const Frame frame = rendered(builder.scene, "final-gather",
                                 {"link_budget=150", "gather_samples=64", "camera_rays=4",
                                  std::string("cluster_points=") + points});
    return relative_error(frame.radiance, truth);
  };
  EXPECT_LT(error_of("power"), 0.2);
  EXPECT_GT(error_of("area"), 0.4);
}

/// Walls of 1 W/m2 and albedo 0.5 have a radiosity of 2 W/m2 wherever one looks.
TEST(FullGather, AFurnaceIsConstant) {
  SceneBuilder builder;
  const glm::vec3 emission(1.0F / std::numbers::pi_v<float>);
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F),
                  builder.add_material(lambert(glm::vec3(0.5F), emission)), true);
  builder.look({0.1F, 0.2F, -0.5F}, {0, 0, 1}, 70.0F);
  const Frame frame = rendered(builder.scene, "final-gather", {"link_budget=3000"});
  for (const float value : frame.radiance.pixels) {
    EXPECT_NEAR(value, 2.0F / std::numbers::pi_v<float>, 0.02F);
  }
}

TEST(FullGather, SameBytesForEveryNumberOfThreads) {
  const SceneBuilder builder = closed_room();
  const Settings settings{"link_budget=500", "gather_samples=32"};
  const Frame one = rendered(builder.scene, "final-gather", settings, 1);
  const Frame two = rendered(builder.scene, "final-gather", settings, 2);
  EXPECT_EQ(one.radiance.pixels, two.radiance.pixels);
}

TEST(FullGather, SendsMoreRaysThroughBordersOfObjects) {
  const SceneBuilder builder = closed_room();
  const Frame frame = rendered(builder.scene, "final-gather",
                               {"link_budget=200", "gather_samples=8", "border_rays=6"});
  const perception::Image& counts = aov(frame, "camera_rays");
  EXPECT_GT(std::ranges::count(counts.pixels, 6.0F), 10);
  EXPECT_GT(std::ranges::count(counts.pixels, 1.0F), 50);
  EXPECT_NEAR(counter(frame, "camera_rays_per_pixel") * 256.0,
              static_cast<double>(std::ranges::count(counts.pixels, 6.0F)) * 6.0 +
                  static_cast<double>(std::ranges::count(counts.pixels, 1.0F)),
              1e-6);
}

}  // namespace
}  // namespace renderers::test
