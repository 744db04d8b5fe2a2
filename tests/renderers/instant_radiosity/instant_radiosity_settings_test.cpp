#include "renderers/instant_radiosity/instant_radiosity_settings.h"

#include <gtest/gtest.h>

#include "tests/renderers/scene_builder.h"

namespace renderers::instant_radiosity {
namespace {

using test::parameters_of;
using test::SceneBuilder;

/// A box of 2 x 2 x 1 m: its diagonal is 3 m.
scene::Scene box_scene() {
  SceneBuilder builder;
  const int white = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_box(glm::vec3(0.0F), glm::vec3(2.0F, 2.0F, 1.0F), white, true);
  return builder.scene;
}

Claims claims_with(const std::vector<std::string>& settings) {
  return claims_of(parameters_of("instant-radiosity", settings), box_scene());
}

TEST(InstantRadiositySettings, TheClampFollowsTheSizeOfTheScene) {
  const Claims claims = claims_with({"clamp_radius=0.1"});
  EXPECT_EQ(claims.transport, Transport::one_bounce);
  EXPECT_EQ(claims.part, Part::all);
  ASSERT_TRUE(claims.geometry_clamp);
  EXPECT_NEAR(*claims.geometry_clamp, 1.0 / (0.3 * 0.3), 1e-5);
}

TEST(InstantRadiositySettings, AStatedClampReplacesTheOneOfTheSize) {
  EXPECT_EQ(claims_with({"clamp_radius=0.1", "geometry_clamp=7"}).geometry_clamp, 7.0);
}

TEST(InstantRadiositySettings, NoClampIsClaimedWithoutABoundOrWhereItsLossIsCompensated) {
  EXPECT_FALSE(claims_with({"clamp_radius=0"}).geometry_clamp);
  EXPECT_FALSE(claims_with({"geometry_clamp=7", "compensation_rays=1"}).geometry_clamp);
}

TEST(InstantRadiositySettings, AnEmptySceneHasNoClamp) {
  EXPECT_EQ(geometry_clamp_of(Settings{}, scene::Scene{}), 0.0);
}

TEST(InstantRadiositySettings, EveryDefaultIsThatOfTheStruct) {
  const Settings read = settings_of(parameters_of("instant-radiosity", {}));
  const Settings made;
  EXPECT_EQ(read.samples, made.samples);
  EXPECT_EQ(read.virtual_lights, made.virtual_lights);
  EXPECT_EQ(read.visibility, made.visibility);
  EXPECT_EQ(read.part, made.part);
  EXPECT_EQ(read.light_map_px, made.light_map_px);
  EXPECT_EQ(read.area_light_map_px, made.area_light_map_px);
  EXPECT_EQ(read.samples_solid_angle, made.samples_solid_angle);
  EXPECT_EQ(read.area_light_maps, made.area_light_maps);
  EXPECT_EQ(read.environment_maps, made.environment_maps);
  EXPECT_EQ(read.shadow_map_px, made.shadow_map_px);
  EXPECT_EQ(read.shadow_map_batch, made.shadow_map_batch);
  EXPECT_EQ(read.imperfect_points, made.imperfect_points);
  EXPECT_EQ(read.keeps_imperfect_points, made.keeps_imperfect_points);
  EXPECT_EQ(read.fills_holes, made.fills_holes);
  EXPECT_EQ(read.interleave, made.interleave);
  EXPECT_EQ(read.clamp_radius, made.clamp_radius);
  EXPECT_EQ(read.geometry_clamp, made.geometry_clamp);
  EXPECT_EQ(read.compensation_rays, made.compensation_rays);
  EXPECT_EQ(read.blur, made.blur);
  EXPECT_EQ(read.blur_distance, made.blur_distance);
  EXPECT_EQ(read.blur_normal, made.blur_normal);
  EXPECT_EQ(read.camera_rays, made.camera_rays);
  EXPECT_EQ(read.light_samples, made.light_samples);
}

TEST(InstantRadiositySettings, OnlyWhatNeedsRaysBuildsThem) {
  const auto needs = [](const std::vector<std::string>& settings) {
    return settings_of(parameters_of("instant-radiosity", settings)).needs_rays();
  };
  EXPECT_FALSE(needs({"part=indirect", "visibility=shadow_map"}));
  EXPECT_TRUE(needs({"part=indirect", "visibility=ray"}));
  EXPECT_TRUE(needs({"part=all", "visibility=none"}));
  EXPECT_TRUE(needs({"part=indirect", "visibility=none", "compensation_rays=2"}));
}

}  // namespace
}  // namespace renderers::instant_radiosity
