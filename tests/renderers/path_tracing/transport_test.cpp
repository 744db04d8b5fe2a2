#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/renderers/scene_builder.h"

/// The four transports, their parts and the geometry clamp.
namespace renderers::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Room with an area light, a point light, an environment seen through the open front, and a
/// glossy box.
SceneBuilder mixed_room(bool is_glossy) {
  SceneBuilder builder;
  const int wall = builder.add_material(lambert({0.7F, 0.6F, 0.5F}));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(8.0F)));
  const scene::Material shiny = phong({0.2F, 0.3F, 0.2F}, glm::vec3(0.5F), 20.0F);
  const int body = builder.add_material(is_glossy ? shiny : lambert({0.2F, 0.3F, 0.2F}));
  builder.add_quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, wall);
  builder.add_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, wall);
  builder.add_quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, wall);
  builder.add_quad({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, wall);
  builder.add_quad({-0.3F, 0.99F, -0.3F}, {0.6F, 0, 0}, {0, 0, 0.6F}, lamp);
  builder.add_box({-0.4F, -1, -0.2F}, {0.2F, -0.3F, 0.4F}, body, false);
  builder.add_point_light({0.6F, 0.2F, -0.4F}, glm::vec3(0.5F));
  builder.set_environment(glm::vec3(0.4F));
  builder.look({0, 0, -3}, {0, 0, 0}, 45.0F);
  return builder;
}

TEST(Transport, DirectPlusIndirectIsRadiance) {
  const Frame frame = render(mixed_room(true).scene, {.samples = 16});
  const perception::Image& direct = aov(frame, "direct");
  const perception::Image& indirect = aov(frame, "indirect");
  for (std::size_t i = 0; i < frame.radiance.pixels.size(); ++i) {
    const float sum = direct.pixels[i] + indirect.pixels[i];
    EXPECT_NEAR(frame.radiance.pixels[i], sum, 2e-7F * sum);
  }
}

TEST(Transport, DirectIsTheDirectPartOfEveryOther) {
  const SceneBuilder builder = mixed_room(true);
  const Frame direct = render(builder.scene, {.settings = {"transport=direct"}, .samples = 16});
  for (const char* transport : {"one_bounce", "diffuse", "full"}) {
    const Frame frame =
        render(builder.scene, {.settings = {std::string("transport=") + transport}, .samples = 16});
    EXPECT_EQ(aov(frame, "direct").pixels, direct.radiance.pixels) << transport;
    EXPECT_NE(frame.radiance.pixels, direct.radiance.pixels) << transport;
  }
}

TEST(Transport, IndirectPartIsTheRest) {
  const SceneBuilder builder = mixed_room(true);
  for (const char* transport : {"one_bounce", "diffuse", "full"}) {
    const std::string setting = std::string("transport=") + transport;
    const Frame all = render(builder.scene, {.settings = {setting}, .samples = 16});
    const Frame part =
        render(builder.scene, {.settings = {setting, "part=indirect"}, .samples = 16});
    EXPECT_EQ(part.radiance.pixels, aov(all, "indirect").pixels) << transport;
    EXPECT_THROW(aov(part, "direct"), std::runtime_error);
  }
}

TEST(Transport, WithoutGlossDiffuseIsFull_AndOneBounceIsDepthTwo) {
  const SceneBuilder builder = mixed_room(false);
  const Frame full = render(builder.scene, {.samples = 16});
  const Frame diffuse = render(builder.scene, {.settings = {"transport=diffuse"}, .samples = 16});
  EXPECT_EQ(full.radiance.pixels, diffuse.radiance.pixels);
  const Frame one = render(builder.scene, {.settings = {"transport=one_bounce"}, .samples = 16});
  const Frame two = render(builder.scene, {.settings = {"max_depth=2"}, .samples = 16});
  EXPECT_EQ(one.radiance.pixels, two.radiance.pixels);
}

