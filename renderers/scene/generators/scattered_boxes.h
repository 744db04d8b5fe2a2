#pragma once

#include "renderers/scene/generators/generator_list.h"

#include <vector>

namespace renderers::scene {

/// Boxes of random size and turn that stand on the plane y = 0 without touching each other.
///
/// {seed: 1, count, area: [x, z] (metres, centred on the origin), height: [least, greatest]}. One
/// box stands in each cell of a grid; its footprint stays in the cell at every turn.
std::vector<GeneratedPart> scattered_boxes(base::MapReader& reader);

}  // namespace renderers::scene
