#include "renderers/clustered_visibility/clipped_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "perception/base/parallel.h"
#include "renderers/element_hierarchy/spherical_triangle.h"
#include "renderers/texel_atlas/world_triangles.h"

namespace renderers::clustered_visibility {

namespace {

using Triangle = std::array<glm::vec3, 3>;

/// A convex polygon; cut from a triangle by two planes it has five corners at most, and one more
/// where rounding bends it.
struct Polygon {
  std::array<glm::vec3, 6> corners{};
  std::size_t count = 0;

  void add(const glm::vec3& corner) { corners[count++] = corner; }
};

/// In world space, m.
std::vector<Triangle> triangles_of(const scene::Scene& scene) {
  const texel_atlas::WorldTriangles world = texel_atlas::world_triangles(scene);
  std::vector<Triangle> triangles;
  triangles.reserve(world.triangles.size());
  for (const texel_atlas::WorldTriangle& triangle : world.triangles) {
    triangles.push_back({triangle.corners[0], triangle.corners[1], triangle.corners[2]});
  }
  return triangles;
}

/// Whether its front is seen from a point: its corners turn counterclockwise.
bool faces(const Triangle& triangle, const glm::vec3& point) {
  const glm::vec3 normal = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  return glm::dot(normal, point - triangle[0]) > 0.0F;
}

/// The part where sign (dot(axis, x) - height) >= 0 (Sutherland and Hodgman 1974, recalled).
Polygon part_of(const Polygon& polygon, const glm::vec3& axis, float height, float sign) {
  Polygon part;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const glm::vec3& a = polygon.corners[i];
    const glm::vec3& b = polygon.corners[(i + 1) % polygon.count];
    const float above_a = sign * (glm::dot(axis, a) - height);
    const float above_b = sign * (glm::dot(axis, b) - height);
    if (above_a >= 0.0F) part.add(a);
    if ((above_a >= 0.0F) != (above_b >= 0.0F)) {
      part.add(a + above_a / (above_a - above_b) * (b - a));
    }
  }
  return part;
}

/// Seen from a map's centre.
struct ClippedPart {
  bool is_all = false;  ///< that is above the horizon
  double solid_angle_sr = 0.0;
};

/// @param clip_m  above 0
ClippedPart clipped_part(const Triangle& triangle, const glm::vec3& center, const glm::vec3& axis,
                         float clip_m) {
  Polygon polygon;
  for (const glm::vec3& corner : triangle) polygon.add(corner - center);
  std::array<float, 3> heights_m{};
  for (std::size_t i = 0; i < 3; ++i) heights_m[i] = glm::dot(axis, polygon.corners[i]);
  const float highest_m = std::ranges::max(heights_m);
  if (highest_m <= 0.0F || std::ranges::min(heights_m) >= clip_m) return {};
  polygon = part_of(part_of(polygon, axis, 0.0F, 1.0F), axis, clip_m, -1.0F);
  ClippedPart part{highest_m < clip_m, 0.0};
  for (std::size_t i = 2; i < polygon.count; ++i) {
    part.solid_angle_sr += element_hierarchy::solid_angle(
        glm::vec3(0.0F), {polygon.corners[0], polygon.corners[i - 1], polygon.corners[i]});
  }
  return part;
}

}  // namespace

ClippedSurfaces clipped_surfaces(const scene::Scene& scene,
                                 const std::vector<AreaLight>& area_lights, float near_m) {
  const std::vector<Triangle> triangles = triangles_of(scene);
  std::vector<ClippedSurfaces> of_maps(area_lights.size());
  base::parallel_for(area_lights.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const AreaLight& area = area_lights[i];
      const float clip_m = std::abs(area.axis.w);
      if (area.position.w == 0.0F || !(clip_m > 0.0F)) continue;
      const glm::vec3 axis(area.axis);
      const glm::vec3 center = glm::vec3(area.position) + near_m * axis;
      for (const Triangle& triangle : triangles) {
        if (area.axis.w < 0.0F && faces(triangle, center)) continue;
        const ClippedPart part = clipped_part(triangle, center, axis, clip_m);
        of_maps[i].triangles += part.is_all ? 1 : 0;
        of_maps[i].hemisphere_share += part.solid_angle_sr / (2.0 * std::numbers::pi);
      }
    }
  });
  const auto maps = std::ranges::count_if(
      area_lights, [](const AreaLight& area) { return area.position.w > 0.0F; });
  ClippedSurfaces sum;
  if (maps == 0) return sum;
  for (const ClippedSurfaces& own : of_maps) {
    sum.triangles += own.triangles;
    sum.hemisphere_share += own.hemisphere_share / static_cast<double>(maps);
  }
  return sum;
}

}  // namespace renderers::clustered_visibility
