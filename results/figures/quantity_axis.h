#pragma once

#include <optional>
#include <string>
#include <vector>

#include "results/figures/figure_run.h"
#include "results/figures/line_chart.h"

namespace results::figures {

/// Whether an axis is logarithmic: as the figure says, else errors (scores that are 0 for identical
/// images) that are all above 0, and other numbers that span more than a factor of ten.
bool is_log_axis(std::optional<bool> asked, const Quantity& quantity,
                 const std::vector<double>& values);

/// The axis of one side of the points: over values and intervals, and over the noise floors where
/// they are not far from the values.
/// @param notes  gets a sentence for values that have no place on the axis
ChartAxis axis_of_points(const std::vector<ChartLine>& lines, Estimate ChartPoint::*side,
                         const Quantity& quantity, std::optional<bool> asked,
                         std::vector<std::string>& notes);

/// The noise floor of a row's score; nothing for what is no score or a detail of one.
std::optional<double> noise_floor_of(const FigureRun& run, std::size_t row,
                                     const Quantity& quantity);

/// Adds a sentence that is not there yet.
void add_note(std::vector<std::string>& notes, const std::string& note);

}  // namespace results::figures
