#pragma once

#include <cstdint>
#include <vector>

#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/final_gather/gather_grid.h"

namespace renderers::final_gather {

/// Which sides of triangles are gathered by their patches, and not by the grid.
enum class SurfaceUse {
  never,
  finely_cut,  ///< whose smallest patch is smaller than the grid's cells (Sec. 4.5)
  always
};

/// Decides for each whole side of a triangle, so that no seam runs through one.
///
/// A side that was not cut belongs to the grid however small it is: its light arrives at clusters.
/// Source: Scheel et al. 2002, Sec. 4.5; a patch is as wide as a square of its area; ours.
class SurfaceChoice {
 public:
  /// @param tree  must live as long as this  @param grid  null with `SurfaceUse::always`
  SurfaceChoice(const element_hierarchy::ElementTree& tree, SurfaceUse use, const GatherGrid* grid);

  bool is_on_surface(std::uint32_t leaf) const { return is_on_surface_[tree_.at(leaf).root_begin]; }

 private:
  const element_hierarchy::ElementTree& tree_;
  std::vector<bool> is_on_surface_;  ///< per whole side
};

/// Edge of a square whose half a patch would be, m.
double width_m(const element_hierarchy::Element& patch);

}  // namespace renderers::final_gather
