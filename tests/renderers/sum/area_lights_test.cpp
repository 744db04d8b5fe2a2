#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/renderers/scene_builder.h"

/// The renderer `area-lights`, a sum of two.
namespace renderers::test {
namespace {

scene::Scene room() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.7F)));
  const int red = builder.add_material(lambert({0.7F, 0.1F, 0.1F}));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(8.0F)));
  builder.add_box({-1, -1, -1}, {1, 1, 1}, white, true);
  builder.add_box({-0.3F, -1, 0.0F}, {0.2F, -0.3F, 0.5F}, red, false);
  builder.add_quad({-0.3F, 0.95F, -0.3F}, {0.6F, 0, 0}, {0, 0, 0.6F}, lamp);
  builder.look({0.1F, 0, -0.95F}, {0, -0.2F, 0.5F}, 75.0F);
  return builder.scene;
}

RenderRequest request_of(const std::string& renderer, std::vector<std::string> settings) {
  return {.renderer = renderer,
          .settings = std::move(settings),
          .width_px = 24,
          .height_px = 24,
          .samples = 0};
}

TEST(AreaLights, IsTheSumOfItsPartsToTheBit) {
  const scene::Scene scene = room();
  StageTimer timer;
  const Frame all = render(
      scene,
      request_of("area-lights", {"volume_cells=10", "volume_steps=12", "shadows_ring=false"}),
      &timer);
  const Frame direct = render(scene, request_of("multires-shadows", {"ring=false"}));
  const Frame indirect =
      render(scene, request_of("light-propagation", {"cells=10", "steps=12", "part=indirect"}));
  ASSERT_EQ(all.radiance.pixels.size(), direct.radiance.pixels.size());
  bool has_indirect = false;
  for (std::size_t i = 0; i < all.radiance.pixels.size(); ++i) {
    EXPECT_EQ(all.radiance.pixels[i], direct.radiance.pixels[i] + indirect.radiance.pixels[i]);
    has_indirect = has_indirect || indirect.radiance.pixels[i] > 0.0F;
  }
  EXPECT_TRUE(has_indirect);
  EXPECT_EQ(aov(all, "shadows").pixels, direct.radiance.pixels);
  EXPECT_EQ(aov(all, "volume").pixels, indirect.radiance.pixels);
  EXPECT_EQ(aov(all, "shadows_level").pixels, aov(direct, "level").pixels);
  EXPECT_EQ(counter(all, "rays"), counter(direct, "rays") + counter(indirect, "rays"));
  EXPECT_EQ(counter(all, "shadows_fragments"), counter(direct, "fragments"));
  // The parts' stages are told apart.
  EXPECT_GT(timer.wall_of("shadow/visibility"), 0.0);
  EXPECT_GT(timer.wall_of("transport/transport"), 0.0);
}

TEST(AreaLights, ParametersAndPresetsAreThoseOfItsParts) {
  const RendererInfo& info = find_renderer("area-lights", {});
  const auto has = [&](const std::string& name) {
    return std::ranges::any_of(info.parameters,
                               [&](const base::ParameterSpec& spec) { return spec.name == name; });
  };
  EXPECT_TRUE(has("shadows_rbf_form"));
  EXPECT_TRUE(has("volume_lookup"));
  EXPECT_FALSE(has("volume_part"));
  const base::Preset& paper = find_preset(info, "paper", {});
  const base::Parameters resolved =
      base::resolve_parameters(info.parameters, &paper, {}, "area-lights");
  EXPECT_EQ(resolved.text("shadows_rbf_form"), "raw");
  EXPECT_EQ(resolved.text("volume_lookup"), "half_cell");
  // Gloss is what one part cannot draw.
  EXPECT_EQ(std::ranges::find(info.supports, Feature::glossy), info.supports.end());
  EXPECT_NE(std::ranges::find(info.supports, Feature::spot_light), info.supports.end());
}

}  // namespace
}  // namespace renderers::test
