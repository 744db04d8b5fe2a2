#pragma once

#include <array>

#include "metrics/metric.h"

/// Colour difference CIEDE2000.
///
/// Source: Sharma, Wu, Dalal 2005, The CIEDE2000 Color-Difference Formula: Implementation Notes,
/// Supplementary Test Data, and Mathematical Observations, Color Research and Application 30(1),
/// doi:10.1002/col.20070 (equation numbers recalled from memory).
namespace metrics {

/// CIE 1976 L*, a*, b*.
using Lab = std::array<double, 3>;

/// Delta E_00 with parametric weights of 1; 0 for equal colours, about 1 for a difference that is
/// just noticed between large patches side by side. Exchange of the colours changes nothing.
double ciede2000(const Lab& first, const Lab& second);

MetricInfo delta_e_2000_info();

}  // namespace metrics
