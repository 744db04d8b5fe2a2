#include <algorithm>

#include <fmt/format.h>

#include "results/convergence.h"
#include "results/figures/figure_colors.h"
#include "results/figures/figure_kinds.h"
#include "results/figures/figure_rows.h"
#include "results/figures/line_groups.h"
#include "results/figures/quantity_axis.h"

namespace results::figures {

namespace {

/// Scores over x: what error-vs-parameter and error-vs-time have in common.
class ErrorChart {
 public:
  ErrorChart(const FigureSpec& figure, const FigureRun& run, std::vector<std::size_t> rows,
             Quantity x)
      : figure_(figure),
        run_(run),
        rows_(std::move(rows)),
        x_(std::move(x)),
        groups_(line_groups(rows_, run, x_)),
        styles_(groups_, run) {
    drawing_.page = FigurePage(figure);
    drawing_.table.columns = {"quantity", "scene",   "method",     "budget", "series",
                              x_.text,    "x_low",   "x_high",     "value",  "low",
                              "high",     "samples", "noise_floor"};
  }

  FigureDrawing draw(const std::vector<Quantity>& quantities) {
    for (const Quantity& y : quantities) add_panels(y);
    if (panels_.empty()) {
      fail_without_data(figure_, fmt::format("{} over {}", names_of(quantities), x_.text), run_,
                        rows_);
    }
    drawing_.page.legend = styles_.legend(LineLook::marks_and_bars);
    if (styles_.has_many_methods()) {
      add_note(drawing_.page.notes,
               "Marks of one colour are settings of one method; the table names them.");
    }
    if (has_floor_) {
      drawing_.page.legend.push_back(
          {"reference noise", fmt::format("with lines lc rgb '{}' dt 2 lw 1.2", kSoftInk)});
    }
    PanelLayout layout{panels_.size()};
    layout.has_titles = !panels_.front().title.empty();
    draw_panels(panels_, panel_boxes(layout, drawing_.page), drawing_);
    return std::move(drawing_);
  }

 private:
  static std::string names_of(const std::vector<Quantity>& quantities) {
    std::string names;
    for (const Quantity& one : quantities) names += (names.empty() ? "" : ", ") + one.text;
    return names;
  }

  /// One panel of all scenes; of each scene where their dashes could not be told apart.
  void add_panels(const Quantity& y) {
    constexpr std::size_t kMostDashes = 4;
    const std::vector<std::string>& scenes = styles_.scenes();
    if (scenes.size() <= kMostDashes) return add_panel(y, "");
    for (const std::string& scene : scenes) add_panel(y, scene);
  }

  void add_panel(const Quantity& y, const std::string& scene) {
    LinePanel panel;
    panel.title = scene;
    if (scene.empty() && styles_.scenes().size() == 1) panel.title = styles_.scenes().front();
    std::vector<double> x_values;
    for (const LineGroup& group : groups_) {
      if (!scene.empty() && group.scene != scene) continue;
      ChartLine line = styles_.line_of(group, LineLook::marks_and_bars);
      for (const std::size_t row : group.rows) add_point(row, group, y, line);
      if (line.points.empty()) continue;
      std::stable_sort(line.points.begin(), line.points.end(),
                       [](const auto& a, const auto& b) { return a.x.value < b.x.value; });
      for (const ChartPoint& point : line.points) x_values.push_back(point.x.value);
      panel.lines.push_back(std::move(line));
      if (x_.name == "total_s") add_checkpoints(group, y, panel);
    }
    if (panel.lines.empty()) {
      const std::string where = scene.empty() ? "" : " in " + scene;
      return add_note(drawing_.page.notes, fmt::format("No row has {}{}.", y.text, where));
    }
    finish(y, x_values, panel);
  }

