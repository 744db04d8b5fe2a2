#include "renderers/light_propagation/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/piecewise_distribution.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::light_propagation {

namespace {

/// Places tried for each that a full packing could keep.
constexpr double kTries = 8.0;
/// Least cosine between normals of samples that keep their distance.
constexpr float kSameWay = 0.5F;

using Polygon = std::vector<glm::dvec3>;

/// A little in front of a surface: one that lies in the plane between two cells belongs to the cell
/// that it faces, however its points are rounded.
glm::vec3 in_front(const ray_tracing::SurfacePoint& point, const Grid& grid) {
  constexpr float kStep = 1e-3F;
  return point.position + kStep * grid.cell_m * point.geometric_normal;
}

/// The part of a convex polygon on one side of a plane across an axis.
Polygon clip(const Polygon& polygon, int axis, double at, bool keeps_greater) {
  Polygon kept;
  const auto inside = [&](const glm::dvec3& p) {
    return keeps_greater ? p[axis] >= at : p[axis] <= at;
  };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3& a = polygon[i];
    const glm::dvec3& b = polygon[(i + 1) % polygon.size()];
    if (inside(a)) kept.push_back(a);
    if (inside(a) != inside(b))
      kept.push_back(glm::mix(a, b, (at - a[axis]) / (b[axis] - a[axis])));
  }
  return kept;
}

struct Piece {
  double area_m2 = 0.0;
  glm::dvec3 middle{0.0};
};

Piece measure(const Polygon& polygon) {
  Piece piece;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const glm::dvec3& a = polygon[0];
    const double area_m2 = 0.5 * glm::length(glm::cross(polygon[i - 1] - a, polygon[i] - a));
    piece.area_m2 += area_m2;
    piece.middle += area_m2 * (a + polygon[i - 1] + polygon[i]) / 3.0;
  }
  if (piece.area_m2 > 0.0) piece.middle /= piece.area_m2;
  return piece;
}

class SurfaceCutter {
 public:
  SurfaceCutter(const Grid& grid, std::vector<CellSurface>& cells) : grid_(grid), cells_(cells) {}

  /// Cuts a triangle by slabs of cells along one axis after the other.
  void cut(const Polygon& triangle, const glm::vec3& normal, std::uint32_t object,
           std::uint32_t index) {
    object_ = object;
    triangle_ = index;
    normal_ = normal;
    class_ = normal_class(normal);
    cut_axis(triangle, 0, glm::ivec3(0));
  }

 private:
  void cut_axis(const Polygon& polygon, int axis, glm::ivec3 cell) {
    if (polygon.size() < 3) return;
    if (axis == 3) {
      add(polygon, cell);
      return;
    }
    double least = polygon[0][axis];
    double greatest = least;
    for (const glm::dvec3& p : polygon) {
      least = std::min(least, p[axis]);
      greatest = std::max(greatest, p[axis]);
    }
    const int first = slab(least, axis);
    const int last = slab(greatest, axis);
    for (int i = first; i <= last; ++i) {
      cell[axis] = i;
      Polygon part = polygon;
      if (i > first) part = clip(part, axis, plane(i, axis), true);
      if (i < last) part = clip(part, axis, plane(i + 1, axis), false);
      cut_axis(part, axis + 1, cell);
    }
  }

  int slab(double at, int axis) const {
    const double place =
        (at - static_cast<double>(grid_.corner[axis])) / static_cast<double>(grid_.cell_m);
    return std::clamp(static_cast<int>(std::floor(place)), 0, grid_.size[axis] - 1);
  }
  double plane(int slab_index, int axis) const {
    return static_cast<double>(grid_.corner[axis]) + slab_index * static_cast<double>(grid_.cell_m);
  }

