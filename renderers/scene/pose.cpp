#include "renderers/scene/pose.h"

#include "renderers/scene/value_reader.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <limits>

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

/// The pose keys of a map; what is missing stays as in `rest`.
Pose read_pose(base::MapReader& reader, const Pose& rest) {
  Pose pose = rest;
  if (const auto* node = reader.find("translate")) pose.translate = read_vec3(*node, "translate");
  if (const auto* node = reader.find("rotate_deg")) {
    pose.rotation = rotation_from_degrees(read_vec3(*node, "rotate_deg"));
  }
  if (const auto* node = reader.find("scale")) pose.scale = read_scale(*node);
  return pose;
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

Pose pose_at(const std::vector<PoseKey>& keys, int frame) {
  if (frame <= keys.front().frame) return keys.front().pose;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const PoseKey& before = keys[i - 1];
    const PoseKey& after = keys[i];
    if (frame >= after.frame) continue;
    const float t =
        static_cast<float>(frame - before.frame) / static_cast<float>(after.frame - before.frame);
    return {glm::mix(before.pose.translate, after.pose.translate, t),
            glm::slerp(before.pose.rotation, after.pose.rotation, t),
            glm::mix(before.pose.scale, after.pose.scale, t)};
  }
  return keys.back().pose;
}

Pose read_transform(const base::Node& node) {
  base::MapReader reader(node, "transform");
  const Pose pose = read_pose(reader, Pose{});
  reader.finish();
  return pose;
}

std::vector<PoseKey> read_animation(const base::Node& node, const Pose& rest) {
  base::MapReader reader(node, "animation");
  const base::Node& list = reader.require("keys");
  reader.finish();
  std::vector<PoseKey> keys;
  for (const base::Node& key_node : list.list("keys")) {
    base::MapReader key_reader(key_node, "animation key");
    const base::Node& frame_node = key_reader.require("frame");
    const int frame = read_count(frame_node, "frame", 0, std::numeric_limits<int>::max() - 1);
    if (!keys.empty() && frame <= keys.back().frame) {
      throw base::InputError(
          frame_node.place(),
          fmt::format("frame {} follows frame {}; frames must increase", frame, keys.back().frame));
    }
    keys.push_back({frame, read_pose(key_reader, rest)});
    key_reader.finish();
  }
  if (keys.empty()) throw base::InputError(list.place(), "animation has no keys");
  return keys;
}

}  // namespace renderers::scene
