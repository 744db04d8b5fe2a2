#pragma once

#include <string_view>
#include <vector>

#include "metrics/metric.h"

namespace metrics {

/// A rectangle in shares of the image's width and height, so that images of other sizes measure the
/// same place. (0, 0) is the corner at the top left, (1, 1) that at the bottom right.
struct ImageRegion {
  double x = 0.0, y = 0.0, width = 1.0, height = 1.0;
};

/// The parameters `x`, `y`, `width` and `height`; by default the whole image.
std::vector<base::ParameterSpec> region_parameters();

/// The region of a metric's parameters.
/// @param metric  name for the message
/// @throws base::InputError for a region that reaches beyond the image
ImageRegion read_region(const base::Parameters& parameters, std::string_view metric);

/// A mask of the pixels whose centre lies in the region and that take part in the mask; regions
/// that tile the image tile its pixels.
/// @param like  size of the mask @param mask  null: every pixel takes part
/// @throws base::InputError if no pixel is left
Image region_mask(const ImageRegion& region, const Image& like, const Image* mask,
                  std::string_view metric);

}  // namespace metrics
