#pragma once

#include <optional>
#include <string>
#include <vector>

#include "perception/image.h"
#include "results/figures/figure_page.h"

namespace results::figures {

/// A picture in its place, with words around it.
struct GridTile {
  std::optional<perception::Image> image;  ///< encoding display
  std::string missing;                     ///< what to say in its place
  std::vector<std::string> captions;       ///< below it, a line each, or two: a name and its value
};

/// Pictures of one height side by side.
struct GridRow {
  std::string label;                                       ///< at the left, upright
  double aspect = 1.0;                                     ///< height / width of its pictures
  std::vector<GridTile> tiles;                             ///< one per column
  std::string frame_color;                                 ///< around the pictures; "" for none
  std::vector<std::pair<FigureCrop, std::string>> insets;  ///< squares in them and their colours
};

struct PictureGrid {
  std::vector<std::string> columns;  ///< titles
  std::vector<GridRow> rows;
  double below_cm = 0.0;  ///< room kept below the pictures

  std::size_t caption_lines(const GridRow& row) const;
};

/// Most pixels that a picture keeps: what 300 dpi show of it in a column of the figure.
int pixels_of_column(const FigureSpec& figure, std::size_t columns);

/// Places the pictures, as large as the page lets them be. Without a height of its own the page
/// becomes as high as they need.
/// @param id  of the figure, names its folder of pictures
/// @return what is below the pictures: `grid.below_cm` high
PageBox draw_grid(const FigureSpec& figure, PictureGrid grid, FigureDrawing& drawing);

}  // namespace results::figures
