#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/element_hierarchy/patch_vertices.h"
#include "renderers/element_hierarchy/radiosity_solver.h"

namespace renderers::element_hierarchy {

enum class Shading {
  flat,   ///< one value per leaf
  smooth  ///< Gouraud: linear between the vertices
};

/// Irradiance of a solution at surface points, as it is shown: without point and spot lights, which
/// no link carries.
class ShownLight {
 public:
  /// @param solution  must live as long as this
  ShownLight(const Solution& solution, Shading shading);
  /// Smooth. @param vertices  of the solution's tree
  ShownLight(const Solution& solution, const PatchVertices& vertices);

  struct Irradiance {
    glm::vec3 direct{0.0F};    ///< W/m2, from emission and environment
    glm::vec3 indirect{0.0F};  ///< W/m2, reflected before
  };
  /// @param towards  any length, which side  @return 0 for sides without light
  Irradiance at(const ray_tracing::SurfacePoint& point, const glm::vec3& towards) const;

  /// Radiance that a surface reflects by its Lambert lobe, all light together, W/(m2 sr).
  /// @param towards  away from the surface
  glm::vec3 reflected(const ray_tracing::SurfacePoint& point, const glm::vec3& towards) const;

 private:
  /// @param vertices  null: flat
  ShownLight(const Solution& solution, const PatchVertices* vertices);

  const Solution& solution_;
  /// Per leaf, at its corners; one entry if flat.
  std::vector<std::array<Irradiance, 3>> corners_;
};

}  // namespace renderers::element_hierarchy
