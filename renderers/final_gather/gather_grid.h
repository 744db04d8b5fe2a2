#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "renderers/scene/scene.h"

namespace renderers::final_gather {

/// Where cells are of one size.
enum class GridSpace {
  perspective,  ///< after the perspective: on the screen (Sec. 4.2)
  world         ///< cubes; cells far away are smaller on the screen (Sec. 4.2)
};

/// Which vertices of a cell take part in a value between them.
enum class GridBlending {
  tetrahedra,  ///< the four of a fifth of the cell (Sec. 4.4, Fig. 3)
  trilinear    ///< all eight
};

/// How slices lie in depth.
enum class DepthSpacing {
  reciprocal,  ///< uniform in post-perspective depth (Sec. 4.2)
  logarithmic  ///< slices as deep as cells are wide; ours
};

/// Cells along the image's axes and in depth.
struct GridSize {
  int x = 1;
  int y = 1;
  int z = 1;
  std::size_t vertex_count() const {
    return static_cast<std::size_t>(x + 1) * static_cast<std::size_t>(y + 1) *
           static_cast<std::size_t>(z + 1);
  }
  std::size_t cell_count() const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(y) * static_cast<std::size_t>(z);
  }
};

/// Cells that are square on the screen, as many slices as the root of x times y; about `vertices`
/// vertices in all (700 x 350 and 10,000: 30 x 15 x 21); ours.
GridSize grid_size_for(int width_px, int height_px, int vertices);
/// Cells that are about cubes of the box. @param extent_m  above 0
GridSize grid_size_for(const glm::dvec3& extent_m, int vertices);

/// Vertices around a point and its weights.
struct GridBlend {
  std::array<std::uint32_t, 8> vertices{};
  std::array<float, 8> weights{};  ///< sum 1
  std::size_t count = 0;           ///< of both

  std::span<const std::uint32_t> used() const& { return std::span(vertices).first(count); }
  void used() const&& = delete;  // would outlive it
};

/// A grid over what a camera sees: uniform after the perspective, or in the world.
///
/// With `tetrahedra` every cell is cut into five tetrahedra without more vertices: those of even i
/// + j + k form the middle one, so that neighbouring cells agree on the diagonals of their common
/// face. Source: Scheel et al. 2002, Secs. 4.2 and 4.4, Figs. 1 and 3; the choice by parity is
/// ours.
class GatherGrid {
 public:
  /// Over the view volume. @param near_far_m  of what is seen, along the view axis, 0 < near < far
  GatherGrid(const scene::Camera& camera, double aspect, const GridSize& size,
             const std::array<double, 2>& near_far_m, DepthSpacing spacing, GridBlending blending);
  /// Over a box of the world. @param low, high  corners, each axis with an extent
  GatherGrid(const scene::Camera& camera, const GridSize& size, const glm::dvec3& low,
             const glm::dvec3& high, GridBlending blending);

  const GridSize& size() const { return size_; }
  /// Height of the image on a plane at distance 1.
  double image_height_at_one() const { return 2.0 * half_height_; }
  /// Distance along the view axis, m.
  double view_depth_m(const glm::vec3& point) const;
  /// Of the cells at a point, m; across the image, or along the world's x.
  double cell_width_m(const glm::vec3& point) const;
  /// Position in cells, 0 to size along each axis for points inside.
  glm::dvec3 to_grid(const glm::vec3& point) const;
  glm::vec3 to_world(const glm::dvec3& grid) const;
  glm::vec3 vertex(std::uint32_t index) const { return to_world(glm::dvec3(vertex_place(index))); }

  /// Index of the cell around a point; the nearest one for points outside.
  std::uint32_t cell_at(const glm::vec3& point) const;
  std::uint32_t cell_index(const glm::ivec3& cell) const;
  glm::ivec3 vertex_place(std::uint32_t index) const;
  std::uint32_t vertex_index(const glm::ivec3& place) const;

  /// The vertices around a point; linear fields are met exactly, but with `logarithmic` depth. A
  /// point outside is moved to the nearest cell. @param by_parity  false: the same cut in every
  /// cell, which tears the field (for tests)
  GridBlend blend(const glm::vec3& point, bool by_parity = true) const;

 private:
  glm::vec3 position_;
  glm::vec3 forward_;
  glm::vec3 right_;
  glm::vec3 up_;
  double half_width_;  ///< of the image at distance 1
  double half_height_;
  GridSize size_;
  GridSpace space_;
  GridBlending blending_;
  double near_m_ = 1.0;
  double far_m_ = 2.0;
  DepthSpacing spacing_ = DepthSpacing::reciprocal;
  glm::dvec3 low_{0.0};  ///< of the box in the world
  glm::dvec3 extent_{1.0};
};

}  // namespace renderers::final_gather