  void add(const Polygon& polygon, const glm::ivec3& cell) {
    const Piece piece = measure(polygon);
    CellSurface& surface = cells_[grid_.index(cell) * kNormalClasses + class_];
    surface.area_m2 += piece.area_m2;
    surface.vector_area_m2 += piece.area_m2 * normal_;
    if (piece.area_m2 <= surface.largest_m2) return;
    surface.largest_m2 = piece.area_m2;
    surface.middle = piece.middle;
    surface.object = object_;
    surface.triangle = triangle_;
  }

  const Grid& grid_;
  std::vector<CellSurface>& cells_;
  std::uint32_t object_ = 0;
  std::uint32_t triangle_ = 0;
  std::size_t class_ = 0;
  glm::dvec3 normal_{0.0};
};

/// Calls body(object, triangle) for every triangle with an area.
template <typename Body>
void for_each_triangle(const ray_tracing::RayScene& rays, const Body& body) {
  const auto& objects = rays.scene().objects;
  for (std::uint32_t object = 0; object < objects.size(); ++object) {
    const auto count = static_cast<std::uint32_t>(objects[object].mesh->triangles.size());
    for (std::uint32_t triangle = 0; triangle < count; ++triangle) {
      if (rays.triangle_area_m2(object, triangle) > 0.0F) body(object, triangle);
    }
  }
}

/// Darts in cubes as wide as their distance.
class Darts {
 public:
  explicit Darts(float distance_m) : distance_m_(distance_m) {}

  /// Keeps the place if none before is too near. @return whether it was kept
  bool keep(const glm::vec3& position, const glm::vec3& normal) {
    const glm::ivec3 own(glm::floor(position / distance_m_));
    for (int i = 0; i < 27; ++i) {
      const auto found = cubes_.find(key(own + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1));
      if (found == cubes_.end()) continue;
      for (const auto& [other, other_normal] : found->second) {
        if (glm::dot(normal, other_normal) < kSameWay) continue;
        if (glm::distance(position, other) < distance_m_) return false;
      }
    }
    cubes_[key(own)].emplace_back(position, normal);
    return true;
  }

 private:
  static std::uint64_t key(const glm::ivec3& cube) {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      hash = ray_tracing::hash_combine(hash, static_cast<std::uint32_t>(cube[axis]));
    }
    return hash;
  }

  float distance_m_;
  std::unordered_map<std::uint64_t, std::vector<std::pair<glm::vec3, glm::vec3>>> cubes_;
};

std::vector<SurfaceSample> throw_darts(const ray_tracing::RayScene& rays, float distance_m,
                                       std::uint64_t seed) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> triangles;
  std::vector<double> areas;
  for_each_triangle(rays, [&](std::uint32_t object, std::uint32_t triangle) {
    triangles.emplace_back(object, triangle);
    areas.push_back(static_cast<double>(rays.triangle_area_m2(object, triangle)));
  });
  std::vector<SurfaceSample> samples;
  const ray_tracing::PiecewiseDistribution choice(areas);
  if (choice.total() <= 0.0) return samples;
  const double wanted = choice.total() / static_cast<double>(distance_m * distance_m);
  Darts darts(distance_m);
  const auto tries = static_cast<std::uint32_t>(std::ceil(kTries * wanted));
  for (std::uint32_t i = 0; i < tries; ++i) {
    const glm::vec4 u =
        ray_tracing::SampleSequence(ray_tracing::SequenceKind::sobol, seed, i).next();
    const auto& [object, triangle] = triangles[choice.choose(u.x).index];
    const auto point =
        rays.point_on_triangle(object, triangle, ray_tracing::uniform_triangle({u.y, u.z}));
    if (darts.keep(point.position, point.geometric_normal)) samples.push_back({point, 0.0F});
  }
  return samples;
}

