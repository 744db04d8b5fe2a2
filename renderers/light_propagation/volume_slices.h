#pragma once

#include "perception/image.h"
#include "renderers/light_propagation/light_volume.h"

namespace renderers::light_propagation {

/// The volume from above: a tile per layer of cells, from the lowest on, left to right and top to
/// bottom, x to the right and z down. A pixel is the cell's flux by the area of its face, W/m2;
/// tiles are as large as the picture allows, and black is around them. The highest layers are left
/// out where the picture is too small for a pixel a cell.
perception::Image slice_picture(const LightVolume& volume, int width_px, int height_px);

}  // namespace renderers::light_propagation
