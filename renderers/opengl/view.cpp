#include "renderers/opengl/view.h"

#include <cassert>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

namespace renderers::opengl {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// The row of a matrix that gives dot(direction, p - origin) of a point p.
glm::vec4 distance_along(const glm::vec3& direction, const glm::vec3& origin) {
  return {direction, -glm::dot(direction, origin)};
}

}  // namespace

View camera_view(const scene::Camera& camera, int width_px, int height_px,
                 const glm::vec2& offset_px) {
  const auto width = static_cast<float>(width_px);
  const auto height = static_cast<float>(height_px);
  View view;
  view.origin = camera.position;
  view.forward = glm::normalize(camera.look_at - camera.position);
  view.right = glm::normalize(glm::cross(view.forward, camera.up));
  view.up = glm::cross(view.right, view.forward);
  view.half_height = std::tan(0.5F * camera.vertical_fov_deg * kPi / 180.0F);
  view.half_width = view.half_height * width / height;
  view.center = {2.0F * offset_px.x / width * view.half_width,
                 -2.0F * offset_px.y / height * view.half_height};
  return view;
}

glm::mat4 clip_from_world(const View& view, float near_m, float far_m) {
  const glm::vec4 x = distance_along(view.right, view.origin);
  const glm::vec4 y = distance_along(view.up, view.origin);
  const glm::vec4 z = distance_along(view.forward, view.origin);
  const glm::vec4 one(0.0F, 0.0F, 0.0F, 1.0F);
  const glm::vec4& w = view.is_orthographic ? one : z;
  const glm::vec4 depth = view.is_orthographic ? one - z / far_m : near_m * one;
  // Negative y: row 0 is the top of the picture.
  const glm::mat4 rows((x - view.center.x * w) / view.half_width,
                       (y - view.center.y * w) / -view.half_height, depth, w);
  return glm::transpose(rows);
}

View cube_face(const glm::vec3& origin, const glm::mat3& axes, int face) {
  assert(face >= 0 && face < 6);
  const int axis = face / 2;
  View view;
  view.origin = origin;
  view.forward = face % 2 == 0 ? axes[axis] : -axes[axis];
  // Any frame across the axis does; these follow from the axes in cyclic order.
  view.up = axes[(axis + 1) % 3];
  view.right = glm::cross(view.forward, view.up);
  return view;
}

}  // namespace renderers::opengl
