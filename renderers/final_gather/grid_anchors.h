#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/final_gather/camera_samples.h"
#include "renderers/final_gather/gather_grid.h"

namespace renderers::final_gather {

/// A surface point that a camera ray meets.
struct Anchor {
  std::uint32_t object = 0;
  std::uint32_t triangle = 0;
  glm::vec2 barycentrics{0.0F};
  std::uint32_t leaf = 0;
  std::uint32_t pixel = 0;
  float weight = 1.0F;  ///< share of its pixel
  bool is_back = false;
};

/// All points that the camera sees, and the grid around them.
///
/// The grid reaches from the nearest to the farthest of them and 2 % further, in depth, or in the
/// world along all axes, not from plane to plane of the camera: what is empty gets no cells; ours.
class GridAnchors {
 public:
  struct Settings {
    int vertices = 10000;
    DepthSpacing spacing = DepthSpacing::reciprocal;  ///< of `perspective`
    GridSpace space = GridSpace::perspective;
    GridBlending blending = GridBlending::tetrahedra;
  };
  /// @return nothing if the camera sees no surface that light reaches
  static std::optional<GridAnchors> make(const element_hierarchy::ElementTree& tree,
                                         const CameraSamples& samples, const RenderJob& job,
                                         const Settings& settings);

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
  explicit GridAnchors(GatherGrid grid) : grid_(grid) {}
  void sort_into_cells(const std::vector<Anchor>& anchors, const std::vector<glm::vec3>& places);

  GatherGrid grid_;
  std::vector<Anchor> anchors_;  ///< by cell
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> touched_;
};

}  // namespace renderers::final_gather
