#pragma once

#include "perception/base/document.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace renderers::scene {

/// Placement of an object: scaled, then rotated, then moved.
struct Pose {
  glm::vec3 translate{0.0F};  ///< metres
  glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
  glm::vec3 scale{1.0F};  ///< each > 0
};

struct PoseKey {
  int frame = 0;
  Pose pose;
};

/// Rotation by x, then y, then z degrees about the fixed world axes: Rz Ry Rx.
glm::quat rotation_from_degrees(const glm::vec3& degrees);

/// Object to world: translate * rotate * scale.
glm::mat4 matrix_of(const Pose& pose);

/// Pose at a frame: translation and scale are interpolated linearly, rotation by slerp along the
/// shorter arc; frames outside the keys hold the nearest key.
/// @param keys  at least one, frames strictly increasing
Pose pose_at(const std::vector<PoseKey>& keys, int frame);

/// Reads {translate, rotate_deg, scale}; all may be missing.
/// @throws base::InputError for unknown keys and scales <= 0
Pose read_transform(const base::Node& node);

/// Reads {keys: [{frame, translate, rotate_deg, scale}, ...]}; what a key leaves out comes from
/// `rest`. @throws base::InputError unless frames are whole, >= 0 and strictly increasing
std::vector<PoseKey> read_animation(const base::Node& node, const Pose& rest);

}  // namespace renderers::scene
