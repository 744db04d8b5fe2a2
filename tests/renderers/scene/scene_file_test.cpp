#include "renderers/scene/scene_file.h"

#include "tests/expect_input_error.h"
#include "tests/renderers/scene/scene_text.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <map>

namespace renderers::scene {
namespace {

const std::string kMoving = tests::with(
    tests::kSmallScene, "material: grey}",
    "material: grey, transform: {translate: [1, 0, 0]},\n     animation: {keys: [{frame: 10}, "
    "{frame: 20, translate: [3, 0, 0]}]}}");

float x_of(const Scene& scene) { return scene.objects[0].to_world[3].x; }

TEST(SceneFile, StaticSceneHasOneFrame) {
  const SceneFile file = tests::parse(tests::kSmallScene);
  EXPECT_EQ(file.frame_count(), 1);
  EXPECT_FALSE(file.at_frame(0).is_animated);
  EXPECT_EQ(file.at_frame(7).hash, file.at_frame(0).hash);
  EXPECT_EQ(file.at_frame(0).luminance_scale_cd_m2, 100.0);
}

TEST(SceneFile, AnimationMovesObjects) {
  const SceneFile file = tests::parse(kMoving);
  EXPECT_EQ(file.frame_count(), 21);
  EXPECT_TRUE(file.at_frame(0).is_animated);
  EXPECT_FLOAT_EQ(x_of(file.at_frame(0)), 1.0F);
  EXPECT_FLOAT_EQ(x_of(file.at_frame(15)), 2.0F);
  EXPECT_FLOAT_EQ(x_of(file.at_frame(99)), 3.0F);
  EXPECT_EQ(file.at_frame(15).frame_index, 15);
  EXPECT_NE(tests::input_error_of([&] { file.at_frame(-1); }), "no error");
}

TEST(SceneFile, NumbersThatOverflowAreRefusedWithObjectAndFrame) {
  const SceneFile file = tests::parse(tests::with(tests::kSmallScene, "material: grey}",
                                                  "material: grey, transform: {translate: [3e38, "
                                                  "0, 0], scale: 3e38}}"));
  EXPECT_EQ(tests::input_error_of([&] { file.at_frame(2); }),
            "object \"plate\" has vertices at frame 2 that are NaN or infinite; its transform, "
            "deform or shape leaves the range of numbers");
}

TEST(SceneFile, HashIsOfThisFramesState) {
  const SceneFile file = tests::parse(kMoving);
  EXPECT_EQ(file.at_frame(0).hash, file.at_frame(10).hash);
  EXPECT_EQ(file.at_frame(20).hash, file.at_frame(30).hash);
  EXPECT_NE(file.at_frame(10).hash, file.at_frame(11).hash);
}

TEST(SceneFile, TheWorldsHashLeavesTheCameraOut) {
  const Scene scene = tests::parse(tests::kSmallScene).at_frame(0);
  const auto changed = [&](const std::string& from, const std::string& to) {
    return tests::parse(tests::with(tests::kSmallScene, from, to)).at_frame(0);
  };
  EXPECT_NE(scene.world_hash, base::Hash());
  EXPECT_EQ(changed("[0, 0, -3]", "[0, 0, -4]").world_hash, scene.world_hash);
  EXPECT_EQ(changed("deg: 40", "deg: 41").world_hash, scene.world_hash);
  EXPECT_NE(changed("albedo: 0.5", "albedo: 0.6").world_hash, scene.world_hash);
  EXPECT_NE(changed("edge_u: [1,", "edge_u: [2,").world_hash, scene.world_hash);
  // Frames of one file: where the camera moves, and where an object does.
  const SceneFile walk = tests::parse(
      tests::with(tests::kSmallScene, "deg: 40",
                  "deg: 40, animation: {keys: [{frame: 0}, {frame: 9, position: [0, 1, -3]}]}"));
  EXPECT_EQ(walk.at_frame(9).world_hash, walk.at_frame(0).world_hash);
  EXPECT_NE(walk.at_frame(9).hash, walk.at_frame(0).hash);
  const SceneFile moving = tests::parse(kMoving);
  EXPECT_NE(moving.at_frame(15).world_hash, moving.at_frame(10).world_hash);
}

TEST(SceneFile, HashDoesNotDependOnNames) {
  std::string renamed = tests::with(tests::kSmallScene, "scene: small", "scene: other");
  renamed = tests::with(renamed, "name: plate", "name: sheet");
  renamed = tests::with(renamed, "{grey: {albedo: 0.5}}", "{dull: {albedo: 0.5}, more: {}}");
  renamed = tests::with(renamed, "material: grey", "material: dull");
  EXPECT_EQ(tests::parse(renamed).at_frame(0).hash,
            tests::parse(tests::kSmallScene).at_frame(0).hash);
}

TEST(SceneFile, EveryChangeOfContentChangesTheHash) {
  const std::string extra = tests::kSmallScene + R"(luminance_scale_cd_m2: 50
lights:
  - {name: s, type: spot, position: [1, 2, 3], direction: [0, -1, 0], intensity: 5, cone_deg: [10, 20]}
environment: {constant: 0.25, scale: 3, rotate_deg: 9}
)";
  const std::vector<std::pair<std::string, std::string>> changes{
      {"[0, 0, -3]", "[0, 0, -4]"},
      {"deg: 40", "deg: 41"},
      {"albedo: 0.5", "albedo: 0.6"},
      {"albedo: 0.5", "albedo: 0.5, emission: 1"},
      {"albedo: 0.5", "albedo: 0.5, emission: 1, emission_profile: [1, 0]"},
      {"albedo: 0.5", "albedo: 0.5, emission: 1, emission_profile: [1, 0.1]"},
      {"albedo: 0.5", "albedo: 0.5, phong: {albedo: 0.1, exponent: 9}"},
      {"albedo: 0.5", "albedo: 0.5, ggx: {albedo: 0.1, alpha: 0.5}"},
      {"albedo: 0.5", "albedo: 0.5, ggx: {albedo: 0.1, alpha: 0.6}"},
      {"albedo: 0.5", "albedo: 0.5, albedo_texture: {checker: {a: 0, b: 1, tiles: 2}}"},
      {"edge_u: [1,", "edge_u: [2,"},
      {"material: grey}", "material: grey, transform: {scale: 2}}"},
      {"cd_m2: 50", "cd_m2: 51"},
      {"position: [1, 2, 3]", "position: [1, 2, 4]"},
      {"direction: [0, -1, 0]", "direction: [1, -1, 0]"},
      {"intensity: 5", "intensity: 6"},
      {"[10, 20]", "[10, 21]"},
      {"type: spot, position: [1, 2, 3], direction: [0, -1, 0], intensity: 5, cone_deg: [10, 20]",
       "type: point, position: [1, 2, 3], intensity: 5"},
      {"constant: 0.25", "constant: 0.5"},
      {"scale: 3", "scale: 4"},
      {"rotate_deg: 9", "rotate_deg: 8"}};
  std::map<std::string, std::string> seen{{tests::parse(extra).at_frame(0).hash.hex(), "nothing"}};
  for (const auto& [from, to] : changes) {
    const auto [known, is_new] =
        seen.emplace(tests::parse(tests::with(extra, from, to)).at_frame(0).hash.hex(), to);
    EXPECT_TRUE(is_new) << to << " has the hash of " << known->second;
  }
}

TEST(SceneFile, HashIsOfTheMeshNotOfItsFile) {
  const tests::TemporaryFolder folder;
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  tests::write(folder.path() / "a.obj", triangle);
  tests::write(folder.path() / "b.obj", "# a copy\n" + triangle);
  tests::write(folder.path() / "c.obj", tests::with(triangle, "1 0 0", "2 0 0"));
  const auto hash_with = [&](const std::string& file) {
    const std::string text = tests::with(
        tests::kSmallScene, "quad: {origin: [0, 0, 0], edge_u: [1, 0, 0], edge_v: [0, 1, 0]}",
        "mesh: {file: " + file + "}");
    return tests::parse(text, folder.path()).at_frame(0).hash;
  };
  EXPECT_EQ(hash_with("a.obj"), hash_with("b.obj"));
  EXPECT_NE(hash_with("a.obj"), hash_with("c.obj"));
}

TEST(SceneFile, ObjectsNeedExactlyOneShape) {
  const std::string quad = "quad: {origin: [0, 0, 0], edge_u: [1, 0, 0], edge_v: [0, 1, 0]}, ";
  EXPECT_EQ(tests::input_error_of([&] { tests::parse(tests::with(tests::kSmallScene, quad, "")); }),
            "small.yaml:6:5: object \"plate\" has no shape; it needs exactly one of: mesh, quad, "
            "polygons, box, sphere, disk, generator");
  EXPECT_EQ(tests::input_error_of(
                [&] { tests::parse(tests::with(tests::kSmallScene, quad, quad + "disk: {}, ")); }),
            "small.yaml:6:5: object \"plate\" has the shapes quad, disk; it needs exactly one of: "
            "mesh, quad, polygons, box, sphere, disk, generator");
}

TEST(SceneFile, MeshErrorsSayWhereTheMeshIsNamed) {
  const tests::TemporaryFolder folder;
  tests::write(folder.path() / "a.obj", "v 0 0 0\nf 1 1 2\n");
  const std::string text = tests::with(
      tests::kSmallScene, "quad: {origin: [0, 0, 0], edge_u: [1, 0, 0], edge_v: [0, 1, 0]}",
      "mesh: {file: a.obj}");
  EXPECT_EQ(tests::input_error_of([&] { tests::parse(text, folder.path()); }),
            "small.yaml:6:25: " + (folder.path() / "a.obj").string() +
                ":2: a face names vertex 2; the file has 1");
}

TEST(SceneFile, NamesAndSummariesAreChecked) {
  EXPECT_NE(tests::input_error_of([] {
              tests::parse(tests::with(tests::kSmallScene, "scene: small", "scene: a/b"));
            }),
            "no error");
  EXPECT_EQ(tests::parse(tests::kSmallScene + "summary: One line.\n").summary(), "One line.");
  EXPECT_EQ(tests::input_error_of(
                [] { tests::parse(tests::kSmallScene + "summary: \"two\\nlines\"\n"); }),
            "small.yaml:7:10: summary must be one line");
}

TEST(Generator, IsSeededAndBringsItsMaterial) {
  const auto scene_with = [](const std::string& seed) {
    const std::string text = tests::kSmallScene +
                             "  - {name: town, generator: {name: scattered_boxes, seed: " + seed +
                             ", count: 7, area: [4, 4], height: [0.5, 1]}}\n";
    return tests::parse(text).at_frame(0);
  };
  const Scene scene = scene_with("1");
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[1].name, "town.boxes");
  EXPECT_EQ(scene.face_count(), 2U + 7U * 10U);
  EXPECT_EQ(scene.materials[static_cast<std::size_t>(scene.objects[1].material)].name,
            "town.boxes");
  EXPECT_EQ(scene.hash, scene_with("1").hash);
  EXPECT_NE(scene.hash, scene_with("2").hash);
}

TEST(Generator, UnknownNamesAreRefused) {
  const std::string text =
      tests::kSmallScene + "  - {name: town, generator: {name: scattered-boxs}}\n";
  EXPECT_EQ(
      tests::input_error_of([&] { tests::parse(text); }),
      "small.yaml:7:36: unknown generator \"scattered-boxs\"; did you mean "
      "\"scattered-boxes\"? known: atrium, library, metaballs, plant, scattered-boxes, toy-room");
}

}  // namespace
}  // namespace renderers::scene
