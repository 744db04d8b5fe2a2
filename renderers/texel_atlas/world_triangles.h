#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/scene/scene.h"

namespace renderers::texel_atlas {

/// A triangle in world space, m; counter-clockwise seen from its front, as in
/// `ray_tracing::RayScene`, whose barycentrics it shares.
struct WorldTriangle {
  std::array<glm::dvec3, 3> corners{};
  std::uint32_t object = 0;    ///< index into Scene::objects
  std::uint32_t triangle = 0;  ///< index into the object's Mesh::triangles

  /// cross(b - a, c - a): twice the area long, towards the front.
  glm::dvec3 scaled_normal() const;
  double area_m2() const;
};

/// The triangles of a scene, object by object.
struct WorldTriangles {
  std::vector<WorldTriangle> triangles;
  std::vector<std::size_t> first;  ///< per object, index of its first triangle

  std::size_t index_of(std::uint32_t object, std::uint32_t triangle) const {
    return first[object] + triangle;
  }
  double area_m2() const;
};

WorldTriangles world_triangles(const scene::Scene& scene);

}  // namespace renderers::texel_atlas