TEST(Transport, GlossActsAtTheFirstSurfaceOnly_ExceptInFull) {
  // A mirror-like wall lights the floor in `full` alone.
  SceneBuilder builder;
  const int floor = builder.add_material(lambert(glm::vec3(0.8F)));
  const int mirror = builder.add_material(phong(glm::vec3(0.0F), glm::vec3(0.9F), 50.0F));
  builder.add_quad({0, 0, -1}, {0, 0, 2}, {2, 0, 0}, floor);
  builder.add_quad({0, 0, -1}, {0, 2, 0}, {0, 0, 2}, mirror);
  builder.add_point_light({1, 1, 0}, glm::vec3(3.0F));
  builder.look({1.5F, 1.5F, 0.5F}, {0.6F, 0, 0}, 5.0F);
  const Frame diffuse = render(builder.scene, {.settings = {"transport=diffuse"}, .samples = 64});
  for (const float value : aov(diffuse, "indirect").pixels) EXPECT_EQ(value, 0.0F);
  const Frame full = render(builder.scene, {.samples = 64});
  double sum = 0.0;
  for (const float value : aov(full, "indirect").pixels) sum += static_cast<double>(value);
  EXPECT_GT(sum / static_cast<double>(full.radiance.pixels.size()), 0.01);
  // Seen through the mirror the floor is one interreflection of the whole BRDF: it is there.
  builder.look({1.0F, 1.0F, 0.0F}, {0, 0.7F, 0}, 5.0F);
  const Frame seen = render(builder.scene, {.settings = {"transport=one_bounce"}, .samples = 64});
  EXPECT_GT(aov(seen, "indirect").at(8, 8), 0.01F);
}

/// A floor point sees an upright square that a point light shines on.
struct TwoPlates {
  static constexpr double kFloorAlbedo = 0.5;
  static constexpr double kPlateAlbedo = 0.8;
  static constexpr double kIntensity = 4.0;
  static constexpr double kSide = 2.0;
  static constexpr glm::dvec3 kPoint{0.15, 0.0, 0.1};
  static constexpr glm::dvec3 kLight{1.5, 1.2, -0.3};

  static SceneBuilder scene() {
    SceneBuilder builder;
    const int floor = builder.add_material(lambert(glm::vec3(static_cast<float>(kFloorAlbedo))));
    const int plate = builder.add_material(lambert(glm::vec3(static_cast<float>(kPlateAlbedo))));
    builder.add_quad({0, 0, -1}, {0, 0, 2}, {2, 0, 0}, floor);
    builder.add_quad({0, 0, -1}, {0, 2, 0}, {0, 0, 2}, plate);
    builder.add_point_light(glm::vec3(kLight), glm::vec3(static_cast<float>(kIntensity)));
    builder.look({1, 1.5F, 0.2F}, glm::vec3(kPoint), 0.01F);
    return builder;
  }

  /// Radiance at the floor point over floor <- plate <- light, midpoint rule, clamped geometry.
  static double one_bounce(double clamp) {
    constexpr int kCells = 800;
    const double cell = kSide / kCells;
    double sum = 0.0;
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) {
        const glm::dvec3 y(0.0, cell * (i + 0.5), -1.0 + cell * (j + 0.5));
        const glm::dvec3 to_light = kLight - y;
        const double light2 = glm::dot(to_light, to_light);
        const double lit =
            kPlateAlbedo / kPi * kIntensity * to_light.x / std::sqrt(light2) / light2;
        const glm::dvec3 to_plate = y - kPoint;
        const double d2 = glm::dot(to_plate, to_plate);
        const double geometry = to_plate.y * -to_plate.x / (d2 * d2);
        sum += lit * std::min(geometry, clamp) * cell * cell;
      }
    }
    return kFloorAlbedo / kPi * sum;
  }
};

TEST(Transport, OneBounceAgreesWithQuadratureOnTwoPlates) {
  const SceneBuilder builder = TwoPlates::scene();
  const double expected = TwoPlates::one_bounce(1e30);
  for (const char* transport : {"one_bounce", "full"}) {
    for (const char* light_rays : {"light_rays=false", "light_rays=true"}) {
      // The plate sees the floor again, but the floor's second reflection needs three surfaces.
      const Mean mean =
          mean_of(render(builder.scene, {.settings = {std::string("transport=") + transport,
                                                      "part=indirect", "max_depth=2", light_rays},
                                         .samples = 1024}));
      EXPECT_TRUE(agree(mean, expected, 0.01))
          << light_rays << ' ' << to_string(mean) << ' ' << expected;
      EXPECT_FALSE(agree(mean, expected * kPi, 0.01)) << "a missing 1 / pi must not pass";
      EXPECT_FALSE(agree(mean, expected * 1.03, 0.01));
    }
  }
}

