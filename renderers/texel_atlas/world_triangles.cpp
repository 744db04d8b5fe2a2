#include "renderers/texel_atlas/world_triangles.h"

#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace renderers::texel_atlas {

glm::dvec3 WorldTriangle::scaled_normal() const {
  return glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
}

double WorldTriangle::area_m2() const { return 0.5 * glm::length(scaled_normal()); }

double WorldTriangles::area_m2() const {
  double sum = 0.0;
  for (const WorldTriangle& triangle : triangles) sum += triangle.area_m2();
  return sum;
}

WorldTriangles world_triangles(const scene::Scene& scene) {
  WorldTriangles world;
  world.triangles.reserve(scene.face_count());
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    world.first.push_back(world.triangles.size());
    const scene::Object& source = scene.objects[object];
    const bool mirrors = glm::determinant(glm::mat3(source.to_world)) < 0.0F;
    for (std::uint32_t i = 0; i < source.mesh->triangles.size(); ++i) {
      glm::uvec3 index = source.mesh->triangles[i];
      if (mirrors) std::swap(index.y, index.z);
      WorldTriangle& triangle = world.triangles.emplace_back();
      triangle.object = object;
      triangle.triangle = i;
      for (int corner = 0; corner < 3; ++corner) {
        const glm::vec4 position(source.mesh->positions[index[corner]], 1.0F);
        // Rounded as rays see it.
        triangle.corners[static_cast<std::size_t>(corner)] =
            glm::dvec3(glm::vec3(source.to_world * position));
      }
    }
  }
  return world;
}

}  // namespace renderers::texel_atlas
