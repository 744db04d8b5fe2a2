#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"
#include "tests/renderers/ray_bundles/check_texture.h"
#include "tests/renderers/scene_builder.h"

/// Emission that depends on the direction: the path tracer against a closed form, bundles and
/// photons against the path tracer.
namespace renderers::test {
namespace {

/// Values at 0, 15, ... 90 degrees.
const std::vector<float> kBeam{1.0F, 0.9F, 0.45F, 0.1F, 0.02F, 0.0F, 0.0F};

scene::Material beam(float radiance) {
  scene::Material lamp = lambert(glm::vec3(0.2F), glm::vec3(radiance));
  lamp.emission_profile = kBeam;
  return lamp;
}

/// A small lamp 1 m above a floor; E = L A f(t) cos^4 t, d = 1 / cos t. At 22.5 degrees the curve
/// has 0.675.
TEST(EmissionProfile, LightsAFloorAsItsCurveSays) {
  constexpr double kSide_m = 0.01;
  for (const auto& [angle_deg, factor] :
       {std::pair{0.0, 1.0}, std::pair{22.5, 0.675}, std::pair{45.0, 0.1}, std::pair{75.0, 0.0}}) {
    SceneBuilder builder;
    const int floor = builder.add_material(lambert(glm::vec3(0.5F)));
    const auto half = static_cast<float>(0.5 * kSide_m);
    builder.add_quad({-9, 0, -9}, {0, 0, 18}, {18, 0, 0}, floor);
    builder.add_quad({-half, 1, -half}, {2 * half, 0, 0}, {0, 0, 2 * half},
                     builder.add_material(beam(1000.0F)));
    const double angle_rad = angle_deg * std::numbers::pi / 180.0;
    const auto x = static_cast<float>(std::tan(angle_rad));
    builder.look({x, 0.5F, -0.5F}, {x, 0, 0}, 0.05F);
    const double irradiance =
        1000.0 * kSide_m * kSide_m * factor * std::pow(std::cos(angle_rad), 4.0);
    for (const char* sampling : {"sampling=mis", "sampling=nee"}) {
      const Frame frame =
          render(builder.scene, {.settings = {"transport=direct", sampling}, .samples = 64});
      EXPECT_NEAR(mean_of(frame.radiance), 0.5 * irradiance / std::numbers::pi,
                  2e-3 * irradiance + 1e-9)
          << angle_deg << " " << sampling;
    }
  }
}

/// A closed room under a lamp that shines down in a beam.
SceneBuilder beamed_room() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert({0.7F, 0.6F, 0.5F}));
  builder.add_box({-1, -1, -1}, {1, 1, 1}, white, true);
  builder.add_quad({-0.4F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F},
                   builder.add_material(beam(5.0F)));
  builder.look({0.1F, 0.0F, -0.95F}, {0, -0.3F, 1}, 75.0F);
  return builder;
}

Frame truth_of(const SceneBuilder& builder) {
  return render(
      builder.scene,
      {.settings = {"transport=diffuse"}, .width_px = 32, .height_px = 32, .samples = 512});
}

Frame by_bundles(const SceneBuilder& builder, const char* direct, const char* more) {
  return render(builder.scene,
                {.renderer = "ray-bundles",
                 .settings = {"atlas_side=96", "lines=96", "pass_directions=64", direct, more},
                 .width_px = 32,
                 .height_px = 32,
                 .samples = 1500});
}

TEST(EmissionProfile, BundlesCarryIt) {
  SceneBuilder builder = beamed_room();
  const double truth = mean_of(truth_of(builder).radiance);
  EXPECT_NEAR(mean_of(by_bundles(builder, "direct=next_event", "textures=point").radiance), truth,
              0.01 * truth);
  EXPECT_NEAR(mean_of(by_bundles(builder, "direct=bundles", "textures=point").radiance), truth,
              0.02 * truth);
  // Another scene altogether without it.
  builder.scene.materials[1].emission_profile.clear();
  EXPECT_GT(mean_of(truth_of(builder).radiance), 1.5 * truth);
}

TEST(EmissionProfile, BundlesCarryItFromTextures) {
  SceneBuilder builder = beamed_room();
  builder.scene.textures.push_back(check_texture({1.0F, 0.8F, 0.6F}, {0.2F, 0.3F, 0.4F}));
  builder.scene.materials[1].emission_texture = 0;
  const double truth = mean_of(truth_of(builder).radiance);
  for (const char* textures : {"textures=point", "textures=texel"}) {
    for (const char* transfer : {"direct=bundles", "direct=next_event"}) {
      EXPECT_NEAR(mean_of(by_bundles(builder, transfer, textures).radiance), truth, 0.02 * truth)
          << textures << " " << transfer;
    }
  }
}

/// Lobes that meet the lamp's light in bundles: at the surface seen, and at all.
TEST(EmissionProfile, BundlesCarryItToLobes) {
  SceneBuilder builder = beamed_room();
  builder.scene.materials[0] = phong(glm::vec3(0.3F), glm::vec3(0.4F), 4.0F);
  const auto truth = [&](const char* transport) {
    return mean_of(
        render(builder.scene,
               {.settings = {transport}, .width_px = 32, .height_px = 32, .samples = 512})
            .radiance);
  };
  const double diffuse = truth("transport=diffuse");
  EXPECT_NEAR(mean_of(by_bundles(builder, "direct=bundles", "final_glossy=bundles").radiance),
              diffuse, 0.03 * diffuse);
  const double full = truth("transport=full");
  EXPECT_NEAR(mean_of(by_bundles(builder, "direct=bundles", "glossy=chain").radiance), full,
              0.05 * full);
}

TEST(EmissionProfile, PhotonsCarryIt) {
  const SceneBuilder builder = beamed_room();
  const double truth = mean_of(truth_of(builder).radiance);
  for (const char* renderer : {"photon-map", "irradiance-cache"}) {
    const Frame frame = render(
        builder.scene, {.renderer = renderer, .width_px = 32, .height_px = 32, .samples = 8});
    EXPECT_NEAR(mean_of(frame.radiance), truth, 0.03 * truth) << renderer;
  }
}

TEST(EmissionProfile, IsRefusedWhereItIsNotKnown) {
  SceneBuilder builder = beamed_room();
  builder.scene.materials[1].name = "spot";
  EXPECT_EQ(tests::input_error_of([&] {
              render(builder.scene, {.renderer = "ray-bundles", .settings = {"direct=pcss"}});
            }),
            "ray-bundles: material \"spot\" has an emission_profile, which direct pcss does not "
            "know; accepted: direct next_event or bundles");
  for (const RendererInfo& info : renderer_list()) {
    const bool is_known = info.name == "path" || info.name == "blank" ||
                          info.name == "ray-bundles" || info.name == "photon-map" ||
                          info.name == "irradiance-cache";
    EXPECT_EQ(unsupported_features(info, builder.scene),
              is_known ? std::vector<std::string>() : std::vector<std::string>{"emission-profile"})
        << info.name;
  }
}

}  // namespace
}  // namespace renderers::test
