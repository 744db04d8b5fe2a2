#include "renderers/scene/scene_layers.h"

#include "tests/expect_input_error.h"
#include "tests/renderers/scene/scene_text.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

namespace renderers::scene {
namespace {

class SceneLayersTest : public ::testing::Test {
 protected:
  SceneLayersTest() { tests::write(folder_.path() / "base.yaml", tests::kSmallScene); }

  SceneFile read(const std::string& text) {
    tests::write(folder_.path() / "top.yaml", text);
    return read_scene_file(folder_.path() / "top.yaml");
  }

  /// The message without the folder.
  std::string error_of(const std::string& text) {
    std::string message = tests::input_error_of([&] { read(text); });
    const std::string prefix = folder_.path().string() + "/";
    for (std::size_t at = message.find(prefix); at != std::string::npos;
         at = message.find(prefix)) {
      message.erase(at, prefix.size());
    }
    return message;
  }

  tests::TemporaryFolder folder_;
};

const std::string kTop = "schema: 1\nscene: top\ninclude: base.yaml\n";

TEST_F(SceneLayersTest, IncludedKeysAreThere) {
  const Scene scene = read(kTop).at_frame(0);
  EXPECT_EQ(scene.name, "top");
  EXPECT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.camera.vertical_fov_deg, 40.0F);
}

TEST_F(SceneLayersTest, SameNamesReplaceAndNewOnesFollow) {
  const Scene scene =
      read(kTop +
           "materials: {grey: {albedo: 0.2}}\nobjects:\n"
           "  - {name: ball, sphere: {center: [0, 0, 0], radius: 1}, material: grey}\n"
           "  - {name: Plate, box: {min: [0, 0, 0], max: [1, 1, 1]}, material: grey}\n")
          .at_frame(0);
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[0].name, "plate");
  EXPECT_EQ(scene.objects[0].mesh->triangles.size(), 12U);
  EXPECT_EQ(scene.objects[1].name, "ball");
  EXPECT_EQ(scene.materials[0].albedo, glm::vec3(0.2F));
}

TEST_F(SceneLayersTest, RemoveTakesIncludedThingsAway) {
  const Scene scene = read(kTop +
                           "remove: [plate]\nobjects: [{name: b, box: {min: [0, 0, 0], max: "
                           "[1, 1, 1]}, material: grey}]\n")
                          .at_frame(0);
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "b");
  EXPECT_EQ(
      error_of(kTop + "remove: [plat]\n"),
      "top.yaml:4:10: unknown included object or light \"plat\"; did you mean \"plate\"? known: "
      "plate");
}

TEST_F(SceneLayersTest, IncludedPathsStartAtTheIncludedFile) {
  std::filesystem::create_directory(folder_.path() / "parts");
  tests::write(folder_.path() / "parts/a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  tests::write(folder_.path() / "parts/part.yaml",
               "schema: 1\nmaterials: {red: {albedo: 0.5}}\n"
               "objects: [{name: m, mesh: {file: a.obj}, material: red}]\n");
  EXPECT_EQ(read(tests::with(kTop, "base.yaml", "[base.yaml, parts/part.yaml]"))
                .at_frame(0)
                .objects.size(),
            2U);
}

TEST_F(SceneLayersTest, CyclesAndMissingFilesAreRefused) {
  EXPECT_EQ(error_of(tests::with(kTop, "base.yaml", "top.yaml")),
            "top.yaml:3:10: top.yaml includes itself");
  tests::write(folder_.path() / "loop.yaml", "schema: 1\ninclude: top.yaml\n");
  EXPECT_EQ(error_of(tests::with(kTop, "base.yaml", "loop.yaml")),
            "loop.yaml:2:10: top.yaml includes itself");
  EXPECT_EQ(error_of(tests::with(kTop, "base.yaml", "gone.yaml")),
            "top.yaml:3:10: included file gone.yaml not found (looked for gone.yaml)");
}

TEST_F(SceneLayersTest, DuplicateNamesInOneFileAreRefused) {
  const std::string object = "{name: a, box: {min: [0, 0, 0], max: [1, 1, 1]}, material: grey}";
  EXPECT_EQ(error_of(kTop + "objects:\n  - " + object + "\n  - " + object + "\n"),
            "top.yaml:6:12: object \"a\" is already there, at top.yaml:5:5");
  EXPECT_NE(error_of(kTop + "materials: {a-b: {albedo: 0}, a_b: {albedo: 0}}\n"), "no error");
}

TEST_F(SceneLayersTest, NamesAreRequired) {
  EXPECT_EQ(error_of(kTop + "objects: [{material: grey}]\n"),
            "top.yaml:4:11: this object has no name; add name: ...");
}

TEST_F(SceneLayersTest, UnknownKeysAndSchemasAreRefused) {
  EXPECT_NE(error_of(kTop + "camra: {}\n").find("top.yaml:4:1: "), std::string::npos);
  EXPECT_NE(error_of(kTop + "camra: {}\n").find("did you mean \"camera\"?"), std::string::npos);
  EXPECT_EQ(error_of("schema: 2\n"), "top.yaml:1:9: schema 2 is unknown; this program reads 1");
}

}  // namespace
}  // namespace renderers::scene
