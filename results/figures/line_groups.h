#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "results/figures/figure_page.h"
#include "results/figures/figure_run.h"
#include "results/figures/line_chart.h"

namespace results::figures {

/// Rows that one line of a chart joins.
struct LineGroup {
  std::string base_method;
  std::string method;  ///< what the legend says: "val[vpls=1024]"
  std::string scene;
  std::vector<std::size_t> rows;  ///< in the run's order
};

/// Which rows belong to one line over x.
///
/// Over a parameter: those of a method and scene that differ in nothing else that is swept, and not
/// in the budget. Over a counter: those of a method and budget. Over a field of the record (a time,
/// samples): those of a method with all its swept values, whatever their budget.
std::vector<LineGroup> line_groups(const std::vector<std::size_t>& rows, const FigureRun& run,
                                   const Quantity& x);
/// A line per row.
std::vector<LineGroup> single_row_groups(const std::vector<std::size_t>& rows,
                                         const FigureRun& run);

/// Colours, marks and dashes of lines: the colour is the method's in every figure of the suite, the
/// mark tells lines of a method apart, the dash the scenes.
class LineStyles {
 public:
  LineStyles(const std::vector<LineGroup>& groups, const FigureRun& run);
  /// A line without points.
  ChartLine line_of(const LineGroup& group, LineLook look) const;
  /// Entries for the methods, for those of many settings one each, then for the scenes if there are
  /// several.
  std::vector<LegendEntry> legend(LineLook look) const;
  const std::vector<std::string>& scenes() const { return scenes_; }
  /// Whether a legend of every setting would be larger than the chart.
  bool has_many_methods() const;

 private:
  struct Method {
    std::string base;
    std::string name;
    std::string color;
    std::size_t mark = 0;
  };
  std::vector<Method> methods_;
  std::vector<std::string> scenes_;
};

}  // namespace results::figures
