#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "results/figures/chart_axis.h"
#include "results/figures/figure_page.h"
#include "results/statistics.h"

namespace results::figures {

/// A point with the intervals of both its values.
struct ChartPoint {
  Estimate x;
  Estimate y;
  bool is_hollow = false;
};

/// How a line is drawn.
enum class LineLook {
  marks_and_bars,  ///< joined marks, with bars of the intervals of x and y
  marks_only,      ///< the same, not joined
  band,            ///< a line in the band of its interval
  thin,            ///< a faint line without marks
  floor            ///< a dashed line: the reference's own noise
};

struct ChartLine {
  LineLook look = LineLook::marks_and_bars;
  std::string color;
  std::size_t mark = 0;  ///< of point_type
  std::size_t dash = 0;  ///< of dash_type
  std::vector<ChartPoint> points;
};

/// A text beside a place of the panel.
struct ChartLabel {
  PageBox box;
  double mark_x_cm = 0.0, mark_y_cm = 0.0;  ///< what it is the name of
  bool has_leader = false;                  ///< a line leads from the mark to it
  std::string text;
  const char* color = "";
};

struct LinePanel {
  std::string title;
  ChartAxis x;
  ChartAxis y;
  std::vector<ChartLine> lines;
  std::vector<ChartLabel> labels;
};

/// How panels share a page.
struct PanelLayout {
  std::size_t count = 1;
  std::size_t columns = 0;  ///< 0: chosen by the page's width
  bool has_titles = true;
  double row_cm = 6.0;  ///< height of a row that the page makes room for
};

/// Where the plot areas of panels are, from the upper left, row by row.
std::vector<PageBox> panel_boxes(const PanelLayout& layout, FigurePage& page);

/// Adds the panels' data and commands. @param boxes  one per panel
void draw_panels(const std::vector<LinePanel>& panels, const std::vector<PageBox>& boxes,
                 FigureDrawing& drawing);

/// Adds a panel's title, axes and their titles, for a plot to follow.
std::string panel_frame(const std::string& title, const ChartAxis* x, const ChartAxis* y,
                        const PageBox& box, const FigurePage& page);

}  // namespace results::figures
