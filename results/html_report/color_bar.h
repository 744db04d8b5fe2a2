#pragma once

#include <string>

#include "perception/false_color.h"

namespace results::html_report {

/// The colours of error maps as an SVG gradient that every colour bar of the page refers to.
std::string color_bar_gradient();

/// A colour bar with ticks and unit; the same scale gives the same bar on every page.
std::string color_bar(const perception::MapScale& scale);

}  // namespace results::html_report
