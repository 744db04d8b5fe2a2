#include "renderers/ray_tracing/camera_rays.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"

namespace renderers::ray_tracing {

CameraRays::CameraRays(const scene::Camera& camera, int width_px, int height_px)
    : position_(camera.position) {
  const glm::vec3 forward = glm::normalize(camera.look_at - camera.position);
  const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::vec3 up = glm::cross(right, forward);
  const float half_height = std::tan(0.5F * camera.vertical_fov_deg * kPi / 180.0F);
  const float pixel = 2.0F * half_height / static_cast<float>(height_px);
  const float half_width = 0.5F * pixel * static_cast<float>(width_px);
  corner_ = forward - half_width * right + half_height * up;
  step_right_ = pixel * right;
  step_down_ = -pixel * up;
}

Ray CameraRays::through(float px, float py) const {
  return {position_, glm::normalize(corner_ + px * step_right_ + py * step_down_)};
}

}  // namespace renderers::ray_tracing
