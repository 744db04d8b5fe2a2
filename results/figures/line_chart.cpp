#include "results/figures/line_chart.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "results/figures/figure_colors.h"
#include "results/figures/gnuplot_text.h"

namespace results::figures {

namespace {

// Room around a plot area for ticks and titles, cm.
constexpr double kLeft_cm = 1.75;
constexpr double kRight_cm = 0.35;
constexpr double kAbove_cm = 0.6;
constexpr double kBelow_cm = 1.15;
constexpr double kLeastPanel_cm = 6.5;  ///< width of a panel before they go side by side

/// The end of an interval; where it has no place on the axis, the axis' end.
double placed(double value, const ChartAxis& axis) {
  return axis.has_place(value) ? value : axis.low;
}

std::string data_block(const std::string& name, const ChartLine& line, const LinePanel& panel) {
  std::string block = fmt::format("${} << end\n", name);
  std::size_t rows = 0;
  for (const ChartPoint& point : line.points) {
    if (!panel.x.has_place(point.x.value) || !panel.y.has_place(point.y.value)) {
      block += "\n";
      continue;
    }
    ++rows;
    block += fmt::format("{} {} {} {} {} {} {}\n", point.x.value, point.y.value,
                         placed(point.x.low, panel.x), point.x.high, placed(point.y.low, panel.y),
                         point.y.high, point.is_hollow ? 1 : 0);
  }
  return rows == 0 ? "" : block + "end\n";
}

/// Intervals: lines that end in a short stroke.
constexpr const char* kBars = "with vectors heads size screen 0.004,90 lw 1";

bool has_bars(const ChartLine& line, Estimate ChartPoint::*side) {
  return std::any_of(line.points.begin(), line.points.end(), [&](const ChartPoint& point) {
    const Estimate& value = point.*side;
    return value.low < value.value || value.high > value.value;
  });
}

std::vector<std::string> mark_plots(const std::string& block, const ChartLine& line) {
  std::vector<std::string> plots;
  const std::string color = fmt::format("lc rgb '{}'", line.color);
  if (line.look == LineLook::marks_and_bars && line.points.size() > 1) {
    plots.push_back(fmt::format("${} using 1:2 with lines {} dt {} lw 1.6 notitle", block, color,
                                dash_type(line.dash)));
  }
  if (has_bars(line, &ChartPoint::x)) {
    plots.push_back(fmt::format("${} using 3:2:($4-$3):(0) {} {} notitle", block, kBars, color));
  }
  if (has_bars(line, &ChartPoint::y)) {
    plots.push_back(fmt::format("${} using 1:5:(0):($6-$5) {} {} notitle", block, kBars, color));
  }
  const int mark = point_type(line.mark);
  const bool has_hollow = std::any_of(line.points.begin(), line.points.end(),
                                      [](const ChartPoint& point) { return point.is_hollow; });
  if (has_hollow) {
    // A white mark under the outline hides the lines that it stands on.
    plots.push_back(
        fmt::format("${} using 1:($7 == 1 ? $2 : NaN) with points lc rgb '#ffffff' "
                    "pt {} ps 0.55 notitle",
                    block, mark));
    plots.push_back(
        fmt::format("${} using 1:($7 == 1 ? $2 : NaN) with points {} pt {} ps 0.55 "
                    "lw 1.2 notitle",
                    block, color, mark - 1));
  }
  plots.push_back(
      fmt::format("${} using 1:($7 == 1 ? NaN : $2) with points {} pt {} ps 0.55 "
                  "notitle",
                  block, color, mark));
  return plots;
}

std::vector<std::string> line_plots(const std::string& block, const ChartLine& line) {
  const std::string color = fmt::format("lc rgb '{}'", line.color);
  switch (line.look) {
    case LineLook::band:
      return {fmt::format("${} using 1:5:6 with filledcurves {} fs transparent solid 0.18 noborder "
                          "notitle",
                          block, color),
              fmt::format("${} using 1:2 with lines {} dt {} lw 1.6 notitle", block, color,
                          dash_type(line.dash))};
    case LineLook::thin:
      return {fmt::format("${} using 1:2 with lines {} dt {} lw 0.8 notitle", block, color,
                          dash_type(line.dash))};
    case LineLook::floor:
      return {fmt::format("${} using 1:2 with lines {} dt 2 lw 1.2 notitle", block, color)};
    case LineLook::marks_and_bars:
    case LineLook::marks_only:
      break;
  }
  return mark_plots(block, line);
}

std::string labels_of(const LinePanel& panel, const FigurePage& page) {
  std::string commands;
  for (const ChartLabel& label : panel.labels) {
    commands += text_at(label.box.left, label.box.center_y(), gnuplot_string(label.text), page,
                        {Align::left, kSmallPt, label.color});
    if (!label.has_leader) continue;
    const double x = std::clamp(label.mark_x_cm, label.box.left, label.box.right());
    const double y = std::clamp(label.mark_y_cm, label.box.bottom, label.box.top());
    commands += fmt::format(
        "set arrow from screen {:.5f}, screen {:.5f} to screen {:.5f}, screen "
        "{:.5f} nohead lc rgb '{}' lw 0.6\n",
        label.mark_x_cm / page.width_cm, label.mark_y_cm / page.height_cm, x / page.width_cm,
        y / page.height_cm, kFaintInk);
  }
  return commands;
}

}  // namespace

std::vector<PageBox> panel_boxes(const PanelLayout& layout, FigurePage& page) {
  const std::size_t count = layout.count;
  std::size_t columns = layout.columns;
  if (columns == 0) {
    const double fitting = std::max(1.0, page.content().width / kLeastPanel_cm);
    columns = std::min(static_cast<std::size_t>(fitting), count);
    if (count > columns) columns = std::min(columns, (count + 1) / 2);
  }
  const std::size_t rows = (count + columns - 1) / columns;
  page.make_room(layout.row_cm * static_cast<double>(rows));
  constexpr double kLeastRow_cm = 3.0;
  page.require_room(kLeastRow_cm * static_cast<double>(rows));
  const PageBox content = page.content();
  const double width = content.width / static_cast<double>(columns);
  const double height = content.height / static_cast<double>(rows);
  const double above = layout.has_titles ? kAbove_cm : 0.25;
  std::vector<PageBox> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const double left = content.left + width * static_cast<double>(i % columns);
    const double top = content.top() - height * static_cast<double>(i / columns);
    boxes.push_back({left + kLeft_cm, top - height + kBelow_cm, width - kLeft_cm - kRight_cm,
                     height - above - kBelow_cm});
  }
  return boxes;
}

