#include "results/figures/picture_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "results/figures/figure_colors.h"
#include "results/figures/gnuplot_text.h"

namespace results::figures {

namespace {

constexpr double kGap_cm = 0.12;
constexpr double kLabel_cm = 0.55;    ///< width of the rows' labels
constexpr double kTitle_cm = 0.5;     ///< height of the columns' titles
constexpr double kCaption_cm = 0.34;  ///< height of a line
constexpr double kPrint_px_per_cm = 300.0 / 2.54;

/// Width of a column if only the figure's width counts.
double widest_tile_cm(double width_cm, std::size_t columns) {
  return (width_cm - kLabel_cm) / static_cast<double>(columns) - kGap_cm;
}

/// The title of a column: what does not fit goes on below with what it has in brackets, in which
/// columns differ.
std::vector<std::string> title_lines(const std::string& title, double room_cm) {
  const std::size_t bracket = title.find('[');
  if (bracket == std::string::npos || text_width_cm(title, kTextPt) <= room_cm) return {title};
  return {title.substr(0, bracket), title.substr(bracket)};
}

/// Height of the columns' titles.
double titles_cm(const PictureGrid& grid, double room_cm) {
  const bool has_two = std::ranges::any_of(grid.columns, [&](const std::string& title) {
    return title_lines(title, room_cm).size() > 1;
  });
  return kTitle_cm + (has_two ? kCaption_cm : 0.0);
}

/// Height of everything but the pictures themselves.
double words_cm(const PictureGrid& grid, double titles_cm) {
  double height = titles_cm + grid.below_cm;
  for (const GridRow& row : grid.rows) {
    height += kCaption_cm * static_cast<double>(grid.caption_lines(row)) + kGap_cm;
  }
  return height;
}

double sum_of_aspects(const PictureGrid& grid) {
  double sum = 0.0;
  for (const GridRow& row : grid.rows) sum += row.aspect;
  return sum;
}

/// What is wider than its column goes on in a second line: the name first, then the value.
std::vector<std::string> fitted(const std::vector<std::string>& captions, double room_cm) {
  std::vector<std::string> lines;
  for (const std::string& caption : captions) {
    const std::size_t space = caption.find(' ');
    if (space == std::string::npos || text_width_cm(caption, kSmallPt) <= room_cm) {
      lines.push_back(caption);
      continue;
    }
    lines.push_back(caption.substr(0, space));
    lines.push_back(caption.substr(space + 1));
  }
  return lines;
}

class GridDrawer {
 public:
  GridDrawer(const FigureSpec& figure, PictureGrid grid, FigureDrawing& drawing)
      : figure_(figure), grid_(std::move(grid)), drawing_(drawing) {
    FigurePage& page = drawing.page;
    tile_cm_ = widest_tile_cm(page.content().width, grid_.columns.size());
    fit_words();
    if (figure.has_height) {
      narrow(page.content().height);
      fit_words();  // in columns that are narrower now
      narrow(page.content().height);
    } else {
      page.height_cm = page.height_around_content() + words_cm(grid_, titles_cm_) +
                       tile_cm_ * sum_of_aspects(grid_);
    }
    content_ = page.content();
    const double width =
        kLabel_cm + (tile_cm_ + kGap_cm) * static_cast<double>(grid_.columns.size());
    left_ = content_.left + std::max(0.0, 0.5 * (content_.width - width)) + kLabel_cm;
  }

  PageBox draw() {
    drawing_.commands += "# Pictures\n" + page_area(drawing_.page);
    double top = content_.top() - titles_cm_;
    for (std::size_t column = 0; column < grid_.columns.size(); ++column) draw_title(column, top);
    for (std::size_t row = 0; row < grid_.rows.size(); ++row) top = draw_row(row, top);
    drawing_.commands += (plots_.empty() ? "plot -1 notitle" : "plot " + plots_) + "\n";
    return {left_, top - grid_.below_cm,
            (tile_cm_ + kGap_cm) * static_cast<double>(grid_.columns.size()) - kGap_cm,
            grid_.below_cm};
  }

 private:
  void fit_words() {
    titles_cm_ = titles_cm(grid_, tile_cm_);
    for (GridRow& row : grid_.rows) {
      for (GridTile& tile : row.tiles) tile.captions = fitted(tile.captions, tile_cm_ + kGap_cm);
    }
  }

  /// Columns no wider than pictures and words leave room for in a height.
  void narrow(double height_cm) {
    const double left_cm = height_cm - words_cm(grid_, titles_cm_);
    tile_cm_ = std::max(0.3, std::min(tile_cm_, left_cm / sum_of_aspects(grid_)));
  }

  double left_of(std::size_t column) const {
    return left_ + (tile_cm_ + kGap_cm) * static_cast<double>(column);
  }

