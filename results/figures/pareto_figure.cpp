#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "results/figures/figure_colors.h"
#include "results/figures/figure_kinds.h"
#include "results/figures/figure_rows.h"
#include "results/figures/label_placement.h"
#include "results/figures/line_groups.h"
#include "results/figures/pareto_front.h"
#include "results/figures/quantity_axis.h"

namespace results::figures {

namespace {

constexpr std::array<const char*, 3> kStandingNames{"front", "undecided", "dominated"};

/// One scene and one score: rows that compete.
struct Contest {
  std::vector<std::size_t> groups;  ///< one per contestant
  std::vector<ChartPoint> points;
  std::vector<Standing> standings;
  std::vector<std::size_t> front;  ///< indices of the above, by time
};

class ParetoChart {
 public:
  ParetoChart(const FigureSpec& figure, const FigureRun& run)
      : figure_(figure),
        run_(run),
        rows_(rows_of(figure, run)),
        time_(time_quantity(figure, run, rows_)),
        groups_(single_row_groups(rows_, run)),
        styles_(groups_, run),
        scenes_(RowNames(run, rows_).scenes()) {
    drawing_.page = FigurePage(figure);
    drawing_.table.columns = {"quantity", "scene", "method", "budget", time_.text, "x_low",
                              "x_high",   "value", "low",    "high",   "standing"};
  }

  FigureDrawing draw() {
    const std::vector<Quantity> quantities = score_quantities(figure_, run_);
    for (const Quantity& y : quantities) {
      for (const std::string& scene : scenes_) add_panel(y, scene);
    }
    if (panels_.empty()) {
      fail_without_data(figure_, fmt::format("{} and {}", quantities.front().text, time_.text),
                        run_, rows_);
    }
    add_legend();
    const std::size_t columns = quantities.size() > 1 && scenes_.size() <= 3 ? scenes_.size() : 0;
    const PanelLayout layout{panels_.size(), columns, true, 7.5};
    if (!place_all_labels(panel_boxes(layout, drawing_.page))) {
      // The note takes room from the panels, so that the names are placed again.
      add_note(drawing_.page.notes, "Some marks have no room for a name; the table has all.");
      place_all_labels(panel_boxes(layout, drawing_.page));
    }
    const std::vector<PageBox> boxes = panel_boxes(layout, drawing_.page);
    draw_panels(panels_, boxes, drawing_);
    return std::move(drawing_);
  }

 private:
  Contest contest_of(const Quantity& y, const std::string& scene) const {
    Contest contest;
    std::vector<Contestant> contestants;
    const metrics::MetricDescription* info = metric_info_of(y.name);
    const bool is_higher_better =
        info != nullptr && info->better == metrics::Better::higher && y.detail.empty();
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      if (groups_[i].scene != scene) continue;
      const std::optional<Estimate> time = run_.estimate(groups_[i].rows.front(), time_);
      const std::optional<Estimate> score = run_.estimate(groups_[i].rows.front(), y);
      if (!time || !score) continue;
      contest.groups.push_back(i);
      contest.points.push_back({*time, *score});
      Estimate error = *score;
      if (is_higher_better) error = {-score->value, -score->high, -score->low, score->count};
      contestants.push_back({*time, error});
    }
    contest.standings = pareto_standings(contestants);
    contest.front = front_of(contestants, contest.standings);
    return contest;
  }

  void add_panel(const Quantity& y, const std::string& scene) {
    Contest contest = contest_of(y, scene);
    if (contest.points.empty()) return;
    LinePanel panel;
    panel.title = scene;
    ChartLine front;
    front.look = LineLook::thin;
    front.color = kSoftInk;
    for (const std::size_t i : contest.front) {
      const Estimate& time = contest.points[i].x;
      // The staircase: until the next row is ready, this one's score is the best.
      if (!front.points.empty()) front.points.push_back({time, front.points.back().y});
      front.points.push_back({time, contest.points[i].y});
    }
    panel.lines.push_back(front);
    for (std::size_t i = 0; i < contest.points.size(); ++i) add_point(contest, i, y, panel);
    std::vector<std::string>& notes = drawing_.page.notes;
    panel.x = axis_of_points(panel.lines, &ChartPoint::x, time_, figure_.is_log_x, notes);
    panel.y = axis_of_points(panel.lines, &ChartPoint::y, y, figure_.is_log_y, notes);
    panels_.push_back(std::move(panel));
    contests_.push_back(std::move(contest));
  }

  void add_point(const Contest& contest, std::size_t i, const Quantity& y, LinePanel& panel) {
    const LineGroup& group = groups_[contest.groups[i]];
    ChartPoint point = contest.points[i];
    const Standing standing = contest.standings[i];
    point.is_hollow = standing == Standing::dominated;
    has_dominated_ = has_dominated_ || point.is_hollow;
    has_undecided_ = has_undecided_ || standing == Standing::undecided;
    ChartLine line = styles_.line_of(group, LineLook::marks_only);
    line.mark = standing == Standing::undecided ? 1 : 0;
    line.points = {point};
    add_to_panel(std::move(line), panel);
    const RowFacts& facts = run_.rows()[group.rows.front()];
    drawing_.table.rows.push_back(
        {y.text, facts.scene, facts.method, facts.budget, point.x.value, point.x.low, point.x.high,
         point.y.value, point.y.low, point.y.high,
         std::string(kStandingNames.at(static_cast<std::size_t>(standing)))});
  }

