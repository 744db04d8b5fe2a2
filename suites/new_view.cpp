#include "suites/new_view.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace suites {

renderers::scene::Camera turned_camera(const renderers::scene::Camera& camera) {
  // Rodrigues' rotation of the arm from look_at to the eye.
  const glm::vec3 axis = glm::normalize(camera.up);
  const glm::vec3 arm = camera.position - camera.look_at;
  const float angle_rad = glm::radians(kNewViewAngle_deg);
  const float cosine = glm::cos(angle_rad);
  renderers::scene::Camera turned = camera;
  turned.position = camera.look_at + cosine * arm + glm::sin(angle_rad) * glm::cross(axis, arm) +
                    (1.0F - cosine) * glm::dot(axis, arm) * axis;
  return turned;
}

}  // namespace suites
