#pragma once

#include "metrics/metric.h"

namespace metrics {

/// `leak`: light where the reference has none, such as behind a wall or in a contact shadow; ours.
///
/// With Y the scene-linear luminance and m the reference's mean luminance over the whole image (its
/// mask's pixels), a pixel is dark if Y(reference) <= dark m. Its leak is max(0, Y(test) -
/// Y(reference)) if it is dark, else 0. The value is the mean leak over the region's pixels / m: of
/// the whole image, the leaked light as a share of all light the reference has.
///
/// Details: `leaked_share`, the region's leak as a share of all light the reference has in the
/// image; `dark_share` of the region's pixels, 0 if there was nothing to leak into; `dark_mean`,
/// mean leak of the dark pixels / m, 0 if there are none; `energy_error`, (sum of the test - sum of
/// the reference) / sum of the reference over the region, signed; `reference_mean`, m.
/// The value is NaN for a black reference (m <= 0) into which light leaks, `energy_error` for a
/// black region.
MetricInfo leak_info();

}  // namespace metrics