  /// Points of one look are one line of the script.
  static void add_to_panel(ChartLine line, LinePanel& panel) {
    const auto known = std::find_if(panel.lines.begin(), panel.lines.end(), [&](const auto& other) {
      return other.look == line.look && other.color == line.color && other.mark == line.mark;
    });
    if (known == panel.lines.end()) return panel.lines.push_back(std::move(line));
    known->points.insert(known->points.end(), line.points.begin(), line.points.end());
  }

  void add_legend() {
    const MethodStyles colors(run_);
    const RowNames names(run_, rows_);
    for (const std::string& method : names.base_methods()) {
      drawing_.page.legend.push_back(
          {method, fmt::format("with points lc rgb '{}' pt 7 ps 0.55", colors.color(method))});
    }
    const auto add = [&](const char* label, int mark) {
      drawing_.page.legend.push_back(
          {label, fmt::format("with points lc rgb '{}' pt {} ps 0.55 lw 1.2", kSoftInk, mark)});
    };
    if (has_undecided_) add("beaten, but not clearly", point_type(1));
    if (has_dominated_) add("clearly beaten", point_type(0) - 1);
    drawing_.page.legend.push_back(
        {"Pareto front", fmt::format("with lines lc rgb '{}' lw 0.8", kSoftInk)});
  }

  /// The front and the intervals as thin boxes, which names keep off.
  static std::vector<PageBox> lines_of(const LinePanel& panel, const PageBox& box) {
    std::vector<PageBox> lines;
    const auto x_of = [&](double x) { return box.left + panel.x.position(x) * box.width; };
    const auto y_of = [&](double y) { return box.bottom + panel.y.position(y) * box.height; };
    const auto add = [&](double x0, double y0, double x1, double y1) {
      constexpr double kHalf_cm = 0.02;
      lines.push_back({std::min(x0, x1) - kHalf_cm, std::min(y0, y1) - kHalf_cm,
                       std::abs(x1 - x0) + 2.0 * kHalf_cm, std::abs(y1 - y0) + 2.0 * kHalf_cm});
    };
    for (const ChartLine& line : panel.lines) {
      for (std::size_t i = 0; i < line.points.size(); ++i) {
        const auto& [x, y, is_hollow] = line.points[i];
        if (line.look == LineLook::marks_only) {
          add(x_of(x.value), y_of(y.low), x_of(x.value), y_of(y.high));
          add(x_of(x.low), y_of(y.value), x_of(x.high), y_of(y.value));
        } else if (i > 0) {
          const ChartPoint& before = line.points[i - 1];
          add(x_of(before.x.value), y_of(before.y.value), x_of(x.value), y_of(y.value));
        }
      }
    }
    return lines;
  }

  /// @return whether all marks have names
  bool place_all_labels(const std::vector<PageBox>& boxes) {
    bool has_all = true;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      has_all = place_names(contests_[i], boxes[i], panels_[i]) && has_all;
    }
    return has_all;
  }

  /// Names at the marks, those of the front first. @return whether all have one
  bool place_names(const Contest& contest, const PageBox& box, LinePanel& panel) const {
    std::vector<std::size_t> order = contest.front;
    for (std::size_t i = 0; i < contest.points.size(); ++i) {
      if (contest.standings[i] != Standing::front) order.push_back(i);
    }
    std::vector<LabelledMark> marks;
    for (const std::size_t i : order) {
      const ChartPoint& point = contest.points[i];
      if (!panel.x.has_place(point.x.value) || !panel.y.has_place(point.y.value)) continue;
      marks.push_back({box.left + panel.x.position(point.x.value) * box.width,
                       box.bottom + panel.y.position(point.y.value) * box.height,
                       groups_[contest.groups[i]].method});
    }
    const auto places = place_labels(marks, lines_of(panel, box), box, kSmallPt);
    panel.labels.clear();
    for (std::size_t i = 0; i < marks.size(); ++i) {
      if (!places[i]) continue;
      panel.labels.push_back(
          {places[i]->box, marks[i].x_cm, marks[i].y_cm, places[i]->is_far, marks[i].text, kInk});
    }
    return panel.labels.size() == marks.size();
  }

  const FigureSpec& figure_;
  const FigureRun& run_;
  std::vector<std::size_t> rows_;
  Quantity time_;
  std::vector<LineGroup> groups_;
  LineStyles styles_;
  std::vector<std::string> scenes_;
  std::vector<LinePanel> panels_;
  std::vector<Contest> contests_;
  FigureDrawing drawing_;
  bool has_dominated_ = false;
  bool has_undecided_ = false;
};

}  // namespace

FigureDrawing pareto_figure(const FigureSpec& figure, const FigureRun& run) {
  return ParetoChart(figure, run).draw();
}

}  // namespace results::figures
