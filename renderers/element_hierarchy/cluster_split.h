#pragma once

#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

#include "renderers/element_hierarchy/element.h"

namespace renderers::element_hierarchy {

/// Centre of an element's box.
inline glm::vec3 box_center(const Element& element) {
  return 0.5F * (element.box_min + element.box_max);
}

/// Orders patches so that the first n and the rest make two good clusters, by the surface area
/// heuristic over 16 bins of the longest axis of their centres; halves where centres coincide.
///
/// Source: Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies",
/// doi:10.1109/RT.2007.4342588.
/// @param patches  at least two
/// @return n, in [1, size - 1]
std::size_t split_cluster(std::span<Element> patches);

}  // namespace renderers::element_hierarchy
