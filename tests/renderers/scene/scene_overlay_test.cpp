#include "renderers/scene/scene_overlay.h"

#include "tests/expect_input_error.h"
#include "tests/renderers/scene/scene_text.h"

#include <gtest/gtest.h>

#include <glm/vec3.hpp>

#include <vector>

namespace renderers::scene {
namespace {

const std::string kScene = tests::kSmallScene +
                           "lights:\n"
                           "  - {name: key, type: point, position: [0, 1, 0], intensity: 3}\n"
                           "  - {name: rim, type: point, position: [1, 1, 0], intensity: 2}\n"
                           "environment: {constant: 0.25}\n";

/// The scene with documents laid over it, each as if it stood in over.yaml.
Scene laid_over(const std::vector<std::string>& texts, const std::string& scene = kScene) {
  std::vector<base::Node> overlays;
  for (const std::string& text : texts) {
    overlays.push_back(base::parse_document(text, "over.yaml"));
  }
  return parse_scene(base::parse_document(scene, "small.yaml"), {}, overlays).at_frame(0);
}

std::string error_of(const std::string& text) {
  return tests::input_error_of([&] { laid_over({text}); });
}

TEST(SceneOverlay, ChangesPartsOfCameraLightAndMaterial) {
  const Scene scene = laid_over({
      "camera: {position: [1, 2, -3]}\n"
      "lights: {Key: {position: [0, 5, 0]}}\n"
      "materials: {grey: {phong: {albedo: 0.25, exponent: 9}}}\n"
      "objects: {plate: {transform: {translate: [0, 0, 7]}}}\n"
      "luminance_scale_cd_m2: 70\n",
  });
  EXPECT_EQ(scene.camera.position, glm::vec3(1, 2, -3));
  EXPECT_EQ(scene.camera.vertical_fov_deg, 40.0F);
  ASSERT_EQ(scene.lights.size(), 2U);
  EXPECT_EQ(scene.lights[0].position, glm::vec3(0, 5, 0));
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(3));
  EXPECT_EQ(scene.lights[1].position, glm::vec3(1, 1, 0));
  EXPECT_EQ(scene.materials[0].albedo, glm::vec3(0.5F));
  EXPECT_EQ(scene.materials[0].lobe.albedo, glm::vec3(0.25F));
  EXPECT_EQ(scene.objects[0].to_world[3].z, 7.0F);
  EXPECT_EQ(scene.luminance_scale_cd_m2, 70.0);
}

TEST(SceneOverlay, PutsOneLobeInPlaceOfAnother) {
  const std::string phong = "materials: {grey: {phong: {albedo: 0.25, exponent: 9}}}\n";
  const Scene scene =
      laid_over({phong, "materials: {grey: {phong: null, ggx: {albedo: 0.3, alpha: 0.2}}}\n"});
  EXPECT_EQ(scene.materials[0].lobe.shape, LobeShape::ggx);
  EXPECT_EQ(scene.materials[0].lobe.albedo, glm::vec3(0.3F));
  const std::string error = tests::input_error_of([&] {
    laid_over({phong, "materials: {grey: {ggx: {albedo: 0.3, alpha: 0.2}}}\n"});
  });
  EXPECT_NE(error.find("has the lobes phong and ggx; accepted: one"), std::string::npos) << error;
}

TEST(SceneOverlay, ANumberOfAListIsSetByItself) {
  const Scene scene = laid_over({"lights: {key: {position: {1: 4.5}}}"});
  EXPECT_EQ(scene.lights[0].position, glm::vec3(0, 4.5F, 0));
}

TEST(SceneOverlay, LaterOnesLieOverEarlierOnes) {
  const Scene scene = laid_over(
      {"lights: {key: {position: [7, 7, 7], intensity: 1}}", "lights: {key: {position: {0: 8}}}"});
  EXPECT_EQ(scene.lights[0].position, glm::vec3(8, 7, 7));
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(1));
}

TEST(SceneOverlay, NullTakesAway) {
  const Scene scene =
      laid_over({"lights: {key: null}\nenvironment: null\n"
                 "objects: {plate: {quad: null, box: {min: [0, 0, 0], max: [1, 1, 1]}}}\n"});
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(scene.lights[0].name, "rim");
  EXPECT_EQ(scene.environment, nullptr);
  EXPECT_EQ(scene.objects[0].mesh->triangles.size(), 12U);
}

TEST(SceneOverlay, SetsWhatTheSceneHasNotYet) {
  EXPECT_NE(laid_over({"environment: {constant: 1}"}, tests::kSmallScene).environment, nullptr);
}

TEST(SceneOverlay, TheHashFollowsWhatIsSet) {
  const base::Hash hash = laid_over({}).hash;
  EXPECT_EQ(laid_over({"camera: {position: [0, 0, -3]}"}).hash, hash);  // what it was
  EXPECT_NE(laid_over({"camera: {position: [0, 0, -4]}"}).hash, hash);
  EXPECT_NE(laid_over({"lights: {rim: {position: {2: 1}}}"}).hash, hash);
}

TEST(SceneOverlay, UnknownNamesAndKeysAreErrorsOfTheOverlay) {
  EXPECT_EQ(error_of("lights: {kay: {intensity: 1}}"),
            "over.yaml:1:10: unknown light \"kay\"; did you mean \"key\"? known: key, rim");
  EXPECT_EQ(error_of("objects: {plat: {}}"),
            "over.yaml:1:11: unknown object \"plat\"; did you mean \"plate\"? known: plate");
  EXPECT_EQ(error_of("camera: {positon: [0, 0, 1]}"),
            "over.yaml:1:10: unknown key \"positon\"; did you mean \"position\"? known: position, "
            "look_at, up, vertical_fov_deg, animation in camera");
  EXPECT_EQ(error_of("camera: {vertical_fov_deg: 200}"),
            "over.yaml:1:28: vertical_fov_deg 200 is outside (0, 180)");
  EXPECT_EQ(error_of("include: a.yaml"),
            "over.yaml:1:1: unknown key \"include\"; known: camera, environment, "
            "luminance_scale_cd_m2, materials, objects, lights in what a scene is set to");
  EXPECT_EQ(error_of("lights: [{name: key, intensity: 1}]"),
            "over.yaml:1:9: lights must be a map of the scene's lights to what changes, {name: "
            "{...}}, not a list");
  EXPECT_EQ(error_of("lights: {key: {name: kay}}"),
            "over.yaml:1:16: the name of light \"key\" cannot change");
}

TEST(SceneOverlay, EntriesAndKeysThatAreNotThereAreErrors) {
  EXPECT_EQ(error_of("lights: {key: {position: {3: 1}}}"),
            "over.yaml:1:27: position is a list of 3; accepted: a list, or entries by number from "
            "0; found entry \"3\"");
  EXPECT_EQ(error_of("lights: {key: {intensity: {0: 1}}}"),
            "over.yaml:1:28: intensity is no list in the scene; it has no entry 0");
  EXPECT_EQ(error_of("lights: {key: {position: {0: null}}}"),
            "over.yaml:1:30: entry 0 of position cannot be taken away; write the list");
  EXPECT_EQ(error_of("lights: {key: {cone: null}}"),
            "over.yaml:1:16: light \"key\" has no cone to take away; it has name, type, position, "
            "intensity");
  EXPECT_EQ(tests::input_error_of([] { laid_over({"environment: null"}, tests::kSmallScene); }),
            "over.yaml:1:14: scene has no environment to take away");
}

}  // namespace
}  // namespace renderers::scene
