#include <gtest/gtest.h>

#include "tests/renderers/scene_builder.h"

/// Closed box, every wall emits e and reflects rho: radiance e / (1 - rho) everywhere.
namespace renderers::test {
namespace {

SceneBuilder furnace(float albedo, float scale = 1.0F) {
  SceneBuilder builder;
  const int wall = builder.add_material(lambert(glm::vec3(albedo), glm::vec3(0.5F)));
  builder.add_box(glm::vec3(-scale), glm::vec3(scale), wall, true);
  builder.look({-0.5F * scale, 0.1F * scale, 0.2F * scale}, {scale, 0, 0}, 60.0F);
  return builder;
}

TEST(Furnace, RadianceIsTheGeometricSeriesOfTheAlbedo) {
  for (const char* sampling : {"mis", "nee", "bsdf"}) {
    for (const double albedo : {0.2, 0.5, 0.8, 0.95}) {
      const SceneBuilder builder = furnace(static_cast<float>(albedo));
      const Frame frame = render(
          builder.scene, {.settings = {std::string("sampling=") + sampling}, .samples = 128});
      const Mean mean = mean_of(frame);
      const double expected = 0.5 / (1.0 - static_cast<double>(static_cast<float>(albedo)));
      EXPECT_TRUE(agree(mean, expected, 0.02))
          << sampling << " albedo " << albedo << ": " << to_string(mean) << " not " << expected;
    }
  }
}

TEST(Furnace, HasPowerAgainstMissingFactors) {
  const Mean mean = mean_of(render(furnace(0.5F).scene, {.samples = 256}));
  EXPECT_FALSE(agree(mean, 3.14159 * 1.0, 0.02));
  EXPECT_FALSE(agree(mean, 1.0 / 3.14159, 0.02));
  EXPECT_FALSE(agree(mean, 0.5, 0.02)) << "a swapped normal would leave the emission alone";
  EXPECT_FALSE(agree(mean, 1.02, 0.02)) << "two per cent of energy would go unnoticed";
}

TEST(Furnace, HoldsAtEveryScaleOfTheScene) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    const Mean mean = mean_of(render(furnace(0.8F, scale).scene, {.samples = 256}));
    EXPECT_TRUE(agree(mean, 2.5, 0.02)) << "scale " << scale << ": " << to_string(mean);
  }
}

TEST(Furnace, DepthLimitsCutTheSeries) {
  const SceneBuilder builder = furnace(0.5F);
  for (const auto& [setting, expected] :
       std::vector<std::pair<std::string, double>>{{"max_depth=1", 0.75},
                                                   {"max_depth=2", 0.875},
                                                   {"max_depth=3", 0.9375},
                                                   {"transport=direct", 0.75},
                                                   {"transport=one_bounce", 0.875},
                                                   {"transport=diffuse", 1.0}}) {
    const Mean mean = mean_of(render(builder.scene, {.settings = {setting}, .samples = 256}));
    EXPECT_TRUE(agree(mean, expected, 0.02)) << setting << ": " << to_string(mean);
  }
}

TEST(Furnace, RouletteDepthChangesNoise_NotTheMean) {
  const SceneBuilder builder = furnace(0.6F);
  for (const char* depth : {"roulette_depth=1", "roulette_depth=3", "roulette_depth=40"}) {
    const Mean mean = mean_of(render(builder.scene, {.settings = {depth}, .samples = 256}));
    EXPECT_TRUE(agree(mean, 1.25, 0.02)) << depth << ": " << to_string(mean);
  }
}

TEST(Furnace, EmissionSeenFromBehindIsBlack) {
  SceneBuilder builder;
  const int wall = builder.add_material(lambert(glm::vec3(0.5F), glm::vec3(1.0F)));
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F), wall, true);
  builder.look({4, 0, 0}, {0, 0, 0}, 20.0F);
  const Frame frame = render(builder.scene, {});
  // Triangles in the plane of the one that is lit shine along it: rounding, no more.
  for (const float value : frame.radiance.pixels) EXPECT_LT(value, 1e-9F);
}

}  // namespace
}  // namespace renderers::test
