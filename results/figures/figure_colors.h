#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "results/figures/figure_run.h"

namespace results::figures {

/// Colours that colour-blind readers tell apart, "#rrggbb": the palette of Wong 2011, "Points of
/// view: Color blindness", doi:10.1038/nmeth.1618, less its yellow, which is too light for lines on
/// white, black last.
inline constexpr std::size_t kPaletteSize = 7;
const char* palette_color(std::size_t index);  ///< any index; begins again after kPaletteSize
inline constexpr const char* kInk = "#1b1f24";
inline constexpr const char* kSoftInk = "#5d6672";
inline constexpr const char* kFaintInk = "#9aa4b1";
inline constexpr const char* kGridColor = "#dde1e7";

/// The colour of a method, and a dash where methods have to share colours: by its place among the
/// methods of the run, so that it is the same in every figure of a suite.
class MethodStyles {
 public:
  explicit MethodStyles(const FigureRun& run);
  const char* color(const std::string& base_method) const;
  /// 0 for the first kPaletteSize methods, 1 for the next ones, ...
  std::size_t round(const std::string& base_method) const;

 private:
  std::vector<std::string> base_methods_;
};

/// A colour nearer to white. @param steps  0: as it is
std::string lightened(const std::string& color, std::size_t steps);

/// Colour of a stage: that of the HTML report's bars (results/html_report/report.css).
const char* stage_color(std::string_view name);

/// gnuplot's number of a filled mark and of a dash; any index.
int point_type(std::size_t index);
int dash_type(std::size_t index);

}  // namespace results::figures
