#pragma once

#include <string>
#include <vector>

#include "perception/image.h"
#include "results/csv_table.h"
#include "results/figures/figure_spec.h"

namespace results::figures {

/// A rectangle on the page, cm from its lower left corner.
struct PageBox {
  double left = 0.0, bottom = 0.0, width = 0.0, height = 0.0;
  double right() const { return left + width; }
  double top() const { return bottom + height; }
  double center_x() const { return left + 0.5 * width; }
  double center_y() const { return bottom + 0.5 * height; }
};

/// Sizes of text, pt.
inline constexpr double kTitlePt = 10.0;
inline constexpr double kTextPt = 9.0;
inline constexpr double kSmallPt = 7.5;

/// A sample of a line or mark and what it stands for.
struct LegendEntry {
  std::string label;
  std::string style;  ///< gnuplot: "with lines lc rgb '#0072b2'"
};

/// What stands around a figure's content: title above, legend and notes below.
struct FigurePage {
  double width_cm = 16.0;
  double height_cm = 10.0;
  bool has_height = false;  ///< whether the suite says the height
  std::string title;
  std::vector<LegendEntry> legend;
  std::vector<std::string> notes;  ///< sentences

  FigurePage() = default;
  explicit FigurePage(const FigureSpec& figure);
  /// What title, legend and notes leave.
  PageBox content() const;
  double height_around_content() const;  ///< of title, legend and notes together
  /// Makes room for content of at least this height, unless the suite says the height.
  void make_room(double content_cm);
  /// @throws base::InputError if the suite's height leaves less than this for the content
  void require_room(double content_cm) const;
};

/// A picture that the script places; written beside it.
struct PictureFile {
  std::string name;         ///< within the figure's folder of pictures
  perception::Image image;  ///< encoding display
};

/// Everything that a figure is made from.
struct FigureDrawing {
  FigurePage page;
  std::string data;      ///< gnuplot data blocks
  std::string commands;  ///< of the content, repeated for each format
  CsvTable table;
  std::vector<PictureFile> pictures;
};

/// Commands that make a box the plot area, with nothing outside of it but what is set later.
std::string plot_area(const PageBox& box, const FigurePage& page);
/// The same with cm of the page as both axes, and neither border nor ticks.
std::string page_area(const FigurePage& page);

enum class Align { left, center, right };
/// How a text stands on the page.
struct TextStyle {
  Align align = Align::left;
  double font_pt = kTextPt;
  const char* color = "#1b1f24";
  bool is_upright = false;  ///< turned by 90 degrees
};
/// A label at a place of the page. @param text  a gnuplot string
std::string text_at(double x_cm, double y_cm, const std::string& text, const FigurePage& page,
                    const TextStyle& style = {});

/// The whole script. It writes <id>.pdf and <id>.svg into the folder it runs in, or only the
/// formats that `gnuplot -e "formats='pdf'"` names.
/// @param comments  lines about where the figure comes from
std::string figure_script(const std::string& id, const FigureDrawing& drawing,
                          const std::vector<std::string>& comments);

}  // namespace results::figures
