#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/renderers/scene_builder.h"

/// What surfaces look like: place, texture, AOVs, shadows without leaks or acne.
namespace renderers::test {
namespace {

/// Emissive squares left (red), up (green), right (blue) of the view's centre, seen along +z.
SceneBuilder three_signs() {
  SceneBuilder builder;
  const int red = builder.add_material(lambert(glm::vec3(0.0F), {1, 0, 0}));
  const int green = builder.add_material(lambert(glm::vec3(0.0F), {0, 1, 0}));
  const int blue = builder.add_material(lambert(glm::vec3(0.0F), {0, 0, 1}));
  // Looking along +z with y up, +x lies to the left.
  builder.add_quad({1, -0.5F, 5}, {0, 1, 0}, {1, 0, 0}, red);
  builder.add_quad({-0.5F, 1, 5}, {0, 1, 0}, {1, 0, 0}, green);
  builder.add_quad({-2, -0.5F, 5}, {0, 1, 0}, {1, 0, 0}, blue);
  builder.look({0, 0, 0}, {0, 0, 1}, 50.0F);
  return builder;
}

TEST(View, LeftIsLeftAndUpIsUp) {
  const Frame frame = render(three_signs().scene, {.width_px = 32, .height_px = 32, .samples = 4});
  EXPECT_EQ(frame.radiance.at(5, 16, 0), 1.0F);
  EXPECT_EQ(frame.radiance.at(16, 5, 1), 1.0F);
  EXPECT_EQ(frame.radiance.at(26, 16, 2), 1.0F);
  EXPECT_EQ(frame.radiance.at(16, 26, 1), 0.0F) << "nothing below";
}

TEST(View, FirstSurfaceImagesHoldAlbedoNormalAndDepth) {
  SceneBuilder builder;
  const int floor = builder.add_material(phong({0.1F, 0.2F, 0.3F}, glm::vec3(0.25F), 5.0F));
  builder.add_quad({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}, floor);
  builder.look({0, 0, 0}, {0, 0, 1}, 90.0F);
  const Frame frame = render(builder.scene, {.width_px = 33, .height_px = 33, .samples = 4});
  EXPECT_FLOAT_EQ(aov(frame, "albedo").at(16, 16, 1), 0.45F);
  EXPECT_FLOAT_EQ(aov(frame, "normal").at(16, 16, 2), -1.0F);
  EXPECT_NEAR(aov(frame, "depth").at(16, 16), 2.0F, 1e-2F);
  EXPECT_EQ(aov(frame, "depth").at(0, 0), 0.0F) << "no surface";
  EXPECT_EQ(aov(frame, "albedo").at(0, 0, 0), 0.0F);
}

scene::Texture half_and_half() {
  scene::Texture texture;
  texture.name = "halves";
  texture.image = perception::make_rgb_image(8, 8, perception::Encoding::scene_linear);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      texture.image.at(x, y, 0) = x < 4 ? 1.0F : 0.25F;
      texture.image.at(x, y, 1) = y < 4 ? 1.0F : 0.25F;  // the top rows
      texture.image.at(x, y, 2) = 0.5F;
    }
  }
  return texture;
}

TEST(Texture, MultipliesAlbedo) {
  SceneBuilder builder;
  builder.scene.textures.push_back(half_and_half());
  scene::Material material = lambert({0.8F, 0.8F, 0.8F});
  material.albedo_texture = 0;
  // u runs along +x, v along +y; seen along -z: +x is right.
  builder.add_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, builder.add_material(material));
  builder.set_environment(glm::vec3(1.0F));
  builder.look({0, 0, 2}, {0, 0, 0}, 50.0F);
  const Frame frame = render(builder.scene, {.width_px = 16, .height_px = 16, .samples = 1024});
  const auto check = [&](int x, int y, const glm::vec3& expected) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(frame.radiance.at(x, y, c), expected[c], 0.03F * expected[c]) << x << ' ' << y;
      EXPECT_NEAR(aov(frame, "albedo").at(x, y, c), expected[c], 1e-4F);
    }
  };
  check(5, 5, {0.8F, 0.8F, 0.4F});
  check(10, 5, {0.2F, 0.8F, 0.4F});
  check(5, 10, {0.8F, 0.2F, 0.4F});
}

