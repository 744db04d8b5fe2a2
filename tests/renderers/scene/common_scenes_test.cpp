#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/scene/scene_file.h"
#include "tests/places.h"
#include "tests/renderers/scene_builder.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <filesystem>
#include <string>

/// What the scenes that every technique renders promise.
namespace renderers::test {
namespace {

const std::filesystem::path kCatalog =
    std::filesystem::path(tests::kSourceFolder) / "suites/scenes";

scene::Scene catalog_scene(const std::string& name) {
  return scene::read_scene_file(kCatalog / (name + ".yaml")).at_frame(0);
}

/// Mean of the direct light's luminance (Rec.709 weights).
double mean_direct(const scene::Scene& scene) {
  const Frame frame = render(
      scene, {.settings = {"transport=direct"}, .width_px = 64, .height_px = 48, .samples = 32});
  double sum = 0.0;
  for (std::size_t i = 0; i < frame.radiance.pixels.size(); i += 3) {
    const float* pixel = &frame.radiance.pixels[i];
    sum += 0.2126 * static_cast<double>(pixel[0]) + 0.7152 * static_cast<double>(pixel[1]) +
           0.0722 * static_cast<double>(pixel[2]);
  }
  return sum / (64.0 * 48.0);
}

class CommonScene : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Both, CommonScene, testing::Values("common-box", "common-atrium"),
                         [](const auto& scene) { return std::string(scene.param).substr(7); });

TEST_P(CommonScene, EachLightGives30To70PercentOfTheDirectLight) {
  const scene::Scene both = catalog_scene(GetParam());
  scene::Scene lamp = both;
  lamp.lights.clear();
  scene::Scene spot = both;
  for (scene::Material& material : spot.materials) material.emission = glm::vec3(0.0F);
  // The lamp's own pixels: what is left when nothing reflects.
  scene::Scene seen = lamp;
  for (scene::Material& material : seen.materials) {
    material.albedo = glm::vec3(0.0F);
    material.lobe.albedo = glm::vec3(0.0F);
  }
  const double of_lamp = mean_direct(lamp) - mean_direct(seen);
  const double of_spot = mean_direct(spot);
  const double share = of_lamp / (of_lamp + of_spot);
  EXPECT_GE(share, 0.3);
  EXPECT_LE(share, 0.7);
}

TEST_P(CommonScene, HasOneLampOneSpotAndLambertSurfacesOnly) {
  const scene::Scene scene = catalog_scene(GetParam());
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(scene.lights[0].type, scene::LightType::spot);
  int lamps = 0;
  for (const scene::Object& object : scene.objects) {
    const auto& material = scene.materials[static_cast<std::size_t>(object.material)];
    EXPECT_FALSE(material.is_glossy());
    if (!material.is_emissive()) continue;
    ++lamps;
    EXPECT_EQ(object.mesh->triangles.size(), 2U);
  }
  EXPECT_EQ(lamps, 1);
  EXPECT_FALSE(scene.environment);
}

/// All surfaces along the rays of a small image.
struct Casting {
  double mean_surfaces = 0.0;
  double part_seen_from_behind = 0.0;  ///< first surfaces that show their back
  double part_empty = 0.0;
};

Casting cast(const scene::Scene& scene) {
  constexpr int kWidth = 64;
  constexpr int kHeight = 48;
  constexpr int kMostSurfaces = 500;
  StageTimer timer;
  timer.set_phase(Phase::prepare);
  const ray_tracing::RayScene rays(scene, timer);
  Casting result;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const float px = static_cast<float>(i % kWidth) + 0.5F;
    const float py = static_cast<float>(i / kWidth) + 0.5F;
    const glm::vec3 direction = scene::camera_ray_direction(scene.camera, kWidth, kHeight, px, py);
    ray_tracing::Ray ray{scene.camera.position, direction};
    ray_tracing::Hit hit;
    int surfaces = 0;
    for (; surfaces < kMostSurfaces && rays.intersect(ray, hit); ++surfaces) {
      if (surfaces == 0 && glm::dot(hit.geometric_normal, direction) > 0.0F) {
        result.part_seen_from_behind += 1.0;
      }
      ray = ray_from(hit, direction);
    }
    result.mean_surfaces += static_cast<double>(surfaces);
    if (surfaces == 0) result.part_empty += 1.0;
  }
  constexpr double kPixels = kWidth * kHeight;
  return {result.mean_surfaces / kPixels, result.part_seen_from_behind / kPixels,
          result.part_empty / kPixels};
}

TEST(CommonAtrium, IsDeepClosedAndSeenFromTheFront) {
  const Casting casting = cast(catalog_scene("common-atrium"));
  EXPECT_GE(casting.mean_surfaces, 6.0);
  EXPECT_EQ(casting.part_empty, 0.0);
  EXPECT_LT(casting.part_seen_from_behind, 0.02) << "cloth and leaves have one layer";
}

TEST(CommonBox, IsSeenFromTheFront) {
  EXPECT_EQ(cast(catalog_scene("common-box")).part_seen_from_behind, 0.0);
}

TEST(CommonAtrium, WindingsAreRightFromWhereverOneStands) {
  // From points in the court, the aisles and the gallery, all around: only single layers show
  // their backs.
  scene::Scene scene = catalog_scene("common-atrium");
  std::erase_if(scene.objects, [](const scene::Object& object) {
    return object.name.find("curtain") != std::string::npos || object.name == "atrium.banners" ||
           object.name == "atrium.plants";
  });
  for (const glm::vec3& from : {glm::vec3(0.5F, 1.7F, -5),
                                {5.6F, 1.7F, 2},
                                {-5.4F, 7, -3},
                                {1, 7, 12.6F},
                                {-5.5F, 1.7F, -12.9F},
                                {0, 9, 0.3F}}) {
    for (const glm::vec3& towards : {glm::vec3(1, 0.05F, 0),
                                     {-1, 0.05F, 0},
                                     {0.1F, 0.1F, 1},
                                     {0, -0.1F, -1},
                                     {0.1F, 1, 0},
                                     {0.1F, -1, 0}}) {
      scene.camera = {from, from + towards, {0.0F, 0.6F, 0.8F}, 80.0F};
      EXPECT_EQ(cast(scene).part_seen_from_behind, 0.0)
          << from.x << " " << from.y << " " << from.z << " towards " << towards.x << " "
          << towards.y << " " << towards.z;
    }
  }
}

TEST(MovingScenes, AreRenderedAtEveryStage) {
  for (const char* name : {"moving-box", "metaballs"}) {
    const scene::SceneFile file = scene::read_scene_file(kCatalog / (std::string(name) + ".yaml"));
    EXPECT_EQ(file.frame_count(), 60) << name;
    for (const int frame : {0, 29, 59}) {
      const Frame image = render(file.at_frame(frame), {.samples = 16});
      const Mean mean = mean_of(image);
      EXPECT_GT(mean.value[1], 0.05) << name;
      EXPECT_LT(mean.value[1], 1.0) << name;
    }
  }
}

}  // namespace
}  // namespace renderers::test
