#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderers/light_propagation/light_volume.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::light_propagation {

/// Area that a sample stands for.
enum class SampleArea {
  clipped,  ///< the exact area of the surfaces in its cell that face the same way, shared equally
  count     ///< a cell's face by the number of samples in the cell, whatever surface is in it
};

struct SampleSettings {
  double per_cell_face = 4.0;  ///< samples on a surface as large as a cell's face, at least
  SampleArea area = SampleArea::clipped;
  std::uint64_t seed = 1;
};

/// A point of a surface and the area that it stands for.
struct SurfaceSample {
  ray_tracing::SurfacePoint point;
  float area_m2 = 0.0F;
};

/// Samples on all surfaces, no two that face the same way closer to each other than a bound, thrown
/// like darts: of many places uniform in area each is kept if none before is too near. Their areas
/// are those of the surfaces in the cells of the grid, by six classes of normals; where no dart
/// fell there is one more sample in the middle of the largest piece, so that no area is lost.
///
/// Sources: Koa and Johan 2016, doi:10.1145/2949035.2949043, Sec. 3.2 (Poisson samples in the
/// scene); Cook 1986, "Stochastic Sampling in Computer Graphics", doi:10.1145/7529.8927 (darts).
/// Differs from the paper: areas; it divides a voxel by its number of samples (`count`).
std::vector<SurfaceSample> sample_surfaces(const ray_tracing::RayScene& rays, const Grid& grid,
                                           const SampleSettings& settings);

/// Area of each cell's surfaces by the class of their normals, and where the largest piece is.
struct CellSurface {
  double area_m2 = 0.0;
  glm::dvec3 vector_area_m2{0.0};  ///< sum of area x normal
  double largest_m2 = 0.0;
  glm::dvec3 middle{0.0};      ///< of the largest piece
  std::uint32_t object = 0;    ///< of the largest piece
  std::uint32_t triangle = 0;  ///< of the largest piece
};

/// Classes of normals: the axis they are nearest to, and its side.
inline constexpr std::size_t kNormalClasses = 6;
std::size_t normal_class(const glm::vec3& normal);

/// Triangles cut along the planes of the cells (Sutherland and Hodgman 1974,
/// doi:10.1145/360767.360802). @return [cell][class]
std::vector<CellSurface> cut_surfaces(const ray_tracing::RayScene& rays, const Grid& grid);

}  // namespace renderers::light_propagation
