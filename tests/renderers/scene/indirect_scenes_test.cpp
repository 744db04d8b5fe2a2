#include "renderers/scene/scene_file.h"
#include "tests/places.h"
#include "tests/renderers/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// What the scenes for one bounce of indirect light promise: how much of the light seen is
/// indirect, and where it comes from.
namespace renderers::test {
namespace {

scene::SceneFile catalog_file(const std::string& name) {
  return scene::read_scene_file(std::filesystem::path(tests::kSourceFolder) / "suites/scenes" /
                                (name + ".yaml"));
}

/// Direct light and one bounce by the path tracer, which keeps them apart as well.
Frame one_bounce(const scene::Scene& scene) {
  return render(
      scene,
      {.settings = {"transport=one_bounce"}, .width_px = 24, .height_px = 24, .samples = 64});
}

/// Sum of the luminance (Rec.709 weights) of the pixels that are chosen.
template <typename Chosen>
double sum_of(const perception::Image& image, Chosen&& is_chosen) {
  constexpr std::array<double, 3> kWeights{0.2126, 0.7152, 0.0722};
  double sum = 0.0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (is_chosen(i / 3)) sum += kWeights[i % 3] * static_cast<double>(image.pixels[i]);
  }
  return sum;
}

/// Part of the light in the picture that has bounced.
double share_of_bounced_light(const scene::Scene& scene) {
  const Frame frame = one_bounce(scene);
  const auto everywhere = [](std::size_t) { return true; };
  const double bounced = sum_of(aov(frame, "indirect"), everywhere);
  return bounced / (bounced + sum_of(aov(frame, "direct"), everywhere));
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

/// Part of the bounced light on all surfaces but those of a material that came from these.
/// @param all  the picture of the scene
double share_given_by(const std::string& material, scene::Scene scene, const Frame& all) {
  const auto named = [&](const scene::Material& m) { return m.name == material; };
  std::ranges::find_if(scene.materials, named)->albedo = glm::vec3(0.0F);
  const Frame rest = one_bounce(scene);
  const std::vector<float>& albedo = aov(all, "albedo").pixels;
  const std::vector<float>& albedo_of_rest = aov(rest, "albedo").pixels;
  const auto is_elsewhere = [&](std::size_t pixel) {
    const auto first = static_cast<std::ptrdiff_t>(3 * pixel);
    return std::equal(albedo.begin() + first, albedo.begin() + first + 3,
                      albedo_of_rest.begin() + first);
  };
  return 1.0 -
         sum_of(aov(rest, "indirect"), is_elsewhere) / sum_of(aov(all, "indirect"), is_elsewhere);
}

TEST(Dragons, EveryBeastDeformsAndColoursChange) {
  const scene::SceneFile file = catalog_file("dragons");
  const scene::Scene first = file.at_frame(0);
  int deformed = 0;
  for (const int frame : {20, 30, 40, 59}) {  // where bends are narrowest
    const scene::Scene now = file.at_frame(frame);
    EXPECT_EQ(scene::find_non_finite(now), nullptr) << frame;
    EXPECT_NE(now.hash, first.hash) << frame;
    if (frame != 30) continue;
    for (std::size_t i = 0; i < now.objects.size(); ++i) {
      const auto& mesh = *now.objects[i].mesh;
      EXPECT_EQ(mesh.triangles.size(), first.objects[i].mesh->triangles.size());
      if (mesh.positions != first.objects[i].mesh->positions) ++deformed;
    }
    int recoloured = 0;
    for (std::size_t i = 0; i < now.materials.size(); ++i) {
      if (now.materials[i].albedo != first.materials[i].albedo) ++recoloured;
    }
    EXPECT_EQ(recoloured, 2);
  }
  EXPECT_EQ(deformed, 5);
}

TEST(Dragons, TheSunlitWallGivesMostOfTheBouncedLight) {
  const scene::SceneFile file = catalog_file("dragons");
  ASSERT_EQ(file.frame_count(), 60);
  const scene::Scene scene = file.at_frame(0);
  const Frame all = one_bounce(scene);
  EXPECT_GT(share_given_by("sunlit", scene, all), 0.5);
  EXPECT_LT(share_given_by("paving", scene, all), 0.5) << "the floor is sunlit in part";
}

}  // namespace
}  // namespace renderers::test
