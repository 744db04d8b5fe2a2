#include "renderers/final_gather/surface_choice.h"

#include <cmath>

namespace renderers::final_gather {

using element_hierarchy::Element;

double width_m(const Element& patch) { return std::sqrt(2.0 * static_cast<double>(patch.area_m2)); }

SurfaceChoice::SurfaceChoice(const element_hierarchy::ElementTree& tree, SurfaceUse use,
                             const GatherGrid* grid)
    : tree_(tree), is_on_surface_(tree.roots().size(), use == SurfaceUse::always) {
  if (use != SurfaceUse::finely_cut) return;
  for (std::uint32_t i = 0; i < tree.elements().size(); ++i) {
    const Element& patch = tree.at(i);
    if (!patch.is_patch || !patch.is_leaf() || tree.is_root(i)) continue;
    const glm::vec3 centre = (patch.positions[0] + patch.positions[1] + patch.positions[2]) / 3.0F;
    const bool is_before_camera = grid->view_depth_m(centre) > 0.0;
    if (is_before_camera && width_m(patch) < grid->cell_width_m(centre)) {
      is_on_surface_[patch.root_begin] = true;
    }
  }
}

}  // namespace renderers::final_gather
