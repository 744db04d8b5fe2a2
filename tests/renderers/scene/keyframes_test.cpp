#include "renderers/scene/keyframes.h"

#include "renderers/scene/scene_file.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/scene/scene_text.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <limits>

namespace renderers::scene {
namespace {

float mix(float a, float b, float t) { return a + t * (b - a); }

TEST(Track, HoldsOutsideAndMixesBetweenItsKeys) {
  const Track<float> track{{{10, 1.0F}, {20, 3.0F}, {21, 0.0F}}, true};
  EXPECT_EQ(track.at(0, mix), 1.0F);
  EXPECT_EQ(track.at(10, mix), 1.0F);
  EXPECT_EQ(track.at(15, mix), 2.0F);
  EXPECT_EQ(track.at(20, mix), 3.0F);
  EXPECT_EQ(track.at(21, mix), 0.0F);
  EXPECT_EQ(track.at(std::numeric_limits<int>::max(), mix), 0.0F);
  EXPECT_EQ(track.last_frame(), 21);
}

/// The plate under a spot, with everything that may have keys.
const std::string kMoving = R"(schema: 1
scene: moving
camera: {position: [0, 0, -3], look_at: [0, 0, 0], vertical_fov_deg: 40, animation: {keys: [{frame: 0}, {frame: 10, position: [2, 0, -3], look_at: [2, 1, 0], vertical_fov_deg: 60}]}}
materials:
  grey: {albedo: 0.5, emission: 1, animation: {keys: [{frame: 0}, {frame: 4, albedo: [0.9, 0.5, 0.1]}, {frame: 8, emission: 3}]}}
objects:
  - {name: plate, quad: {origin: [0, 0, 0], edge_u: [1, 0, 0], edge_v: [0, 1, 0]}, material: grey}
lights:
  - {name: key, type: spot, position: [0, 5, 0], direction: [1, 0, 0], intensity: 4, cone_deg: [10, 20], animation: {keys: [{frame: 0}, {frame: 9, direction: [0, 0, 1], position: [0, 5, 9]}, {frame: 12, intensity: [1, 2, 3]}]}}
)";

TEST(Keyframes, MaterialsLightsAndCameraMove) {
  const SceneFile file = tests::parse(kMoving);
  EXPECT_EQ(file.frame_count(), 13);
  const Scene at3 = file.at_frame(3);
  EXPECT_TRUE(at3.is_animated);
  EXPECT_FLOAT_EQ(at3.lights[0].position.z, 3.0F);
  EXPECT_NEAR(std::atan2(at3.lights[0].direction.z, at3.lights[0].direction.x), glm::radians(30.0F),
              1e-6F)
      << "constant speed";
  EXPECT_NEAR(glm::length(at3.lights[0].direction), 1.0F, 1e-6F);
  EXPECT_FLOAT_EQ(at3.materials[0].albedo.x, 0.8F);
  EXPECT_FLOAT_EQ(at3.materials[0].albedo.z, 0.2F);
  EXPECT_FLOAT_EQ(at3.camera.position.x, 0.6F);
  EXPECT_FLOAT_EQ(at3.camera.look_at.y, 0.3F);
  EXPECT_FLOAT_EQ(at3.camera.vertical_fov_deg, 46.0F);
  const Scene at6 = file.at_frame(6);
  EXPECT_FLOAT_EQ(at6.materials[0].emission.y, 2.0F);
  EXPECT_FLOAT_EQ(at6.materials[0].albedo.x, 0.7F) << "back to the material's own at frame 8";
}

TEST(Keyframes, FramesAreFunctionsOfTheirNumber) {
  const SceneFile file = tests::parse(kMoving);
  const base::Hash fifth = file.at_frame(5).hash;
  EXPECT_NE(file.at_frame(6).hash, fifth);
  EXPECT_EQ(file.at_frame(5).hash, fifth);
  EXPECT_EQ(file.at_frame(12).hash, file.at_frame(1000).hash);
  EXPECT_NE(file.at_frame(11).hash, file.at_frame(12).hash);
}

TEST(Keyframes, WhatDoesNotMoveIsShared) {
  const SceneFile file = tests::parse(kMoving);
  EXPECT_EQ(file.at_frame(1).objects[0].mesh, file.at_frame(2).objects[0].mesh);
}

std::string error_with(const std::string& from, const std::string& to) {
  return tests::input_error_of([&] { tests::parse(tests::with(kMoving, from, to)); });
}

TEST(Keyframes, BadKeysAreRefusedWithTheirPlace) {
  EXPECT_EQ(error_with("{frame: 4, albedo: [0.9, 0.5, 0.1]}", "{frame: 4, albedo: 1.5}"),
            "small.yaml:5:86: albedo 1.5 is outside [0, 1]");
  EXPECT_EQ(error_with("{frame: 8, emission: 3}", "{frame: 8, phong: 3}"),
            "small.yaml:5:115: unknown key \"phong\"; known: frame, albedo, emission in "
            "animation key");
  EXPECT_EQ(error_with("{frame: 8, emission", "{frame: 4, emission"),
            "small.yaml:5:112: frame 4 follows frame 4; frames must increase");
  EXPECT_EQ(error_with("{frame: 12, intensity: [1, 2, 3]}", "{frame: 12, cone_deg: [1, 2]}"),
            "small.yaml:9:204: unknown key \"cone_deg\"; known: frame, position, intensity, "
            "direction in animation key");
  EXPECT_EQ(error_with("direction: [0, 0, 1]", "direction: [-1, 0, 0]"),
            "small.yaml:9:5: light \"key\" turns around from frame 0 to frame 9; add a key between "
            "them");
  EXPECT_EQ(error_with("vertical_fov_deg: 60", "vertical_fov_deg: 180"),
            "small.yaml:3:177: vertical_fov_deg 180 is outside (0, 180)");
  EXPECT_EQ(error_with("look_at: [2, 1, 0], vertical_fov_deg: 60", "look_at: [2, 0, -3]"),
            "small.yaml:3:148: look_at is the camera's position");
}

TEST(Keyframes, ACameraMustNotTurnThroughItsUpDirection) {
  EXPECT_EQ(error_with("position: [2, 0, -3], look_at: [2, 1, 0]",
                       "position: [0, 0, 3], look_at: [0, 0, 0]"),
            "small.yaml:3:9: look_at is the camera's position between frames 0 and 10");
  EXPECT_EQ(error_with("position: [2, 0, -3], look_at: [2, 1, 0]",
                       "position: [0, -9, 3], look_at: [0, 0, 0]"),
            "small.yaml:3:9: the camera looks along its up direction between frames 0 and 10; "
            "change up");
}

TEST(Keyframes, PointLightsHaveNoDirection) {
  const std::string point = tests::with(
      kMoving,
      "type: spot, position: [0, 5, 0], direction: [1, 0, 0], intensity: 4, cone_deg: [10, 20]",
      "type: point, position: [0, 5, 0], intensity: 4");
  EXPECT_NE(
      tests::input_error_of([&] {
        tests::parse(point);
      }).find("unknown key \"direction\"; known: frame, position, intensity in animation key"),
      std::string::npos);
}

}  // namespace
}  // namespace renderers::scene