TEST(Transport, GeometryClampAgreesWithClampedQuadrature) {
  const SceneBuilder builder = TwoPlates::scene();
  for (const double clamp : {0.5, 3.0}) {
    const double expected = TwoPlates::one_bounce(clamp);
    for (const char* light_rays : {"light_rays=false", "light_rays=true"}) {
      const Mean mean = mean_of(render(
          builder.scene, {.settings = {"transport=one_bounce", "part=indirect",
                                       "geometry_clamp=" + std::to_string(clamp), light_rays},
                          .samples = 1024}));
      EXPECT_TRUE(agree(mean, expected, 0.01))
          << clamp << ' ' << light_rays << ' ' << to_string(mean) << ' ' << expected;
      EXPECT_FALSE(agree(mean, TwoPlates::one_bounce(1e30), 0.01)) << "the clamp must show";
    }
  }
}

TEST(Transport, GeometryClampLeavesDirectLightAlone) {
  const SceneBuilder builder = mixed_room(true);
  const Frame open = render(builder.scene, {.samples = 16});
  const Frame clamped = render(builder.scene, {.settings = {"geometry_clamp=0.1"}, .samples = 16});
  EXPECT_EQ(aov(open, "direct").pixels, aov(clamped, "direct").pixels);
  EXPECT_NE(aov(open, "indirect").pixels, aov(clamped, "indirect").pixels);
}

/// A small patch far from a corner of two plates: from the patch every segment is long, between the
/// plates segments are as short as one likes.
SceneBuilder patch_and_corner() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.9F)));
  builder.add_quad({-0.1F, -0.1F, 0}, {0.2F, 0, 0}, {0, 0.2F, 0}, white);
  builder.add_quad({0, -3, 9}, {3, 0, -3}, {0, 6, 0}, white);
  builder.add_quad({0, -3, 9}, {-3, 0, -3}, {0, 6, 0}, white);
  builder.add_point_light({0, 0, 5}, glm::vec3(50.0F));
  return builder;
}

TEST(Transport, GeometryClampActsBetweenTheFirstTwoSurfacesOnly) {
  // The plates are more than 5.9 m away: from the patch G <= 1 / d2 < 0.03 / m2.
  const std::string clamp = "geometry_clamp=0.05";
  SceneBuilder builder = patch_and_corner();
  builder.look({0.5F, 0, 1}, {0, 0, 0}, 2.0F);
  const Frame open = render(builder.scene, {.settings = {"transport=diffuse"}, .samples = 64});
  const Frame clamped =
      render(builder.scene, {.settings = {"transport=diffuse", clamp}, .samples = 64});
  EXPECT_EQ(open.radiance.pixels, clamped.radiance.pixels);
  const Frame one = render(builder.scene, {.settings = {"transport=one_bounce"}, .samples = 64});
  EXPECT_NE(open.radiance.pixels, one.radiance.pixels) << "paths over three surfaces must be there";

  // Seen themselves, the plates are the first two surfaces: the same clamp acts.
  builder.look({0, 0, 1}, {0.5F, 0, 8.5F}, 2.0F);
  const Frame corner = render(builder.scene, {.settings = {"transport=diffuse"}, .samples = 64});
  const Frame cut =
      render(builder.scene, {.settings = {"transport=diffuse", clamp}, .samples = 64});
  EXPECT_NE(corner.radiance.pixels, cut.radiance.pixels);
}

TEST(Transport, AllSamplingStrategiesHaveTheSameMean) {
  const SceneBuilder builder = mixed_room(true);
  const RenderRequest base{.width_px = 24, .height_px = 24, .samples = 1024};
  RenderRequest nee = base;
  nee.settings = {"sampling=nee"};
  RenderRequest bsdf = base;
  bsdf.settings = {"sampling=bsdf"};
  bsdf.seed = 7;
  RenderRequest random = base;
  random.settings = {"sampler=random"};
  RenderRequest light_rays = base;
  light_rays.settings = {"light_rays=false"};
  light_rays.seed = 11;
  const Mean mis = mean_of(render(builder.scene, base));
  for (const RenderRequest& request : {nee, bsdf, random, light_rays}) {
    const Mean other = mean_of(render(builder.scene, request));
    EXPECT_TRUE(agree(mis, other, 0.01))
        << request.settings[0] << ' ' << to_string(mis) << ' ' << to_string(other);
  }
}

TEST(Transport, ClaimsFollowTheParameters) {
  const RendererInfo& info = find_renderer("path", {});
  const Claims claims = info.claims(
      parameters_of("path", {"transport=one_bounce", "part=indirect", "geometry_clamp=2.5"}), {});
  EXPECT_EQ(claims, (Claims{Transport::one_bounce, Part::indirect, 2.5}));
  EXPECT_EQ(info.claims(parameters_of("path", {}), {}), (Claims{}));
}

}  // namespace
}  // namespace renderers::test
