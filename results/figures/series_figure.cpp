#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "results/figures/figure_kinds.h"
#include "results/figures/figure_rows.h"
#include "results/figures/line_groups.h"
#include "results/figures/quantity_axis.h"

namespace results::figures {

namespace {

/// Values by their place on the axis.
using ValuesByPlace = std::map<int, std::vector<double>>;

/// By frame; the elements of a counter that one image has are by their number.
ValuesByPlace values_by_place(const std::vector<Sample>& samples, bool is_sequence) {
  ValuesByPlace values;
  const Sample* before = nullptr;
  int element = 0;
  for (const Sample& sample : samples) {
    const bool goes_on =
        before != nullptr && before->seed == sample.seed && before->repetition == sample.repetition;
    element = goes_on ? element + 1 : 0;
    values[is_sequence ? sample.frame : element].push_back(sample.value);
    before = &sample;
  }
  return values;
}

class SeriesChart {
 public:
  SeriesChart(const FigureSpec& figure, const FigureRun& run)
      : figure_(figure),
        run_(run),
        rows_(rows_of(figure, run)),
        groups_(single_row_groups(rows_, run)),
        styles_(groups_, run) {
    is_sequence_ = std::any_of(rows_.begin(), rows_.end(), [&](std::size_t row) {
      return run.summary().rows[row].is_sequence;
    });
    drawing_.page = FigurePage(figure);
    drawing_.table.columns = {"quantity", "scene", "method", "budget", x_name(),
                              "value",    "low",   "high",   "samples"};
  }

  FigureDrawing draw() {
    const std::vector<Quantity> quantities = y_quantities(figure_, run_);
    for (const Quantity& y : quantities) add_panel(y);
    if (panels_.empty()) {
      fail_without_data(figure_, fmt::format("several values of {}", quantities.front().text), run_,
                        rows_);
    }
    for (LinePanel& panel : panels_) panel.x = place_axis();
    drawing_.page.legend = styles_.legend(LineLook::band);
    // Frames below each other, so that they can be compared.
    draw_panels(panels_, panel_boxes({panels_.size(), 1, false, 4.0}, drawing_.page), drawing_);
    return std::move(drawing_);
  }

 private:
  const char* x_name() const { return is_sequence_ ? "frame" : "element"; }

  void add_panel(const Quantity& y) {
    LinePanel panel;
    for (const LineGroup& group : groups_) {
      ChartLine line = line_of(group, y);
      if (line.points.size() > 1) panel.lines.push_back(std::move(line));
    }
    if (panel.lines.empty()) {
      return add_note(drawing_.page.notes, fmt::format("No row has several values of {}.", y.text));
    }
    panel.y = axis_of_points(panel.lines, &ChartPoint::y, y, figure_.is_log_y, drawing_.page.notes);
    panels_.push_back(std::move(panel));
  }

  /// The same for all panels.
  ChartAxis place_axis() const {
    std::vector<double> places;
    for (const LinePanel& panel : panels_) {
      for (const ChartLine& line : panel.lines) {
        for (const ChartPoint& point : line.points) places.push_back(point.x.value);
      }
    }
    const auto [first, last] = std::minmax_element(places.begin(), places.end());
    ChartAxis axis;
    axis.low = *first;
    axis.high = *last;
    axis.title = x_name();
    put_round_ticks(axis);
    // Frames have no halves.
    std::erase_if(axis.ticks,
                  [](const AxisTick& tick) { return tick.value != std::floor(tick.value); });
    return axis;
  }

  ChartLine line_of(const LineGroup& group, const Quantity& y) {
    ChartLine line = styles_.line_of(group, LineLook::band);
    const std::size_t row = group.rows.front();
    const RowFacts& facts = run_.rows()[row];
    for (const auto& [place, values] : values_by_place(run_.samples(row, y), is_sequence_)) {
      const bool is_score = y.kind == Quantity::Kind::score;
      const Estimate value = is_score ? mean_with_interval(values) : median_with_interval(values);
      const auto x = static_cast<double>(place);
      line.points.push_back({{x, x, x, 1}, value});
      drawing_.table.rows.push_back({y.text, facts.scene, facts.method, facts.budget, x,
                                     value.value, value.low, value.high,
                                     static_cast<double>(value.count)});
    }
    return line;
  }

  const FigureSpec& figure_;
  const FigureRun& run_;
  std::vector<std::size_t> rows_;
  std::vector<LineGroup> groups_;
  LineStyles styles_;
  std::vector<LinePanel> panels_;
  FigureDrawing drawing_;
  bool is_sequence_ = false;
};

}  // namespace

FigureDrawing series_figure(const FigureSpec& figure, const FigureRun& run) {
  return SeriesChart(figure, run).draw();
}

}  // namespace results::figures
