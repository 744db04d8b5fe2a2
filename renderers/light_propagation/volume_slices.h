#pragma once

#include "perception/image.h"
#include "renderers/light_propagation/light_volume.h"

namespace renderers::light_propagation {

/// The volume in plan: a tile per layer of cells, from the lowest on, left to right and top to
/// bottom, x to the right and z up. A pixel is the cell's flux by the area of its face, W/m2; tiles
/// are as large as the picture allows, and black is around them. Layers that find no room of a
/// pixel a cell are left out.
perception::Image slice_picture(const LightVolume& volume, int width_px, int height_px);

}  // namespace renderers::light_propagation
