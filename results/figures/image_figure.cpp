#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "perception/display_model.h"
#include "results/figures/figure_colors.h"
#include "results/figures/figure_kinds.h"
#include "results/figures/figure_rows.h"
#include "results/figures/image_sources.h"
#include "results/figures/picture_grid.h"
#include "results/figures/row_table.h"
#include "results/html_report/report_data.h"

namespace results::figures {

using perception::Image;

namespace {

/// Every pixel as a square of up to 4 x 4, as long as the image is not wider than `width_px`: what
/// a viewer smooths is a thin edge of them.
Image enlarged(const Image& image, int width_px) {
  const int factor = std::clamp(width_px / image.width_px, 1, 4);
  Image result(image.width_px * factor, image.height_px * factor, image.channels, image.encoding);
  for (int y = 0; y < result.height_px; ++y) {
    for (int x = 0; x < result.width_px; ++x) {
      const auto from = image.pixel(x / factor, y / factor);
      std::copy(from.begin(), from.end(), result.pixel(x, y).begin());
    }
  }
  return result;
}

Image cropped(const Image& image, const FigureCrop& part) {
  const auto place = [](double fraction, int size) {
    return std::min(static_cast<int>(std::lround(fraction * size)), size - 1);
  };
  const int x = place(part.x, image.width_px);
  const int y = place(part.y, image.height_px);
  const auto side = [](double fraction, int size, int begin) {
    return std::clamp(static_cast<int>(std::lround(fraction * size)), 1, size - begin);
  };
  return perception::crop(image, x, y, side(part.width, image.width_px, x),
                          side(part.height, image.height_px, y));
}

class ImageGrid {
 public:
  ImageGrid(const FigureSpec& figure, const FigureRun& run)
      : figure_(figure), run_(run), rows_(rows_of(figure, run)), table_(table_of(run, rows_)) {
    drawing_.page = FigurePage(figure);
    drawing_.table.columns = {"scene", "method", "budget", "quantity",
                              "value", "low",    "high",   "image"};
    quantities_ = y_quantities(figure, run);
    quantities_.push_back(time_quantity(figure, run, rows_));
  }

  FigureDrawing draw() {
    grid_.columns = {"reference"};
    grid_.columns.insert(grid_.columns.end(), table_.columns.begin(), table_.columns.end());
    pixels_ = pixels_of_column(figure_, grid_.columns.size());
    bool has_image = false;
    for (std::size_t scene = 0; scene < table_.scenes.size(); ++scene) {
      has_image = add_scene(scene) || has_image;
    }
    if (!has_image) fail_without_data(figure_, "an image", run_, rows_);
    draw_grid(figure_, grid_, drawing_);
    return std::move(drawing_);
  }

 private:
  /// @return whether a rendering of the scene is there
  bool add_scene(std::size_t scene) {
    const std::string& name = table_.scenes[scene];
    exposure_ev_ = html_report::exposure_of(*run_.run().info, name);
    std::vector<GridRow> rows(1 + figure_.crops.size());
    rows[0].label = name;
    for (std::size_t i = 0; i < figure_.crops.size(); ++i) {
      rows[0].insets.emplace_back(figure_.crops[i], palette_color(kCropColor + i));
      rows[i + 1].frame_color = palette_color(kCropColor + i);
    }
    add_tiles(reference_of(run_, table_.rows_of_scene(scene), figure_.against), {}, rows);
    bool has_image = false;
    for (const std::optional<std::size_t>& row : table_.rows[scene]) {
      ImageSource source = row ? rendering_of(run_, *row) : ImageSource{{}, "", "not in the suite"};
      has_image = has_image || source.missing.empty();
      add_tiles(source, row ? captions_of(*row, source) : std::vector<std::string>(), rows);
    }
    grid_.rows.insert(grid_.rows.end(), std::make_move_iterator(rows.begin()),
                      std::make_move_iterator(rows.end()));
    return has_image;
  }

  /// The image itself and its crops.
  void add_tiles(ImageSource source, std::vector<std::string> captions,
                 std::vector<GridRow>& rows) const {
    const std::optional<Image> image = read_source(source);
    const auto shown = [&](const Image& linear) {
      return perception::to_display_encoded(linear, exposure_ev_);
    };
    GridTile whole{std::nullopt, source.missing, std::move(captions)};
    if (image) {
      whole.image = shown(reduced_to(perception::rgb_of(*image), pixels_));
      rows[0].aspect = static_cast<double>(image->height_px) / image->width_px;
    }
    rows[0].tiles.push_back(std::move(whole));
    for (std::size_t i = 0; i < figure_.crops.size(); ++i) {
      GridTile part{std::nullopt, source.missing, {}};
      if (image) {
        const Image pixels = cropped(perception::rgb_of(*image), figure_.crops[i]);
        rows[i + 1].aspect = static_cast<double>(pixels.height_px) / pixels.width_px;
        part.image = enlarged(shown(reduced_to(pixels, pixels_)), pixels_);
      }
      rows[i + 1].tiles.push_back(std::move(part));
    }
  }

  std::vector<std::string> captions_of(std::size_t row, const ImageSource& source) {
    std::vector<std::string> captions;
    const RowFacts& facts = run_.rows()[row];
    const std::string image = source.missing.empty()
                                  ? run_.run().cells[*run_.summary().rows[row].shown].render.image
                                  : "";
    for (const Quantity& quantity : quantities_) {
      const std::optional<Estimate> value = run_.estimate(row, quantity);
      captions.push_back(value ? value_text(quantity, *value) : quantity.text + " n/a");
      const auto side = [&](double Estimate::*end) {
        return value ? std::optional((*value).*end) : std::nullopt;
      };
      drawing_.table.rows.push_back({facts.scene, facts.method, facts.budget, quantity.text,
                                     side(&Estimate::value), side(&Estimate::low),
                                     side(&Estimate::high), image});
    }
    return captions;
  }

  /// Crops begin with the palette's second colour: the first reads badly on dark pictures.
  static constexpr std::size_t kCropColor = 4;

  const FigureSpec& figure_;
  const FigureRun& run_;
  std::vector<std::size_t> rows_;
  RowTable table_;
  std::vector<Quantity> quantities_;
  PictureGrid grid_;
  FigureDrawing drawing_;
  int pixels_ = 0;
  double exposure_ev_ = 0.0;
};

}  // namespace

FigureDrawing image_figure(const FigureSpec& figure, const FigureRun& run) {
  return ImageGrid(figure, run).draw();
}

}  // namespace results::figures
