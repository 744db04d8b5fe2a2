#pragma once

#include <glm/vec3.hpp>

#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/scene/scene.h"

namespace renderers::ray_tracing {

/// The rays of `scene::camera_ray_direction` with everything but the pixel worked out beforehand.
class CameraRays {
 public:
  CameraRays(const scene::Camera& camera, int width_px, int height_px);
  /// @param px, py  pixels from the left and the top edge
  Ray through(float px, float py) const;

 private:
  glm::vec3 position_;
  glm::vec3 corner_;      ///< towards the top left corner of the image plane at distance 1
  glm::vec3 step_right_;  ///< one pixel on that plane
  glm::vec3 step_down_;
};

}  // namespace renderers::ray_tracing
