#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/opengl/view.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/scene/scene.h"

namespace renderers::opengl {

/// A room with a textured floor, a mirrored and rotated smooth sphere, a glossy box, a triangle
/// without area and an object without uvs.
scene::Scene surface_scene();

/// Ray of a pixel position by the documentation of View, in double precision.
struct OracleRay {
  glm::dvec3 origin;
  glm::dvec3 direction;
  glm::dvec3 view_origin;
};
OracleRay ray_of(const View& view, const glm::ivec2& size_px, const glm::dvec2& position_px);

/// What a pixel should hold; computed in double precision from the triangle that a ray meets.
struct OracleSurface {
  std::uint32_t object = 0;
  std::uint32_t triangle = 0;
  double distance_m = 0.0;  ///< from the view's origin
  glm::dvec3 position{0.0};
  glm::dvec3 geometric_normal{0.0};
  glm::dvec3 shading_normal{0.0};
  glm::vec3 albedo{0.0F};
  int material = 0;
  bool is_glossy = false;
};

/// Nothing where the ray meets nothing.
std::optional<OracleSurface> surface_along(const ray_tracing::RayScene& scene,
                                           const OracleRay& ray);

}  // namespace renderers::opengl
