#include "renderers/scene/material_reader.h"

#include "tests/expect_input_error.h"
#include "tests/renderers/scene/scene_text.h"

#include <gtest/gtest.h>

namespace renderers::scene {
namespace {

/// The first material of the small scene with its settings replaced.
Scene with_material(const std::string& settings) {
  return tests::parse(tests::with(tests::kSmallScene, "{albedo: 0.5}", settings)).at_frame(0);
}

std::string error_of(const std::string& settings) {
  return tests::input_error_of([&] { with_material(settings); });
}

TEST(Material, ReadsEverything) {
  const Scene scene = with_material(
      "{albedo: [0.1, 0.2, 0.3], phong: {albedo: 0.4, exponent: 20}, emission: [1, 2, 3]}");
  const Material& material = scene.materials[0];
  EXPECT_EQ(material.name, "grey");
  EXPECT_EQ(material.albedo, glm::vec3(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(material.lobe.albedo, glm::vec3(0.4F));
  EXPECT_EQ(material.lobe.exponent, 20.0F);
  EXPECT_EQ(material.emission, glm::vec3(1, 2, 3));
  EXPECT_EQ(material.albedo_texture, kNoTexture);
}

TEST(Material, ReadsALobeOfGgx) {
  const Scene scene = with_material("{albedo: 0.1, ggx: {albedo: [0.4, 0.5, 0.6], alpha: 0.2}}");
  const GlossyLobe& lobe = scene.materials[0].lobe;
  EXPECT_EQ(lobe.shape, LobeShape::ggx);
  EXPECT_EQ(lobe.albedo, glm::vec3(0.4F, 0.5F, 0.6F));
  EXPECT_EQ(lobe.alpha, 0.2F);
  EXPECT_TRUE(scene.materials[0].is_glossy());
}

TEST(Material, RefusesLobesOfGgxThatAreNone) {
  EXPECT_NE(error_of("{ggx: {albedo: 0.4, alpha: 0}}").find("alpha"), std::string::npos);
  EXPECT_NE(error_of("{ggx: {albedo: 0.4, alpha: 1.5}}").find("1.5"), std::string::npos);
  EXPECT_NE(error_of("{ggx: {albedo: 0.4}}").find("alpha"), std::string::npos);
  EXPECT_NE(error_of("{albedo: 0.7, ggx: {albedo: 0.4, alpha: 0.5}}").find("at most 1"),
            std::string::npos);
  EXPECT_EQ(error_of("{ggx: {albedo: 0.4, alpha: 0.5}, phong: {albedo: 0.4, exponent: 5}}"),
            "small.yaml:4:25: material \"grey\" has the lobes phong and ggx; accepted: one");
}

TEST(Material, ReadsAnEmissionProfile) {
  const Scene scene = with_material("{emission: 3, emission_profile: [1, 0.5, 0]}");
  EXPECT_EQ(scene.materials[0].emission_profile, (std::vector<float>{1.0F, 0.5F, 0.0F}));
  EXPECT_EQ(
      error_of("{emission: 3, emission_profile: [1]}"),
      "small.yaml:4:51: material \"grey\" has an emission_profile of 1 values; accepted: 2 to "
      "1801, at equal angles from the normal to the surface");
  EXPECT_NE(error_of("{emission: 3, emission_profile: [0, 0]}").find("zeros alone"),
            std::string::npos);
  EXPECT_NE(error_of("{emission: 3, emission_profile: [1, -0.5]}").find("-0.5"), std::string::npos);
  EXPECT_NE(error_of("{albedo: 0.5, emission_profile: [1, 0]}").find("no emission"),
            std::string::npos);
  EXPECT_NE(error_of("{emission: 3, emission_profile: 2}").find("list"), std::string::npos);
}

TEST(Material, TexturesTakeTheirFactorAsOne) {
  const Scene scene = with_material(
      "{albedo_texture: {checker: {a: 0.2, b: 0.8, tiles: 2}}, emission_texture: {checker: {a: 3, "
      "b: 4, tiles: 2}}}");
  EXPECT_EQ(scene.textures.size(), 2U);
  EXPECT_EQ(scene.materials[0].albedo, glm::vec3(1.0F));
  EXPECT_EQ(scene.materials[0].emission, glm::vec3(1.0F));
  EXPECT_EQ(scene.textures[1].name, "grey.emission_texture");
}

TEST(Material, EnergyIsConserved) {
  EXPECT_EQ(error_of("{albedo: 1.2}"), "small.yaml:4:28: albedo 1.2 is outside [0, 1]");
  EXPECT_EQ(error_of("{albedo: 0.7, phong: {albedo: [0.3, 0.31, 0.3], exponent: 5}}"),
            "small.yaml:4:19: material \"grey\" reflects more than it receives: 0.7 + 0.31 = 1.01 "
            "in channel G; albedo (times texture) + the lobe's albedo must be at most 1");
  EXPECT_EQ(error_of("{albedo: 0.7, phong: {albedo: 0.3, exponent: 5}}"), "no error");
  EXPECT_NE(error_of("{albedo_texture: {checker: {a: 0.2, b: 1.8, tiles: 2}}}"), "no error");
  EXPECT_EQ(error_of("{albedo: 0.5, albedo_texture: {checker: {a: 0.2, b: 1.8, tiles: 2}}}"),
            "no error");
}

TEST(Material, BadValuesAreRefused) {
  EXPECT_EQ(error_of("{emission: [1, -2, 1]}"),
            "small.yaml:4:30: emission -2 is negative; give values >= 0");
  EXPECT_EQ(error_of("{phong: {albedo: 0.1, exponent: -1}}"),
            "small.yaml:4:51: exponent -1 is outside [0, 1000000]");
  EXPECT_NE(error_of("{albeod: 0.1}").find("did you mean \"albedo\"?"), std::string::npos);
}

TEST(Material, UnknownNameHasTheNearest) {
  const std::string text = tests::with(tests::kSmallScene, "material: grey", "material: gray");
  EXPECT_EQ(tests::input_error_of([&] { tests::parse(text); }),
            "small.yaml:6:94: unknown material \"gray\"; did you mean \"grey\"? known: grey");
}

}  // namespace
}  // namespace renderers::scene
