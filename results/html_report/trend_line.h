#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "results/history/history_output.h"

namespace results::html_report {

/// Where a run stands on the axis of all lines of a page: runs by when they began, evenly spaced.
using RunPlaces = std::map<std::string, std::size_t>;

/// A value as the page prints it, with its unit.
std::string trend_value(const std::string& unit, const Estimate& value);
/// "+12.3 %"; the difference where a value is not above 0.
std::string trend_change(double before, double after);
/// Whether a step is for the worse, by what is better of its quantity.
bool is_for_the_worse(const history::Series& series, const history::Step& step);

/// A small picture (SVG) of a quantity of a row over runs: values with their intervals, the levels
/// between steps, each step coloured by whether it is for the worse. The scale spans at least
/// kLeastSpan of the median to both sides of it (ours), so that noise does not look like news.
/// Every point tells its run, time, commit and value.
/// @param places  of every run of the series
std::string trend_line(const history::Trend& trend, const RunPlaces& places);
inline constexpr double kLeastSpan = 0.1;

}  // namespace results::html_report
