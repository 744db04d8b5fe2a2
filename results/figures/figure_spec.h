#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "perception/base/document.h"
#include "perception/base/errors.h"

namespace results::figures {

/// What a figure shows; README.md has an example of each.
enum class FigureKind {
  error_vs_parameter,  ///< quantities over a swept value, a counter or a record's field
  error_vs_time,       ///< scores over time, with the curves of checkpoints
  error_chain,         ///< a score along the steps of an approximation, and what each step adds
  pareto,              ///< score against time: which rows are beaten in both
  stage_stack,         ///< stages of the time, one bar per row
  image_grid,          ///< reference and renderings side by side
  false_colour,        ///< error maps on the metric's fixed scale
  series               ///< quantities over the frames of a sequence
};
inline constexpr std::array<const char*, 8> kFigureKindNames{
    "error-vs-parameter", "error-vs-time", "error-chain",  "pareto",
    "stage-stack",        "image-grid",    "false-colour", "series"};
std::string to_string(FigureKind kind);

/// A text of the suite and where it stands.
struct PlacedText {
  std::string text;
  base::Place place;
};

/// A part of an image, as fractions of its width and height from the upper left corner.
struct FigureCrop {
  double x = 0.0, y = 0.0, width = 1.0, height = 1.0;
};

/// One entry of `figures:` of a suite.
struct FigureSpec {
  FigureKind kind = FigureKind::error_vs_parameter;
  std::string id;     ///< path-safe
  std::string title;  ///< "" for none
  base::Place place;
  std::vector<PlacedText> methods;  ///< row selectors; empty: all rows
  std::vector<PlacedText> scenes;   ///< ids, with or without sweep values; empty: all
  std::vector<PlacedText> budgets;  ///< empty: all
  PlacedText x;                     ///< quantity; "" for the kind's own
  std::vector<PlacedText> y;        ///< quantities
  std::optional<bool> is_log_x;     ///< absent: chosen by the values
  std::optional<bool> is_log_y;
  PlacedText metric;       ///< of false-colour
  std::string against;     ///< of image-grid and false-colour: own | full
  double width_cm = 16.0;  ///< of the whole figure
  double height_cm = 10.0;
  bool has_height =
      false;  ///< whether the suite says the height; else pictures take what they need
  std::vector<FigureCrop> crops;
};

/// Reads the list `figures:` of a suite.
/// @throws base::InputError with the place for what is unknown, missing or out of range
std::vector<FigureSpec> read_figures(const base::Node& list);

/// The figure as the reader takes it; places are left out.
nlohmann::ordered_json to_json(const FigureSpec& figure);
/// @param json  a list of what `to_json` gives @param file  names it in messages
/// @throws base::InputError as `read_figures`
std::vector<FigureSpec> figures_from_json(const nlohmann::ordered_json& json,
                                          const std::string& file);

}  // namespace results::figures
