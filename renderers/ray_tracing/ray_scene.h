#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/contract/stage_timer.h"
#include "renderers/ray_tracing/ray_offset.h"
#include "renderers/scene/scene.h"

namespace renderers::ray_tracing {

/// Half line or segment: points origin + t direction, 0 < t < t_max. Distances are in units of the
/// direction's length.
struct Ray {
  glm::vec3 origin{0.0F};
  glm::vec3 direction{0.0F, 0.0F, 1.0F};
  float t_max = std::numeric_limits<float>::infinity();
};

/// A point on a triangle of the scene, world space.
struct SurfacePoint {
  std::uint32_t object = 0;      ///< index into Scene::objects
  std::uint32_t triangle = 0;    ///< index into the object's Mesh::triangles
  glm::vec2 barycentrics{0.0F};  ///< weights of the second and third vertex
  glm::vec3 position{0.0F};
  glm::vec3 position_error{0.0F};    ///< bound per coordinate, see ray_offset.h
  glm::vec3 geometric_normal{0.0F};  ///< unit length, front side (counter-clockwise)
  glm::vec3 shading_normal{0.0F};    ///< unit length, on the same side as the geometric one
  glm::vec2 uv{0.0F};                ///< (0, 0) if the mesh has none
  int material = 0;                  ///< index into Scene::materials
};

/// Where a ray first meets the scene.
struct Hit : SurfacePoint {
  float t = 0.0F;  ///< ray parameter
};

/// A ray that leaves a surface point without meeting that surface again.
inline Ray ray_from(const SurfacePoint& point, const glm::vec3& direction) {
  return {
      offset_from_surface(point.position, point.position_error, point.geometric_normal, direction),
      direction};
}

/// The segment from a surface point to a point in space, short of its end.
inline Ray segment_to(const SurfacePoint& from, const glm::vec3& to) {
  const glm::vec3 origin = offset_from_surface(from.position, from.position_error,
                                               from.geometric_normal, to - from.position);
  return {origin, to - origin, kSegmentEnd};
}

/// The segment between two surface points, short of both surfaces.
inline Ray segment_to(const SurfacePoint& from, const SurfacePoint& to) {
  return segment_to(from, offset_from_surface(to.position, to.position_error, to.geometric_normal,
                                              from.position - to.position));
}

/// Most rays of a packet.
inline constexpr std::size_t kPacketRays = 16;

/// How the rays of a packet lie.
enum class RayOrder {
  beside,    ///< beside each other: they meet the same boxes of the BVH
  scattered  ///< each goes its own way
};

/// One of all the places where a ray meets the scene.
struct LineHit {
  float t = 0.0F;                ///< ray parameter
  std::uint32_t ray = 0;         ///< index into the rays asked about
  std::uint32_t object = 0;      ///< index into Scene::objects
  std::uint32_t triangle = 0;    ///< index into the object's Mesh::triangles
  glm::vec2 barycentrics{0.0F};  ///< weights of the second and third vertex
  bool looks_back = false;       ///< the triangle's front side looks towards the ray's origin
};

/// What a scene is asked for.
enum class RayQueries {
  first_hits,
  all_hits  ///< `all_hits` as well
};

/// The triangles of a scene in world space, ready for rays. Immutable; rays may be traced from any
/// number of threads.
///
/// Source: Wald et al. 2014, "Embree: A Kernel Framework for Efficient CPU Ray Tracing",
/// doi:10.1145/2601097.2601199, in its robust mode.
class RayScene {
 public:
  /// Stages: `triangles` (world space) and `bvh`, under whatever stage is open.
  /// @param scene  must live as long as this
  /// @throws base::DeviceError if Embree fails or memory runs out
  RayScene(const scene::Scene& scene, StageTimer& timer,
           RayQueries queries = RayQueries::first_hits);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Refers to another scene from here on, which differs from the one before in its camera and its
  /// frame alone. @param scene  must live as long as this
  void follow(const scene::Scene& scene);

  /// The first triangle along the ray, both sides. @return false if there is none
  bool intersect(const Ray& ray, Hit& hit) const;
  /// The point where a ray first meets the scene, as `nearest` found it.
  Hit hit_at(const LineHit& found) const;
  /// The same without the point there, for those who want to know which triangle alone.
  /// @param hit  receives; its `ray` is 0
  bool nearest(const Ray& ray, LineHit& hit) const;
  /// The same for a packet of rays; on edges that triangles share it may name another of them than
  /// a single query. The order changes nothing but the time.
  /// @return bit i is set if ray i meets a triangle
  /// @param rays  at most kPacketRays
  /// @param hits  receives hit i of ray i, at least as many
  std::uint32_t nearest(std::span<const Ray> rays, std::span<LineHit> hits,
                        RayOrder order = RayOrder::beside) const;
  /// True if any triangle lies on the ray.
  bool is_occluded(const Ray& ray) const;
  /// The same for a packet of rays: bit i is set if ray i is occluded. Rays from one point take 0.6
  /// of the time of single queries (measured, AVX2). @param rays  at most kPacketRays
  std::uint32_t occluded_mask(std::span<const Ray> rays) const;

  /// Every triangle along each ray, in no order, for parallel or otherwise coherent rays; a
  /// triangle may be reported more than once. Only with RayQueries::all_hits.
  /// @param rays  at most kPacketRays
  /// @param hits  receives the hits after those it holds
  /// Source: Gribble, Wald, Amstutz 2016, "Implementing Node Culling Multi-Hit BVH Traversal in
  /// Embree", JCGT 5(4), of which this is the plain variant: a filter that turns down every hit.
  void all_hits(std::span<const Ray> rays, std::vector<LineHit>& hits) const;

  /// @param barycentrics  weights of the second and third vertex, sum in [0, 1]
  SurfacePoint point_on_triangle(std::uint32_t object, std::uint32_t triangle,
                                 const glm::vec2& barycentrics) const;
  /// Vertices of a triangle in world space, as rays meet them, counter-clockwise from the front.
  const std::array<glm::vec3, 3>& triangle_corners(std::uint32_t object,
                                                   std::uint32_t triangle) const;
  /// Area of a triangle in world space, m2.
  float triangle_area_m2(std::uint32_t object, std::uint32_t triangle) const;

  const scene::Scene& scene() const;
  std::size_t triangle_count() const;
  /// Bounding box of all triangles; min > max if there are none.
  const glm::vec3& box_min() const;
  const glm::vec3& box_max() const;
  /// Bytes of Embree's structures and of the world-space triangles.
  std::int64_t memory_bytes() const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace renderers::ray_tracing
