#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/scene/scene.h"

namespace renderers::opengl {

/// Where a picture of the scene is taken from: a camera, a face around a light, or parallel rays.
/// A pixel (px right, py down, pixel centres at .5) of a width x height picture looks along
///   forward + (center.x + (2 px / width - 1) half_width) right
///           + (center.y - (2 py / height - 1) half_height) up.
struct View {
  glm::vec3 origin{0.0F};
  glm::vec3 right{1.0F, 0.0F, 0.0F};  ///< unit length, as `up` and `forward`
  glm::vec3 up{0.0F, 1.0F, 0.0F};
  glm::vec3 forward{0.0F, 0.0F, -1.0F};
  float half_width = 1.0F;  ///< tangent of the half angle; metres if orthographic
  float half_height = 1.0F;
  glm::vec2 center{0.0F};        ///< of the picture, in the units of half_width and half_height
  bool is_orthographic = false;  ///< rays along `forward` from the plane through the origin
};

/// The view of `scene::camera_ray_direction`.
/// @param offset_px  moves every ray by so many pixels to the right and down
View camera_view(const scene::Camera& camera, int width_px, int height_px,
                 const glm::vec2& offset_px = glm::vec2(0.0F));

/// Clip space from world space: reversed, unbounded depth (1 at `near_m`, 0 at infinity; linear to
/// `far_m` if orthographic), clip control zero-to-one, row 0 of the target is the top of the
/// picture.
/// @param near_m  > 0, perspective only: what is nearer is cut off
glm::mat4 clip_from_world(const View& view, float near_m, float far_m);

/// Faces of a cube around a point, each 90 degrees wide: forward is +x -x +y -y +z -z of `axes`
/// (columns: right, up, forward of the frame).
View cube_face(const glm::vec3& origin, const glm::mat3& axes, int face);

}  // namespace renderers::opengl
