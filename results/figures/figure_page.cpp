#include "results/figures/figure_page.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "results/figures/figure_colors.h"
#include "results/figures/gnuplot_text.h"

namespace results::figures {

namespace {

constexpr double kTitle_cm = 0.75;
constexpr double kLegendRow_cm = 0.45;
constexpr double kLegendSample_cm = 1.3;  ///< with the space around it
constexpr double kNoteLine_cm = 0.36;
constexpr double kEdge_cm = 0.15;
constexpr double kSvgPixels_per_cm = 96.0 / 2.54;
constexpr double kPngDpi = 110.0;

int legend_columns(const FigurePage& page) {
  double widest_cm = 1.0;
  for (const LegendEntry& entry : page.legend) {
    widest_cm = std::max(widest_cm, text_width_cm(entry.label, kTextPt) + kLegendSample_cm);
  }
  const int fitting = static_cast<int>((page.width_cm - 2.0 * kEdge_cm) / widest_cm);
  return std::clamp(fitting, 1, std::max(1, static_cast<int>(page.legend.size())));
}

double legend_cm(const FigurePage& page) {
  if (page.legend.empty()) return 0.0;
  const double columns = legend_columns(page);
  return kLegendRow_cm * std::ceil(static_cast<double>(page.legend.size()) / columns) + 0.1;
}

/// Notes as lines that fit the page.
std::vector<std::string> note_lines(const FigurePage& page) {
  std::vector<std::string> lines;
  for (const std::string& note : page.notes) {
    std::string line;
    std::size_t begin = 0;
    while (begin < note.size()) {
      const std::size_t end = std::min(note.find(' ', begin), note.size());
      const std::string word = note.substr(begin, end - begin);
      const std::string longer = line.empty() ? word : line + " " + word;
      if (!line.empty() && text_width_cm(longer, kSmallPt) > page.width_cm - 0.8) {
        lines.push_back(line);
        line = word;
      } else {
        line = longer;
      }
      begin = end + 1;
    }
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

double notes_cm(const FigurePage& page) {
  return kNoteLine_cm * static_cast<double>(note_lines(page).size());
}

/// The page's own texts and the legend, in a last plot of their own.
std::string frame_commands(const FigurePage& page) {
  std::string commands = "# Title, notes and legend\n" + page_area(page);
  if (!page.title.empty()) {
    commands += text_at(0.5 * page.width_cm, page.height_cm - 0.45 * kTitle_cm,
                        gnuplot_bold_string(page.title), page, {Align::center, kTitlePt});
  }
  const std::vector<std::string> lines = note_lines(page);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double above = static_cast<double>(lines.size() - i) - 0.5;
    commands += text_at(0.4, kEdge_cm + kNoteLine_cm * above, gnuplot_string(lines[i]), page,
                        {Align::left, kSmallPt, kSoftInk});
  }
  if (page.legend.empty()) return commands + "plot -1 notitle\n";
  commands += fmt::format(
      "set key at screen 0.5, screen {:.5f} center center horizontal "
      "maxcols {} Left reverse samplen 2.5 font ',{}'\n",
      (kEdge_cm + notes_cm(page) + 0.5 * legend_cm(page)) / page.height_cm, legend_columns(page),
      kTextPt);
  commands += "plot -1 notitle";
  for (const LegendEntry& entry : page.legend) {
    commands +=
        fmt::format(", \\\n  keyentry {} title {}", entry.style, gnuplot_string(entry.label));
  }
  return commands + "\nunset key\n";
}

}  // namespace

FigurePage::FigurePage(const FigureSpec& figure)
    : width_cm(figure.width_cm),
      height_cm(figure.height_cm),
      has_height(figure.has_height),
      title(figure.title) {}

double FigurePage::height_around_content() const {
  return 2.0 * kEdge_cm + (title.empty() ? 0.0 : kTitle_cm) + legend_cm(*this) + notes_cm(*this);
}

void FigurePage::make_room(double content_cm) {
  if (!has_height) height_cm = std::max(height_cm, height_around_content() + content_cm);
}

void FigurePage::require_room(double content_cm) const {
  if (content().height >= content_cm) return;
  throw base::InputError(
      fmt::format("size_cm: a height of {} cm leaves no room beside title, "
                  "legend and notes; accepted here: at least {:.1f}",
                  height_cm, height_around_content() + content_cm));
}

PageBox FigurePage::content() const {
  const double below = kEdge_cm + legend_cm(*this) + notes_cm(*this);
  return {kEdge_cm, below, width_cm - 2.0 * kEdge_cm, height_cm - height_around_content()};
}

std::string plot_area(const PageBox& box, const FigurePage& page) {
  return fmt::format(
      "unset label\nunset object\nunset arrow\nunset key\n"
      "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\n"
      "set bmargin at screen {:.5f}\nset tmargin at screen {:.5f}\n",
      box.left / page.width_cm, box.right() / page.width_cm, box.bottom / page.height_cm,
      box.top() / page.height_cm);
}

std::string page_area(const FigurePage& page) {
  return plot_area({0.0, 0.0, page.width_cm, page.height_cm}, page) +
         fmt::format(
             "unset border\nunset tics\nunset grid\nunset logscale\n"
             "set xrange [0:{}]\nset yrange [0:{}]\n",
             page.width_cm, page.height_cm);
}

std::string text_at(double x_cm, double y_cm, const std::string& text, const FigurePage& page,
                    const TextStyle& style) {
  static constexpr std::array<const char*, 3> kAligns{"left", "center", "right"};
  return fmt::format(
      "set label {} at screen {:.5f}, screen {:.5f} {}{} font ',{}' tc rgb '{}' "
      "front\n",
      text, x_cm / page.width_cm, y_cm / page.height_cm,
      kAligns.at(static_cast<std::size_t>(style.align)), style.is_upright ? " rotate by 90" : "",
      style.font_pt, style.color);
}

// Terminals take points for pixels of theirs: 96 per inch in a PDF and a PNG, and, in a SVG, as
// pixels.
std::string figure_script(const std::string& id, const FigureDrawing& drawing,
                          const std::vector<std::string>& comments) {
  const FigurePage& page = drawing.page;
  std::string script;
  for (const std::string& comment : comments) script += "# " + gnuplot_comment(comment) + "\n";
  script += fmt::format("# Run in this folder: gnuplot {}.gp\n\n{}", id, drawing.data);
  script += fmt::format(
      "if (!exists('formats')) formats = 'pdf svg'\n"
      "set encoding utf8\n"
      "do for [format in formats] {{\n"
      "if (format eq 'pdf') {{\n"
      "set terminal pdfcairo enhanced size {}cm,{}cm font 'DejaVu Sans,{}' fontscale 0.75 rounded\n"
      "}} else {{ if (format eq 'png') {{\n"
      "set terminal pngcairo enhanced size {:.0f},{:.0f} font 'DejaVu Sans,{}' fontscale {} "
      "linewidth {} background '#ffffff' rounded\n"
      "}} else {{\n"
      "set terminal svg enhanced size {:.0f},{:.0f} font 'DejaVu Sans,{}' fontscale {:.4f} "
      "background '#ffffff' rounded\n"
      "}}}}\n"
      "set output {}.format\n"
      "set multiplot\n",
      page.width_cm, page.height_cm, kTextPt, page.width_cm * kPngDpi / 2.54,
      page.height_cm * kPngDpi / 2.54, kTextPt, kPngDpi / 96.0, kPngDpi / 96.0,
      page.width_cm * kSvgPixels_per_cm, page.height_cm * kSvgPixels_per_cm, kTextPt, 96.0 / 72.0,
      gnuplot_string(id + "."));
  script += drawing.commands + frame_commands(page);
  return script + "unset multiplot\nunset output\n}\n";
}

}  // namespace results::figures