/// Barycentrics of a point on a triangle, kept inside it.
glm::vec2 barycentrics_of(const ray_tracing::RayScene& rays, const CellSurface& surface) {
  const auto corner = [&](const glm::vec2& at) {
    return glm::dvec3(rays.point_on_triangle(surface.object, surface.triangle, at).position);
  };
  const glm::dvec3 origin = corner({0, 0});
  const glm::dvec3 a = corner({1, 0}) - origin;
  const glm::dvec3 b = corner({0, 1}) - origin;
  const glm::dvec3 p = surface.middle - origin;
  const double aa = glm::dot(a, a);
  const double bb = glm::dot(b, b);
  const double ab = glm::dot(a, b);
  const double by = aa * bb - ab * ab;
  const double u = std::clamp((glm::dot(p, a) * bb - glm::dot(p, b) * ab) / by, 0.0, 1.0);
  const double v = std::clamp((glm::dot(p, b) * aa - glm::dot(p, a) * ab) / by, 0.0, 1.0 - u);
  return {static_cast<float>(u), static_cast<float>(v)};
}

}  // namespace

std::size_t normal_class(const glm::vec3& normal) {
  const glm::vec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return 2 * static_cast<std::size_t>(axis) + (normal[axis] > 0.0F ? 1 : 0);
}

std::vector<CellSurface> cut_surfaces(const ray_tracing::RayScene& rays, const Grid& grid) {
  std::vector<CellSurface> cells(grid.cell_count() * kNormalClasses);
  SurfaceCutter cutter(grid, cells);
  for_each_triangle(rays, [&](std::uint32_t object, std::uint32_t triangle) {
    const auto first = rays.point_on_triangle(object, triangle, {0, 0});
    const auto corner = [&](const glm::vec2& at) {
      return glm::dvec3(in_front(rays.point_on_triangle(object, triangle, at), grid));
    };
    const Polygon corners{corner({0, 0}), corner({1, 0}), corner({0, 1})};
    cutter.cut(corners, first.geometric_normal, object, triangle);
  });
  return cells;
}

std::vector<SurfaceSample> sample_surfaces(const ray_tracing::RayScene& rays, const Grid& grid,
                                           const SampleSettings& settings) {
  // So many tries at a distance d leave about 0.6 / d^2 darts on a plane.
  constexpr double kDensity = 0.6;
  const auto distance_m = static_cast<float>(static_cast<double>(grid.cell_m) *
                                             std::sqrt(kDensity / settings.per_cell_face));
  std::vector<SurfaceSample> samples = throw_darts(rays, distance_m, settings.seed);
  const std::vector<CellSurface> cells = cut_surfaces(rays, grid);
  const auto slot_of = [&](const SurfaceSample& sample) {
    return grid.index(grid.cell_at(in_front(sample.point, grid))) * kNormalClasses +
           normal_class(sample.point.geometric_normal);
  };
  std::vector<std::uint32_t> counts(cells.size(), 0);
  for (const SurfaceSample& sample : samples) ++counts[slot_of(sample)];
  for (std::size_t slot = 0; slot < cells.size(); ++slot) {
    if (counts[slot] > 0 || cells[slot].area_m2 <= 0.0) continue;
    const auto point = rays.point_on_triangle(cells[slot].object, cells[slot].triangle,
                                              barycentrics_of(rays, cells[slot]));
    // Its area is known here: the point may have been moved over the border of its cell.
    samples.push_back({point, static_cast<float>(cells[slot].area_m2)});
  }
  std::vector<std::uint32_t> by_cell(grid.cell_count(), 0);
  for (const SurfaceSample& sample : samples)
    ++by_cell[grid.index(grid.cell_at(in_front(sample.point, grid)))];
  for (SurfaceSample& sample : samples) {
    if (settings.area == SampleArea::count) {
      const auto count = by_cell[grid.index(grid.cell_at(in_front(sample.point, grid)))];
      sample.area_m2 = grid.cell_m * grid.cell_m / static_cast<float>(count);
    } else if (sample.area_m2 == 0.0F) {
      const std::size_t slot = slot_of(sample);
      sample.area_m2 = static_cast<float>(cells[slot].area_m2 / counts[slot]);
    }
  }
  return samples;
}

}  // namespace renderers::light_propagation
