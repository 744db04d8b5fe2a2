#include "renderers/scene/pose.h"

#include "renderers/scene/keyframes.h"

#include "tests/expect_input_error.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

namespace renderers::scene {
namespace {

void expect_near(const glm::vec3& a, const glm::vec3& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-5F) << "component " << i;
}

glm::vec3 moved(const Pose& pose, const glm::vec3& point) {
  return glm::vec3(matrix_of(pose) * glm::vec4(point, 1.0F));
}

base::Node node_of(const char* text) { return base::parse_document(text, "pose.yaml"); }

TEST(Rotation, TurnsRightHanded) {
  expect_near(rotation_from_degrees({0, 90, 0}) * glm::vec3(0, 0, 1), {1, 0, 0});
  expect_near(rotation_from_degrees({90, 0, 0}) * glm::vec3(0, 1, 0), {0, 0, 1});
  expect_near(rotation_from_degrees({0, 0, 90}) * glm::vec3(1, 0, 0), {0, 1, 0});
}

TEST(Rotation, IsByXThenYThenZ) {
  // y goes to z by x, z to x by y; z then y would end at -x or stay elsewhere.
  expect_near(rotation_from_degrees({90, 90, 0}) * glm::vec3(0, 1, 0), {1, 0, 0});
  expect_near(rotation_from_degrees({90, 90, 90}) * glm::vec3(0, 1, 0), {0, 1, 0});
}

TEST(Matrix, ScalesThenRotatesThenMoves) {
  const Pose pose{{10, 0, 0}, rotation_from_degrees({0, 90, 0}), {1, 1, 3}};
  expect_near(moved(pose, {0, 0, 1}), {13, 0, 0});
}

Track<Pose> two_keys() {
  const Pose rest;
  return {{{10, rest}, {20, {{2, 4, 6}, rotation_from_degrees({0, 90, 0}), {3, 1, 1}}}}, true};
}

Pose pose_at(int frame) { return two_keys().at(frame, mix_poses); }

TEST(PoseAt, InterpolatesHalfWay) {
  const Pose pose = pose_at(15);
  expect_near(pose.translate, {1, 2, 3});
  expect_near(pose.scale, {2, 1, 1});
  expect_near(pose.rotation * glm::vec3(0, 0, 1), glm::normalize(glm::vec3(1, 0, 1)));
}

TEST(PoseAt, RotatesAtConstantSpeed) {
  const glm::vec3 direction = pose_at(13).rotation * glm::vec3(0, 0, 1);
  EXPECT_NEAR(std::atan2(direction.x, direction.z), glm::radians(27.0F), 1e-5F);
}

TEST(PoseAt, HoldsBeforeTheFirstAndAfterTheLastKey) {
  expect_near(pose_at(0).translate, {0, 0, 0});
  expect_near(pose_at(20).translate, {2, 4, 6});
  expect_near(pose_at(500).translate, {2, 4, 6});
}

std::vector<Key<Pose>> keys_of(const char* text, const Pose& rest) {
  const base::Node node = node_of(text);
  base::MapReader reader(node, "object");
  return read_track(reader, rest, read_pose).keys;
}

TEST(ReadAnimation, MissingValuesComeFromTheTransform) {
  const Pose rest = read_transform(node_of("{translate: [1, 2, 3], scale: 2}"));
  const auto keys =
      keys_of("{animation: {keys: [{frame: 0}, {frame: 60, translate: [4, 2, 3]}]}}", rest);
  ASSERT_EQ(keys.size(), 2U);
  expect_near(keys[0].value.translate, {1, 2, 3});
  expect_near(keys[1].value.translate, {4, 2, 3});
  expect_near(keys[1].value.scale, {2, 2, 2});
}

TEST(ReadAnimation, FramesMustIncrease) {
  EXPECT_EQ(tests::input_error_of(
                [] { keys_of("{animation: {keys: [{frame: 5}, {frame: 5}]}}", Pose{}); }),
            "pose.yaml:1:41: frame 5 follows frame 5; frames must increase");
  EXPECT_EQ(tests::input_error_of([] { keys_of("{animation: {keys: []}}", Pose{}); }),
            "pose.yaml:1:20: animation has no keys");
  EXPECT_NE(tests::input_error_of([] { keys_of("{animation: {keys: [{frame: -1}]}}", Pose{}); }),
            "no error");
}

TEST(ReadTransform, ScaleMustBePositive) {
  EXPECT_EQ(tests::input_error_of([] { read_transform(node_of("{scale: 0}")); }),
            "pose.yaml:1:9: scale 0 must be greater than 0");
  EXPECT_EQ(tests::input_error_of([] { read_transform(node_of("{scale: [1, -2, 1]}")); }),
            "pose.yaml:1:9: scale -2 must be greater than 0");
}

}  // namespace
}  // namespace renderers::scene
