// Scenes and settings that leave little to cluster, or are of odd sizes: what is said and counted,
// and that no number is lost. What is refused outright: clustered_visibility_settings_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "renderers/contract/devices.h"
#include "tests/expect_error.h"
#include "tests/renderers/instant_radiosity/box_scenes.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::test {
namespace {

const char* const kVisibilities[]{"visibility=oracle", "visibility=hard", "visibility=pcf",
                                  "visibility=cssm", "visibility=msm"};

Frame picture(const scene::Scene& scene, const std::vector<std::string>& settings,
              int side_px = 16) {
  RenderRequest request;
  request.renderer = "clustered-visibility";
  request.settings = {"light_map_px=64", "area_light_map_px=32", "shadow_map_px=32",
                      "part=indirect"};
  request.settings.insert(request.settings.end(), settings.begin(), settings.end());
  request.width_px = request.height_px = side_px;
  request.samples = 0;
  return render(scene, request);
}

bool is_finite(const Frame& frame) {
  const auto finite = [](float value) { return std::isfinite(value); };
  return std::ranges::all_of(frame.radiance.pixels, finite) &&
         std::ranges::all_of(aov(frame, "irradiance").pixels, finite);
}

bool has_note(const Frame& frame, const std::string& note) {
  return std::ranges::find(frame.notes, note) != frame.notes.end();
}

TEST(ClusteredOddInput, SurfacesThatReflectNothingGiveNoLightAndSaySo) {
  scene::Scene scene = spot_in_box();
  for (scene::Material& material : scene.materials) material.albedo = glm::vec3(0.0F);
  for (const char* visibility : kVisibilities) {
    const Frame frame = picture(scene, {"vpls=64", visibility});
    EXPECT_TRUE(is_finite(frame)) << visibility;
    EXPECT_EQ(mean_radiance(frame), 0.0) << visibility;
    EXPECT_TRUE(has_note(frame, "no light reaches a surface: no indirect light")) << visibility;
    EXPECT_EQ(counter(frame, "valid_vpls"), 0.0);
    EXPECT_EQ(counter(frame, "vals"), 0.0);
  }
}

TEST(ClusteredOddInput, ALightThatMeetsNothingGivesNoLightAndSaysSo) {
  SceneBuilder builder;
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.5F))));
  builder.look({0, 2, -3}, {0, 0, 0}, 60.0F);
  scene::Light spot = spot_in_box().lights.front();
  spot.position = {0.0F, 1.0F, 0.0F};
  spot.direction = {0.0F, 1.0F, 0.0F};
  builder.scene.lights.push_back(spot);
  for (const char* visibility : kVisibilities) {
    const Frame frame = picture(builder.scene, {"vpls=64", "vals=4", visibility});
    EXPECT_TRUE(is_finite(frame)) << visibility;
    EXPECT_EQ(mean_radiance(frame), 0.0) << visibility;
    EXPECT_TRUE(has_note(frame, "no light reaches a surface: no indirect light")) << visibility;
  }
  builder.scene.lights.front().direction = {0.0F, -1.0F, 0.0F};
  EXPECT_FALSE(has_note(picture(builder.scene, {"vpls=64", "vals=4"}),
                        "no light reaches a surface: no indirect light"));
}

TEST(ClusteredOddInput, FewerLightsWithFluxThanAreaLightsAreCountedAndSaid) {
  scene::Scene scene = spot_in_box();
  // Only a corner of the floor still reflects.
  for (scene::Material& material : scene.materials) material.albedo = glm::vec3(0.0F);
  SceneBuilder builder;
  builder.scene = scene;
  builder.add_quad({0.35F, 0.001F, 0.05F}, {0, 0, 0.6F}, {0.6F, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.5F))));
  for (const char* visibility : kVisibilities) {
    const Frame frame = picture(builder.scene, {"vpls=128", "vals=64", visibility});
    const double valid = counter(frame, "valid_vpls");
    EXPECT_GT(valid, 0.0);
    EXPECT_LT(valid, 64.0);
    EXPECT_EQ(counter(frame, "vals"), valid);
    EXPECT_TRUE(has_note(
        frame, std::to_string(64 - static_cast<int>(valid)) + " of 64 area lights have no light"));
    EXPECT_TRUE(is_finite(frame)) << visibility;
    EXPECT_GT(mean_of(aov(frame, "irradiance")), 0.0) << visibility;
  }
}

TEST(ClusteredOddInput, RunsOfUnequalLengthAreCounted) {
  const Frame unequal = picture(spot_in_box(), {"vpls=100", "vals=5", "interleave=8"});
  EXPECT_EQ(counter(unequal, "least_run"), 1.0);
  EXPECT_EQ(counter(unequal, "longest_run"), 2.0);
  EXPECT_TRUE(is_finite(unequal));
  const Frame equal = picture(spot_in_box(), {"vpls=128", "vals=5", "interleave=8"});
  EXPECT_EQ(counter(equal, "least_run"), 2.0);
  EXPECT_EQ(counter(equal, "longest_run"), 2.0);
  const Frame fewer = picture(spot_in_box(), {"vpls=20", "vals=5", "interleave=8"});
  EXPECT_EQ(counter(fewer, "least_run"), 0.0) << "pixels without a light of their own";
  EXPECT_TRUE(is_finite(fewer));
  EXPECT_GT(mean_radiance(fewer), 0.0);
}

TEST(ClusteredOddInput, HugeAndTinyUnitsLoseNoNumber) {
  const double metres = mean_radiance(picture(spot_in_box(), {"vpls=64", "vals=6"}));
  for (const float scale : {1e-5F, 1e5F}) {
    for (const char* visibility : kVisibilities) {
      const Frame frame = picture(scaled(spot_in_box(), scale), {"vpls=64", "vals=6", visibility});
      EXPECT_TRUE(is_finite(frame)) << visibility << " " << scale;
      EXPECT_NEAR(mean_radiance(frame), metres, 0.15 * metres) << visibility << " " << scale;
    }
  }
}

TEST(ClusteredOddInput, MapsBeyondTheDevicesMemoryAreRefusedByTheirSize) {
  if (picture(spot_in_box(), {"vpls=64"}).device.find("llvmpipe") == std::string::npos) {
    GTEST_SKIP() << "other devices may have the memory";
  }
  // Each number is within the limits.
  for (const char* visibility : {"visibility=hard", "visibility=cssm", "visibility=msm"}) {
    RenderRequest request;
    request.renderer = "clustered-visibility";
    request.settings = {"vpls=512", "vals=512", "shadow_map_px=4096", visibility};
    tests::expect_error_with<DeviceMemoryError>([&] { render(spot_in_box(), request); },
                                                {"4096 x 4096, 512 layers"});
  }
}

TEST(ClusteredOddInput, ASceneWithoutSurfacesIsBlack) {
  scene::Scene scene = spot_in_box();
  scene.objects.clear();
  for (const char* visibility : kVisibilities) {
    const Frame frame = picture(scene, {"vpls=64", visibility});
    EXPECT_EQ(mean_radiance(frame), 0.0) << visibility;
    EXPECT_TRUE(is_finite(frame)) << visibility;
  }
}

}  // namespace
}  // namespace renderers::test
