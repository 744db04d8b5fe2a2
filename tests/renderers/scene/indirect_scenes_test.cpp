#include "renderers/scene/scene_file.h"
#include "tests/places.h"
#include "tests/renderers/scene_builder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

/// What the scenes for indirect light promise: how much of the light seen is indirect, and where it
/// comes from.
namespace renderers::test {
namespace {

scene::SceneFile catalog_file(const std::string& name) {
  return scene::read_scene_file(std::filesystem::path(tests::kSourceFolder) / "suites/scenes" /
                                (name + ".yaml"));
}

/// Mean luminance of the picture (Rec.709 weights) by the path tracer.
double mean_luminance(const scene::Scene& scene, const std::vector<std::string>& settings) {
  const Mean mean = mean_of(
      render(scene, {.settings = settings, .width_px = 32, .height_px = 32, .samples = 64}));
  return 0.2126 * mean.value[0] + 0.7152 * mean.value[1] + 0.0722 * mean.value[2];
}

double mean_bounced(const scene::Scene& scene) {
  return mean_luminance(scene, {"transport=one_bounce", "part=indirect"});
}

/// Part of the light in the picture, direct and after one bounce, that has bounced.
double share_of_bounced_light(const scene::Scene& scene) {
  const double bounced = mean_bounced(scene);
  return bounced / (bounced + mean_luminance(scene, {"transport=direct"}));
}

TEST(CornerSpot, MostLightHasBouncedWhereverTheSpotPoints) {
  const scene::SceneFile file = catalog_file("corner-spot");
  ASSERT_EQ(file.frame_count(), 121);
  for (const int frame : {0, 30, 60, 90, 120}) {
    EXPECT_GT(share_of_bounced_light(file.at_frame(frame)), 0.5) << frame;
  }
}

TEST(CornerSpot, AViewOfWhatTheSpotLightsIsMostlyDirectLight) {
  scene::Scene scene = catalog_file("corner-spot").at_frame(0);
  scene.camera.look_at = scene.camera.position + scene.lights[0].direction;
  EXPECT_LT(share_of_bounced_light(scene), 0.5);
}

}  // namespace
}  // namespace renderers::test