  void text(double x, double y, const std::string& words, double room_cm, const TextStyle& style) {
    drawing_.commands += text_at(x, y, gnuplot_string(shortened(words, room_cm, style.font_pt)),
                                 drawing_.page, style);
  }

  void draw_title(std::size_t column, double top) {
    const double x = left_of(column) + 0.5 * tile_cm_;
    const std::vector<std::string> lines = title_lines(grid_.columns[column], tile_cm_);
    const bool is_alone = lines.size() == 1;
    text(x, top + 0.22 + (is_alone ? 0.0 : kCaption_cm), lines.front(), tile_cm_,
         {Align::center, kTextPt});
    if (!is_alone) {
      text(x, top + 0.2, lines.back(), tile_cm_ + kGap_cm, {Align::center, kSmallPt, kSoftInk});
    }
  }

  double draw_row(std::size_t number, double top) {
    const GridRow& row = grid_.rows[number];
    const double height = tile_cm_ * row.aspect;
    text(left_ - 0.3, top - 0.5 * height, row.label, height, {Align::center, kTextPt, kInk, true});
    for (std::size_t column = 0; column < row.tiles.size(); ++column) {
      const PageBox box{left_of(column), top - height, tile_cm_, height};
      draw_tile(row, row.tiles[column], box, fmt::format("r{}c{}.png", number + 1, column + 1));
    }
    const auto lines = static_cast<double>(grid_.caption_lines(row));
    return top - height - kCaption_cm * lines - kGap_cm;
  }

  void draw_tile(const GridRow& row, const GridTile& tile, const PageBox& box,
                 const std::string& name) {
    if (tile.image) {
      add_picture(*tile.image, box, name);
    } else {
      rectangle(box, fmt::format("fs solid 1 border lc rgb '{}' fc rgb '#eceff3'", kGridColor));
      text(box.center_x(), box.center_y(), tile.missing, box.width,
           {Align::center, kSmallPt, kSoftInk});
    }
    if (!row.frame_color.empty()) {
      rectangle(box, fmt::format("fs empty border lc rgb '{}' lw 2", row.frame_color));
    }
    for (const auto& [crop, color] : row.insets) {
      if (!tile.image) continue;
      const PageBox inset{box.left + crop.x * box.width,
                          box.top() - (crop.y + crop.height) * box.height, crop.width * box.width,
                          crop.height * box.height};
      rectangle(inset, fmt::format("fs empty border lc rgb '{}' lw 1.5", color));
    }
    for (std::size_t line = 0; line < tile.captions.size(); ++line) {
      text(box.center_x(), box.bottom - kCaption_cm * (static_cast<double>(line) + 0.55),
           tile.captions[line], tile_cm_ + kGap_cm, {Align::center, kSmallPt, kSoftInk});
    }
  }

  void rectangle(const PageBox& box, const std::string& style) {
    drawing_.commands += fmt::format(
        "set object rectangle from {:.4f},{:.4f} to {:.4f},{:.4f} "
        "front {}\n",
        box.left, box.bottom, box.right(), box.top(), style);
  }

  /// gnuplot places the middle of the lower left pixel.
  void add_picture(const perception::Image& image, const PageBox& box, const std::string& name) {
    const double dx = box.width / image.width_px;
    const double dy = box.height / image.height_px;
    plots_ += fmt::format(
        "{}'{}-images/{}' binary filetype=png origin=({:.6f},{:.6f}) dx={:.8f} "
        "dy={:.8f} with rgbimage notitle",
        plots_.empty() ? "" : ", \\\n  ", figure_.id, name, box.left + 0.5 * dx,
        box.bottom + 0.5 * dy, dx, dy);
    drawing_.pictures.push_back({name, image});
  }

  const FigureSpec& figure_;
  PictureGrid grid_;
  FigureDrawing& drawing_;
  PageBox content_;
  double tile_cm_ = 0.0;
  double titles_cm_ = 0.0;
  double left_ = 0.0;
  std::string plots_;
};

}  // namespace

std::size_t PictureGrid::caption_lines(const GridRow& row) const {
  std::size_t lines = 0;
  for (const GridTile& tile : row.tiles) lines = std::max(lines, tile.captions.size());
  return lines;
}

int pixels_of_column(const FigureSpec& figure, std::size_t columns) {
  const double width_cm = widest_tile_cm(FigurePage(figure).content().width, columns);
  return std::max(16, static_cast<int>(width_cm * kPrint_px_per_cm));
}

PageBox draw_grid(const FigureSpec& figure, PictureGrid grid, FigureDrawing& drawing) {
  return GridDrawer(figure, std::move(grid), drawing).draw();
}

}  // namespace results::figures
