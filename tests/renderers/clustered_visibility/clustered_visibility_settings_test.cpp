#include "renderers/clustered_visibility/clustered_visibility_settings.h"

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::clustered_visibility {
namespace {

using test::parameters_of;

Settings settings_with(const std::vector<std::string>& settings) {
  return settings_of(parameters_of("clustered-visibility", settings));
}

std::string error_with(const std::vector<std::string>& settings) {
  return tests::input_error_of([&] { settings_with(settings); });
}

TEST(ClusteredVisibilitySettings, MoreAreaLightsThanLightsAreRefused) {
  EXPECT_EQ(error_with({"vpls=16", "vals=30"}),
            "vals is 30: more area lights than the 16 point lights of vpls; accepted: 1 to 16");
  EXPECT_EQ(settings_with({"vpls=16", "vals=16"}).clusters.clusters, 16);
}

TEST(ClusteredVisibilitySettings, OnlyAnAreaLightThatExistsIsShown) {
  EXPECT_EQ(error_with({"vals=8", "only_val=8"}),
            "only_val is 8: there are 8 area lights; accepted: -1 to 7");
  EXPECT_EQ(settings_with({"vals=8", "only_val=7"}).only_val, 7);
  for (const char* other : {"adaptive=true", "bounces=2"}) {
    EXPECT_NE(error_with({"only_val=1", other}), "") << other;
  }
}

TEST(ClusteredVisibilitySettings, MapsOfOtherSidesThanPowersOfTwoAreRefused) {
  EXPECT_EQ(error_with({"shadow_map_px=200"}),
            "shadow_map_px is 200, which is no power of two; nearest: 128 and 256");
}

TEST(ClusteredVisibilitySettings, ThePaperPresetIsWhatThePaperStates) {
  base::Parameters parameters = parameters_of("clustered-visibility", {});
  for (const base::Preset& preset : presets()) {
    if (preset.name != "paper") continue;
    for (const auto& [name, value] : preset.values) parameters.set(name, value);
  }
  const Settings paper = settings_of(parameters);
  EXPECT_EQ(paper.virtual_lights, 1024);
  EXPECT_EQ(paper.clusters.clusters, 30);
  EXPECT_EQ(paper.clusters.start, ClusterStart::stride);
  EXPECT_EQ(paper.clusters.sums, ClusterSums::scatter);
  EXPECT_FALSE(paper.clusters.is_warm);
  EXPECT_FLOAT_EQ(paper.clusters.position_weight, 0.7F);
  EXPECT_FLOAT_EQ(paper.clusters.normal_weight, 0.3F);
  EXPECT_EQ(paper.clusters.area, AreaFrom::rectangle);
  EXPECT_EQ(paper.shadow_map_px, 256);
  EXPECT_EQ(paper.depth, shadow_maps::DepthBackend::vertex);
  EXPECT_EQ(paper.convolution.terms, 4);
  EXPECT_EQ(paper.convolution.format, BasisFormat::bits_8);
  EXPECT_EQ(paper.convolution.prefilter, Prefilter::mip);
  EXPECT_EQ(paper.area.blocker, BlockerDepth::raw);
  EXPECT_EQ(paper.area.kernel, KernelWidth::paper);
  EXPECT_EQ(paper.area.slope_bias, 0.0F);
  EXPECT_EQ(paper.area.finer_levels, 0.0F);
  EXPECT_EQ(paper.interleave, 8);
  EXPECT_DOUBLE_EQ(paper.blur_distance, 0.1);
  EXPECT_DOUBLE_EQ(paper.blur_normal, 0.8);
}

TEST(ClusteredVisibilitySettings, OneBounceUnderTheBoundIsClaimed) {
  test::SceneBuilder builder;
  const int white = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_box(glm::vec3(0.0F), glm::vec3(2.0F, 2.0F, 1.0F), white, true);
  const Claims claims =
      claims_of(parameters_of("clustered-visibility", {"clamp_radius=0.1"}), builder.scene);
  EXPECT_EQ(claims.transport, Transport::one_bounce);
  ASSERT_TRUE(claims.geometry_clamp);
  EXPECT_NEAR(*claims.geometry_clamp, 1.0 / (0.3 * 0.3), 1e-5);
  EXPECT_FALSE(claims_of(parameters_of("clustered-visibility", {"clamp_radius=0"}), builder.scene)
                   .geometry_clamp);
  EXPECT_EQ(
      claims_of(parameters_of("clustered-visibility", {"bounces=2"}), builder.scene).transport,
      Transport::diffuse);
}

}  // namespace
}  // namespace renderers::clustered_visibility
