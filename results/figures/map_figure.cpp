#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "metrics/metric.h"
#include "perception/false_color.h"
#include "results/figures/chart_axis.h"
#include "results/figures/figure_kinds.h"
#include "results/figures/figure_rows.h"
#include "results/figures/gnuplot_text.h"
#include "results/figures/image_sources.h"
#include "results/figures/picture_grid.h"
#include "results/figures/row_table.h"

namespace results::figures {

using perception::Image;

namespace {

/// The colours of a scale with ticks and the unit, below the pictures.
class ColorBar {
 public:
  ColorBar(const perception::MapScale& scale, const std::string& unit) {
    axis_.low = scale.low;
    axis_.high = scale.high;
    axis_.is_log = scale.is_logarithmic;
    put_round_ticks(axis_);
    title_ = unit + (scale.is_logarithmic ? " (logarithmic)" : "");
  }

  static constexpr double kHeight_cm = 1.35;

  void draw(const PageBox& area, FigureDrawing& drawing) const {
    constexpr int kSteps = 128;
    const double width = std::min(8.0, 0.8 * area.width);
    const PageBox box{area.center_x() - 0.5 * width, area.top() - 0.45, width, 0.28};
    drawing.data += "$colors << end\n";
    for (int i = 0; i < kSteps; ++i) {
      const auto color = perception::false_color((i + 0.5) / kSteps);
      const auto byte = [](float value) { return std::lround(255.0F * value); };
      drawing.data += fmt::format("{} {} {}\n", (i + 0.5) / kSteps, 0.5,
                                  byte(color[0]) * 65536 + byte(color[1]) * 256 + byte(color[2]));
    }
    drawing.data += "end\n";
    const FigurePage& page = drawing.page;
    std::string commands =
        plot_area(box, page) + "unset border\nunset tics\nset xrange [0:1]\nset yrange [0:1]\n";
    for (const auto& [value, label] : axis_.ticks) {
      commands += text_at(box.left + box.width * axis_.position(value), box.bottom - 0.22, label,
                          page, {Align::center, kSmallPt});
    }
    commands += text_at(box.center_x(), box.bottom - 0.6, gnuplot_string(title_), page,
                        {Align::center, kTextPt});
    // Strips overlap a little, so that no viewer shows gaps between them.
    drawing.commands += "# Colour bar\n" + commands +
                        fmt::format(
                            "plot $colors using 1:2:($1 - {0}):($1 + 1.4 * {0}):(0):(1):3 "
                            "with boxxyerror fs solid 1 noborder lc rgb variable notitle\n",
                            0.5 / kSteps);
  }

 private:
  ChartAxis axis_;
  std::string title_;
};

class MapGrid {
 public:
  MapGrid(const FigureSpec& figure, const FigureRun& run)
      : figure_(figure), run_(run), rows_(rows_of(figure, run)), table_(table_of(run, rows_)) {
    score_ = run.find_quantity(figure.metric.text + "@" + figure.against, figure.metric.place);
    info_ = score_.kind == Quantity::Kind::score ? metric_info_of(score_.name) : nullptr;
    if (info_ == nullptr) {
      throw base::InputError(figure.metric.place, fmt::format("\"{}\" is no metric that this build "
                                                              "knows the scale of",
                                                              figure.metric.text));
    }
    drawing_.page = FigurePage(figure);
    drawing_.table.columns = {"scene", "method", "budget", "metric",    "against",    "value",
                              "low",   "high",   "map",    "scale_low", "scale_high", "unit"};
  }

  FigureDrawing draw() {
    PictureGrid grid;
    grid.columns = table_.columns;
    grid.below_cm = ColorBar::kHeight_cm;
    pixels_ = pixels_of_column(figure_, grid.columns.size());
    for (std::size_t scene = 0; scene < table_.scenes.size(); ++scene) {
      GridRow row;
      row.label = table_.scenes[scene];
      for (const auto& of_column : table_.rows[scene]) {
        row.tiles.push_back(of_column ? tile_of(*of_column, row.aspect)
                                      : GridTile{std::nullopt, "not in the suite", {}});
      }
      grid.rows.push_back(std::move(row));
    }
    if (!has_map_) {
      fail_without_data(figure_, fmt::format("a map of {} against {}", score_.name, score_.against),
                        run_, rows_);
    }
    const PageBox below = draw_grid(figure_, grid, drawing_);
    const std::string unit = info_->map_unit.empty() ? score_.name : info_->map_unit;
    ColorBar(info_->map_scale, unit).draw(below, drawing_);
    return std::move(drawing_);
  }

 private:
  GridTile tile_of(std::size_t row, double& aspect) {
    ImageSource source = map_of(run_, row, score_);
    GridTile tile;
    if (const std::optional<Image> map = read_source(source)) {
      tile.image = perception::false_color_image(reduced_to(*map, pixels_), info_->map_scale);
      aspect = static_cast<double>(map->height_px) / map->width_px;
      has_map_ = true;
    }
    tile.missing = source.missing;
    const std::optional<Estimate> value = run_.estimate(row, score_);
    tile.captions.push_back(value ? value_text(score_named(), *value) : "n/a");
    const RowFacts& facts = run_.rows()[row];
    const auto side = [&](double Estimate::*end) {
      return value ? std::optional((*value).*end) : std::nullopt;
    };
    drawing_.table.rows.push_back(
        {facts.scene, facts.method, facts.budget, score_.name, score_.against,
         side(&Estimate::value), side(&Estimate::low), side(&Estimate::high),
         std::filesystem::relative(source.file, run_.run().folder).string(), info_->map_scale.low,
         info_->map_scale.high, info_->map_unit});
    return tile;
  }

  /// The score with the metric's name alone.
  Quantity score_named() const {
    Quantity named = score_;
    named.text = score_.name;
    return named;
  }

  const FigureSpec& figure_;
  const FigureRun& run_;
  std::vector<std::size_t> rows_;
  RowTable table_;
  Quantity score_;
  const metrics::MetricDescription* info_ = nullptr;
  FigureDrawing drawing_;
  int pixels_ = 0;
  bool has_map_ = false;
};

}  // namespace

FigureDrawing map_figure(const FigureSpec& figure, const FigureRun& run) {
  return MapGrid(figure, run).draw();
}

}  // namespace results::figures
