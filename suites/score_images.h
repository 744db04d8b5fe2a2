#pragma once

#include <optional>
#include <string>
#include <vector>

#include "perception/image_file.h"
#include "suites/reference_images.h"
#include "suites/suite_metrics.h"

namespace suites {

/// What a metric of the suite compares: the radiance or an AOV, R, G, B, scaled.
///
/// @param parts  of a stored picture, radiance first
/// @throws base::InputError if it has no such AOV, naming those it has
perception::Image seen_picture(const SuiteMetric& metric,
                               const std::vector<perception::NamedImage>& parts);
perception::Image seen_reference(const SuiteMetric& metric, const Reference& reference,
                                 renderers::Part part);

/// The pixels that take part, one channel of 0 and 1; nothing if all do.
/// @throws base::InputError if the reference has no such AOV, or the file cannot be read
std::optional<perception::Image> mask_image(const SuiteMetric& metric, const Reference& reference);

/// Of a mask file's bytes, so that another file makes other scores; "" without one.
/// @throws base::InputError if it cannot be read
std::string mask_file_hash(const SuiteMetric& metric);

/// Pixels at most `distance_px` away, in either direction, from a step of the image: from two
/// neighbours, side by side or one above the other, that differ by more than 0.5 in a channel.
/// @return one channel of 0 and 1
perception::Image near_steps(const perception::Image& image, int distance_px);

}  // namespace suites