  void add_point(std::size_t row, const LineGroup& group, const Quantity& y, ChartLine& line) {
    const std::optional<Estimate> x_value = run_.estimate(row, x_);
    const std::optional<Estimate> y_value = run_.estimate(row, y);
    if (!x_value || !y_value) return;
    line.points.push_back({*x_value, *y_value});
    const RowFacts& facts = run_.rows()[row];
    drawing_.table.rows.push_back({y.text, facts.scene, facts.method, facts.budget, group.method,
                                   x_value->value, x_value->low, x_value->high, y_value->value,
                                   y_value->low, y_value->high, static_cast<double>(y_value->count),
                                   noise_floor_of(run_, row, y)});
  }

  void add_checkpoints(const LineGroup& group, const Quantity& y, LinePanel& panel) {
    for (const std::size_t row : group.rows) {
      for (const ConvergenceCurve& curve : convergence_curves(run_.values(), row, y)) {
        ChartLine line = styles_.line_of(group, LineLook::thin);
        const RowFacts& facts = run_.rows()[row];
        for (const auto& [samples, time_s, error] : curve.points) {
          line.points.push_back({{time_s, time_s, time_s, 1}, {error, error, error, 1}});
          drawing_.table.rows.push_back(
              {y.text, facts.scene, facts.method, facts.budget,
               fmt::format("{}, checkpoints of seed {}", group.method, curve.seed), time_s, time_s,
               time_s, error, error, error, 1.0, std::optional<double>()});
        }
        panel.lines.push_back(std::move(line));
      }
    }
  }

  void finish(const Quantity& y, const std::vector<double>& x_values, LinePanel& panel) {
    std::vector<std::string>& notes = drawing_.page.notes;
    panel.x = axis_of_points(panel.lines, &ChartPoint::x, x_, figure_.is_log_x, notes);
    if (x_.unit != "s") put_ticks_at(x_values, panel.x);
    add_floors(y, panel);
    panel.y = axis_of_points(panel.lines, &ChartPoint::y, y, figure_.is_log_y, notes);
    std::erase_if(panel.lines, [&](const ChartLine& line) {
      if (line.look != LineLook::floor) return false;
      const double floor = line.points.front().y.value;
      const bool is_shown = floor >= panel.y.low && floor <= panel.y.high;
      has_floor_ = has_floor_ || is_shown;
      return !is_shown;
    });
    panels_.push_back(std::move(panel));
  }

  /// A level per different noise floor of the panel's rows, as references are shared.
  void add_floors(const Quantity& y, LinePanel& panel) {
    std::vector<std::string> levels;
    for (const std::size_t row : rows_) {
      const std::optional<double> floor = noise_floor_of(run_, row, y);
      const bool is_here = panel.title.empty() || styles_.scenes().size() == 1 ||
                           run_.rows()[row].scene == panel.title;
      if (!floor || !is_here) continue;
      const std::string level = fmt::format("{:.1e}", *floor);
      const std::size_t known = levels.size();
      if (add_once(levels, level) != known) continue;
      const auto at = [&](double x) {
        return ChartPoint{{x, x, x, 1}, {*floor, *floor, *floor, 1}};
      };
      ChartLine line;
      line.look = LineLook::floor;
      line.color = kSoftInk;
      line.points = {at(panel.x.low), at(panel.x.high)};
      panel.lines.push_back(std::move(line));
    }
  }

  const FigureSpec& figure_;
  const FigureRun& run_;
  std::vector<std::size_t> rows_;
  Quantity x_;
  std::vector<LineGroup> groups_;
  LineStyles styles_;
  std::vector<LinePanel> panels_;
  FigureDrawing drawing_;
  bool has_floor_ = false;
};

}  // namespace

FigureDrawing parameter_figure(const FigureSpec& figure, const FigureRun& run) {
  const std::vector<Quantity> quantities = y_quantities(figure, run);
  const Quantity x = run.find_quantity(figure.x.text, figure.x.place);
  return ErrorChart(figure, run, rows_of(figure, run), x).draw(quantities);
}

FigureDrawing time_figure(const FigureSpec& figure, const FigureRun& run) {
  const std::vector<Quantity> quantities = score_quantities(figure, run);
  const std::vector<std::size_t> rows = rows_of(figure, run);
  return ErrorChart(figure, run, rows, time_quantity(figure, run, rows)).draw(quantities);
}

}  // namespace results::figures
