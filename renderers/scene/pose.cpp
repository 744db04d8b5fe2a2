#include "renderers/scene/pose.h"

#include "renderers/scene/value_reader.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace renderers::scene {
namespace {

glm::vec3 read_scale(const base::Node& node) {
  if (!node.is_list()) return glm::vec3(read_positive(node, "scale"));
  const glm::vec3 scale = read_vec3(node, "scale");
  for (int i = 0; i < 3; ++i) {
    if (!(scale[i] > 0.0F)) {
      throw base::InputError(node.place(),
                             fmt::format("scale {} must be greater than 0", scale[i]));
    }
  }
  return scale;
}

}  // namespace

glm::quat rotation_from_degrees(const glm::vec3& degrees) {
  const glm::vec3 radians = glm::radians(degrees);
  const glm::quat x = glm::angleAxis(radians.x, glm::vec3(1.0F, 0.0F, 0.0F));
  const glm::quat y = glm::angleAxis(radians.y, glm::vec3(0.0F, 1.0F, 0.0F));
  const glm::quat z = glm::angleAxis(radians.z, glm::vec3(0.0F, 0.0F, 1.0F));
  return z * y * x;
}

glm::mat4 matrix_of(const Pose& pose) {
  const glm::mat4 moved = glm::translate(glm::mat4(1.0F), pose.translate);
  return glm::scale(moved * glm::mat4_cast(pose.rotation), pose.scale);
}

Pose mix_poses(const Pose& a, const Pose& b, float t) {
  return {glm::mix(a.translate, b.translate, t), glm::slerp(a.rotation, b.rotation, t),
          glm::mix(a.scale, b.scale, t)};
}

Pose read_pose(base::MapReader& reader, const Pose& rest) {
  Pose pose = rest;
  if (const auto* node = reader.find("translate")) pose.translate = read_vec3(*node, "translate");
  if (const auto* node = reader.find("rotate_deg")) {
    pose.rotation = rotation_from_degrees(read_vec3(*node, "rotate_deg"));
  }
  if (const auto* node = reader.find("scale")) pose.scale = read_scale(*node);
  return pose;
}

Pose read_transform(const base::Node& node) {
  base::MapReader reader(node, "transform");
  const Pose pose = read_pose(reader, Pose{});
  reader.finish();
  return pose;
}

}  // namespace renderers::scene
