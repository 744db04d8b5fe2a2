#include "renderers/light_propagation/volume_slices.h"

#include <algorithm>

#include "renderers/light_propagation/intensity_lobe.h"

namespace renderers::light_propagation {

namespace {

using perception::Image;

/// Tiles side by side, and the pixels of a cell.
struct Tiling {
  int columns = 1;
  int cell_px = 1;
};

/// The one with the largest cells. Tiles are a cell apart.
Tiling tiling_of(const Grid& grid, int width_px, int height_px) {
  Tiling best;
  int most_shown = 0;
  for (int columns = 1; columns <= grid.size.y; ++columns) {
    const int rows = (grid.size.y + columns - 1) / columns;
    const int across_px = width_px / (columns * (grid.size.x + 1));
    const int down_px = height_px / (rows * (grid.size.z + 1));
    const int cell_px = std::max(1, std::min(across_px, down_px));
    const int shown = std::min(grid.size.y, columns * (height_px / (cell_px * (grid.size.z + 1))));
    if (shown > most_shown || (shown == most_shown && cell_px > best.cell_px)) {
      best = {columns, cell_px};
      most_shown = shown;
    }
  }
  return best;
}

}  // namespace

Image slice_picture(const LightVolume& volume, int width_px, int height_px) {
  const Grid& grid = volume.grid;
  const auto [columns, cell_px] = tiling_of(grid, width_px, height_px);
  Image picture =
      perception::make_rgb_image(width_px, height_px, perception::Encoding::scene_linear);
  const float face_m2 = grid.cell_m * grid.cell_m;
  for (int y = 0; y < height_px; ++y) {
    const int row = y / cell_px / (grid.size.z + 1);
    const int z = grid.size.z - 1 - y / cell_px % (grid.size.z + 1);
    for (int x = 0; x < width_px; ++x) {
      const int column = x / cell_px / (grid.size.x + 1);
      const glm::ivec3 cell(x / cell_px % (grid.size.x + 1), row * columns + column, z);
      if (column >= columns || !grid.holds(cell)) continue;
      const CellLight& light = volume.cells[grid.index(cell)];
      for (int c = 0; c < 3; ++c) picture.at(x, y, c) = flux(channel_of(light, c)) / face_m2;
    }
  }
  return picture;
}

}  // namespace renderers::light_propagation