TEST(Texture, MultipliesEmission_AndStrategiesAgreeOnItsLight) {
  SceneBuilder builder;
  builder.scene.textures.push_back(half_and_half());
  scene::Material lamp = lambert(glm::vec3(0.0F), glm::vec3(2.0F));
  lamp.emission_texture = 0;
  builder.add_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, builder.add_material(lamp));
  builder.add_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2},
                   builder.add_material(lambert(glm::vec3(0.5F))));
  builder.look({0.3F, 0.5F, 0.3F}, {-0.5F, 0, -0.5F}, 20.0F);
  const Mean mis = mean_of(render(builder.scene, {.samples = 512}));
  const Mean nee = mean_of(render(builder.scene, {.settings = {"sampling=nee"}, .samples = 512}));
  const Mean bsdf = mean_of(render(builder.scene, {.settings = {"sampling=bsdf"}, .samples = 512}));
  EXPECT_TRUE(agree(mis, nee, 0.01)) << to_string(mis) << to_string(nee);
  EXPECT_TRUE(agree(mis, bsdf, 0.01)) << to_string(mis) << to_string(bsdf);
  EXPECT_GT(mis.value[0], 1.2 * mis.value[2]) << "the floor lies under the red half";
}

/// Black inside, at any scale and place: no ray may slip through an edge.
void expect_no_leak(float scale, const glm::vec3& place) {
  SceneBuilder builder;
  const int wall = builder.add_material(lambert(glm::vec3(0.9F)));
  builder.add_box(place - glm::vec3(scale), place + glm::vec3(scale), wall, true);
  builder.add_point_light(place + scale * glm::vec3(1.5F, 2.0F, -1.2F), glm::vec3(scale * scale));
  builder.set_environment(glm::vec3(100.0F));
  builder.look(place, place + scale * glm::vec3(1, 1, 1), 120.0F);
  const Frame frame = render(builder.scene, {.width_px = 64, .height_px = 64, .samples = 32});
  std::size_t lit = 0;
  for (const float value : frame.radiance.pixels) lit += value > 0.0F ? 1 : 0;
  EXPECT_EQ(lit, 0U) << "scale " << scale;
}

TEST(Shadow, ClosedBoxStaysBlack) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    expect_no_leak(scale, glm::vec3(0.0F));
    expect_no_leak(scale, scale * glm::vec3(100.0F, 3.0F, -50.0F));
  }
}

TEST(Shadow, FloorHasNoAcneAtAnyScale) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    SceneBuilder builder;
    builder.add_quad(scale * glm::vec3(-1, 0.37F, -1), scale * glm::vec3(0, 0.1F, 2),
                     scale * glm::vec3(2, 0.3F, 0), builder.add_material(lambert(glm::vec3(0.5F))));
    builder.add_point_light(scale * glm::vec3(0, 3, 0), glm::vec3(scale * scale * 10.0F));
    builder.look(scale * glm::vec3(0.2F, 2.5F, 0.3F), scale * glm::vec3(0, 0.5F, 0), 30.0F);
    const Frame frame = render(builder.scene, {.width_px = 48, .height_px = 48, .samples = 64});
    // All samples of a pixel see nearly the same light; one lost sample would show as variance.
    for (std::size_t i = 0; i < frame.radiance.pixels.size(); ++i) {
      const double mean = static_cast<double>(frame.radiance.pixels[i]);
      const double sigma = std::sqrt(static_cast<double>(aov(frame, "variance").pixels[i]));
      ASSERT_GT(mean, 0.0);
      ASSERT_LT(sigma, 3e-3 * mean) << "scale " << scale << " value " << i;
    }
  }
}

TEST(Shadow, ConvexSphereUnderASkyKeepsItsAlbedo) {
  for (const float scale : {1e-3F, 1e3F}) {
    SceneBuilder builder;
    builder.add_sphere(glm::vec3(0.0F), scale, 96, builder.add_material(lambert(glm::vec3(0.5F))));
    builder.set_environment(glm::vec3(1.0F));
    builder.look({0, 0, -3.0F * scale}, {0, 0, 0}, 12.0F);
    const Mean mean = mean_of(render(builder.scene, {.samples = 256}));
    EXPECT_TRUE(agree(mean, 0.5, 0.01)) << to_string(mean);
  }
}

TEST(Shadow, BlockerMakesAnUmbra) {
  SceneBuilder builder;
  const int grey = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, grey);
  builder.add_quad({-0.5F, 1, -0.5F}, {0, 0, 1}, {1, 0, 0}, grey);
  builder.add_point_light({0, 2, 0}, glm::vec3(1.0F));
  builder.look({3, 0.5F, 0}, {0, 0, 0}, 1.0F);
  const Frame shadow = render(builder.scene, {.settings = {"transport=direct"}, .samples = 16});
  for (const float value : shadow.radiance.pixels) EXPECT_EQ(value, 0.0F);
  builder.look({3, 0.5F, 0}, {1.5F, 0, 0}, 1.0F);
  const Frame light = render(builder.scene, {.settings = {"transport=direct"}, .samples = 16});
  for (const float value : light.radiance.pixels) EXPECT_GT(value, 0.0F);
}

}  // namespace
}  // namespace renderers::test
