#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderers/final_gather/camera_anchors.h"
#include "renderers/final_gather/gather_grid.h"

namespace renderers::final_gather {

struct GridSettings {
  int vertices = 10000;
  DepthSpacing spacing = DepthSpacing::reciprocal;  ///< of `perspective`
  GridSpace space = GridSpace::perspective;
  GridBlending blending = GridBlending::tetrahedra;
};

/// A grid from the nearest to the farthest point and 2 % further, in depth, or in the world along
/// all axes, not from plane to plane of the camera: what is empty gets no cells; ours.
/// @param anchors  at least one
GatherGrid grid_around(const std::vector<Anchor>& anchors, const RenderJob& job,
                       const GridSettings& settings);

/// Points that the camera sees, by cells of a grid.
class GridAnchors {
 public:
  /// @param is_in  which of them the grid is for; the others touch no vertex and stand in no cell
  GridAnchors(const GatherGrid& grid, const std::vector<Anchor>& anchors,
              const std::vector<bool>& is_in);

  const GatherGrid& grid() const { return grid_; }
  /// Vertices that a camera ray's point lies between, in order.
  const std::vector<std::uint32_t>& touched() const { return touched_; }
  /// Anchors of a cell.
  std::span<const Anchor> in_cell(std::uint32_t cell) const {
    return std::span(anchors_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }
  /// Anchors in the up to eight cells around a vertex.
  std::vector<const Anchor*> around(std::uint32_t vertex) const;

 private:
  GatherGrid grid_;
  std::vector<Anchor> anchors_;  ///< by cell
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> touched_;
};

}  // namespace renderers::final_gather
