#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "renderers/scene/scene.h"

namespace renderers::shadow_maps {

/// A disc on a surface, std430 (`ScenePoint` of shaders/splat_points.comp.glsl).
struct ScenePoint {
  glm::vec4 position;  ///< xyz: world space, m; w: radius, m
  glm::vec4 normal;    ///< xyz: geometric, unit length, front side; w: 0
};

/// Sets of points that each cover the scene: density proportional to area, radius such that the
/// discs of a set have the scene's area together.
///
/// Without random numbers. The scene's area is cut into sets x points_per_set equal pieces along
/// the list of triangles; each run of `sets` pieces gives every set one point, so that a set is
/// stratified over the triangles; which set takes which piece of a run is the order of the sets'
/// radical inverses, so that sets of neighbouring index differ. Positions within triangles follow
/// the set's run of an R2 sequence (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
/// Sequences", recalled). The points of a deformed scene move with it as far as its areas keep
/// their shares.
///
/// @param sets            >= 1
/// @param points_per_set  >= 1
/// @return points_per_set of set 0, then of set 1 and so on; empty if the scene has no area
std::vector<ScenePoint> scene_points(const scene::Scene& scene, int sets, int points_per_set);

/// The same sets, made once and moved with the scene's triangles: points keep their triangle and
/// their place on it, whatever areas become.
class DealtPoints {
 public:
  DealtPoints(const scene::Scene& scene, int sets, int points_per_set);

  /// Moves the points to where their triangles are now. Those of objects whose list of triangles
  /// has changed, or that are gone, have no triangle to move with: they stay behind.
  /// @return how many
  std::size_t move(const scene::Scene& scene);
  /// In the order of `scene_points`.
  const std::vector<ScenePoint>& points() const { return points_; }

 private:
  struct Place {
    int object = 0;
    int triangle = 0;        ///< of the object
    glm::vec2 weight{0.0F};  ///< of its second and third corner
  };

  std::vector<std::vector<glm::uvec3>> triangles_;  ///< of the objects, when the points were dealt
  std::vector<ScenePoint> points_;
  std::vector<Place> places_;
};

/// A point on a triangle, for those who ask for its material.
struct SurfacePoint {
  glm::vec3 position{0.0F};  ///< world space, m
  int triangle = 0;          ///< among the scene's: objects in order, their triangles in order
  /// Place of the point in an order of the set whose every prefix and run is spread over the scene.
  int place = 0;
};

/// Points that stand for the same area each.
struct SurfacePoints {
  double area_m2 = 0.0;              ///< of the scene, one side
  std::vector<SurfacePoint> points;  ///< along the list of triangles
};

/// One set of points, density proportional to area: the list of triangles is cut into `count`
/// equal pieces, and each has its point at the same share of the piece, which differs from set to
/// set; positions within triangles are those of the sets' runs of an R2 sequence. Places are the
/// order of radical inverses. A set is the same however many there are.
///
/// @param set    >= 0
/// @param count  >= 1
/// @return no points if the scene has no area
SurfacePoints surface_points(const scene::Scene& scene, int set, int count);

}  // namespace renderers::shadow_maps
