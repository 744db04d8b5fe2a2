#pragma once

#include "perception/base/document.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace renderers::scene {

/// Placement of an object: scaled, then rotated, then moved.
struct Pose {
  glm::vec3 translate{0.0F};  ///< metres
  glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
  glm::vec3 scale{1.0F};  ///< each > 0
};

/// Rotation by x, then y, then z degrees about the fixed world axes: Rz Ry Rx.
glm::quat rotation_from_degrees(const glm::vec3& degrees);

/// Object to world: translate * rotate * scale.
glm::mat4 matrix_of(const Pose& pose);

/// Translation and scale are mixed linearly, rotation by slerp along the shorter arc.
Pose mix_poses(const Pose& a, const Pose& b, float t);

/// Reads {translate, rotate_deg, scale}; all may be missing.
/// @throws base::InputError for unknown keys and scales <= 0
Pose read_transform(const base::Node& node);

/// The pose keys {translate, rotate_deg, scale} of a map; what is missing stays as in `rest`.
Pose read_pose(base::MapReader& reader, const Pose& rest);

}  // namespace renderers::scene