std::string panel_frame(const std::string& title, const ChartAxis* x, const ChartAxis* y,
                        const PageBox& box, const FigurePage& page) {
  std::string commands =
      plot_area(box, page) + fmt::format(
                                 "set border 3 lc rgb '{}'\nset tics out scale 0.5 font ',{}'\n"
                                 "set grid xtics ytics lc rgb '{}' lw 0.7 dt 1\n",
                                 kSoftInk, kSmallPt, kGridColor);
  if (x != nullptr) {
    commands += axis_commands('x', *x);
    commands += text_at(box.center_x(), box.bottom - 0.85, gnuplot_string(x->title), page,
                        {Align::center, kTextPt});
  }
  if (y != nullptr) {
    commands += axis_commands('y', *y);
    const double room_cm = box.height + 0.8;
    const double font_pt = text_width_cm(y->title, kTextPt) > room_cm ? kSmallPt : kTextPt;
    commands += text_at(box.left - kLeft_cm + 0.25, box.center_y(),
                        gnuplot_string(shortened(y->title, room_cm, font_pt)), page,
                        {Align::center, font_pt, kInk, true});
  }
  if (!title.empty()) {
    commands += text_at(box.center_x(), box.top() + 0.3,
                        gnuplot_string(shortened(title, box.width + kLeft_cm, kTextPt)), page,
                        {Align::center, kTextPt});
  }
  return commands;
}

void draw_panels(const std::vector<LinePanel>& panels, const std::vector<PageBox>& boxes,
                 FigureDrawing& drawing) {
  std::size_t blocks = 0;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const LinePanel& panel = panels[i];
    std::string plots;
    for (const ChartLine& line : panel.lines) {
      const std::string name = fmt::format("line{}", ++blocks);
      const std::string block = data_block(name, line, panel);
      if (block.empty()) continue;
      drawing.data += block;
      for (const std::string& plot : line_plots(name, line)) {
        plots += (plots.empty() ? "plot " : ", \\\n  ") + plot;
      }
    }
    drawing.commands += fmt::format("# Panel {}\n", i + 1);
    drawing.commands += panel_frame(panel.title, &panel.x, &panel.y, boxes[i], drawing.page);
    drawing.commands += labels_of(panel, drawing.page);
    drawing.commands += plots.empty() ? "plot NaN notitle\n" : plots + "\n";
  }
}

}  // namespace results::figures
