#include "results/figures/figure_colors.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "results/figures/figure_rows.h"

namespace results::figures {

namespace {

/// Blue, vermillion, bluish green, reddish purple, orange, sky blue, black.
constexpr std::array<const char*, kPaletteSize> kPalette{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                         "#e69f00", "#56b4e9", "#000000"};

constexpr std::array<std::pair<std::string_view, const char*>, 13> kStageColors{{
    {"scene_update", "#999933"},
    {"build", "#d3b84c"},
    {"lights", "#ee8866"},
    {"cluster", "#aa4499"},
    {"shadow", "#6467b5"},
    {"visibility", "#4477aa"},
    {"transport", "#44aa99"},
    {"gather", "#66bbe0"},
    {"filter", "#2f8a4a"},
    {"upsample", "#cc6677"},
    {"masking", "#99406f"},
    {"readback", "#a9b0b8"},
    {"unattributed", "#ffffff"},
}};
constexpr const char* kOtherStage = "#8795a5";

}  // namespace

const char* palette_color(std::size_t index) { return kPalette.at(index % kPaletteSize); }

MethodStyles::MethodStyles(const FigureRun& run) {
  for (const std::string& method : run.summary().methods) {
    add_once(base_methods_, method.substr(0, method.find('[')));
  }
}

const char* MethodStyles::color(const std::string& base_method) const {
  return palette_color(index_in(base_methods_, base_method));
}

std::size_t MethodStyles::round(const std::string& base_method) const {
  return index_in(base_methods_, base_method) / kPaletteSize;
}

std::string lightened(const std::string& color, std::size_t steps) {
  constexpr double kStep = 0.68;  // of the distance to white that is left
  const double kept = std::pow(kStep, static_cast<double>(steps));
  std::string result = "#";
  for (const std::size_t begin : {1U, 3U, 5U}) {
    const int value = std::stoi(color.substr(begin, 2), nullptr, 16);
    result += fmt::format("{:02x}", std::lround(255.0 - kept * (255.0 - value)));
  }
  return result;
}

const char* stage_color(std::string_view name) {
  for (const auto& [stage, color] : kStageColors) {
    if (stage == name) return color;
  }
  return kOtherStage;
}

int point_type(std::size_t index) {
  // Disc, square, triangle up, triangle down, diamond, pentagon.
  constexpr std::array<int, 6> kFilledMarks{7, 5, 9, 11, 13, 15};
  return kFilledMarks.at(index % kFilledMarks.size());
}

int dash_type(std::size_t index) {
  constexpr std::array<int, 4> kDashes{1, 4, 3, 5};
  return kDashes.at(index % kDashes.size());
}

}  // namespace results::figures
