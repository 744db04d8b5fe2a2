#include "metrics/image_region.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "metrics/score_pooling.h"
#include "perception/base/errors.h"

namespace metrics {
namespace {

/// What decimal shares lose in binary; it must not move a border.
constexpr double kRounding = 1e-9;
/// A pixel of an image 10,000 pixels wide.
constexpr double kSmallestShare = 1e-4;

/// First pixel whose centre is not before a position given as a share of the side.
int first_pixel_from(double share, int side_px) {
  return static_cast<int>(std::ceil(share * side_px - 0.5 - kRounding * side_px));
}

void require_inside(double begin, double length, const char* begin_name, const char* length_name,
                    std::string_view metric) {
  if (begin + length <= 1.0 + kRounding) return;
  throw base::InputError(
      fmt::format("metric \"{}\": {} + {} of the region is {:.6g}; accepted: at most 1", metric,
                  begin_name, length_name, begin + length));
}

}  // namespace

std::vector<base::ParameterSpec> region_parameters() {
  return {base::real_parameter("x", 0.0, {0.0, 1.0}, "image widths",
                               "Left side of the region that is judged; ours: all of the image."),
          base::real_parameter("y", 0.0, {0.0, 1.0}, "image heights",
                               "Upper side of the region, from the top; ours: all of the image."),
          base::real_parameter("width", 1.0, {kSmallestShare, 1.0}, "image widths",
                               "Width of the region; ours: all of the image."),
          base::real_parameter("height", 1.0, {kSmallestShare, 1.0}, "image heights",
                               "Height of the region; ours: all of the image.")};
}

ImageRegion read_region(const base::Parameters& parameters, std::string_view metric) {
  const ImageRegion region{parameters.real("x"), parameters.real("y"), parameters.real("width"),
                           parameters.real("height")};
  require_inside(region.x, region.width, "x", "width", metric);
  require_inside(region.y, region.height, "y", "height", metric);
  return region;
}

Image region_mask(const ImageRegion& region, const Image& like, const Image* mask,
                  std::string_view metric) {
  const int left = first_pixel_from(region.x, like.width_px);
  const int right =
      std::min(first_pixel_from(region.x + region.width, like.width_px), like.width_px);
  const int top = first_pixel_from(region.y, like.height_px);
  const int bottom =
      std::min(first_pixel_from(region.y + region.height, like.height_px), like.height_px);
  if (left >= right || top >= bottom) {
    throw base::InputError(fmt::format(
        "metric \"{}\": the region x={} y={} width={} height={} holds no centre of the {}x{} "
        "pixels; accepted: a region with at least one",
        metric, region.x, region.y, region.width, region.height, like.width_px, like.height_px));
  }
  Image inside = perception::make_gray_image(like.width_px, like.height_px, "mask",
                                             perception::Encoding::scene_linear);
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const std::size_t i = inside.offset(x, y);
      inside.pixels[i] = takes_part(mask, i) ? 1.0F : 0.0F;
    }
  }
  if (pooled_pixel_count(inside, &inside) == 0) {
    throw base::InputError(fmt::format(
        "metric \"{}\": no pixel of the region takes part; accepted: a mask with at least one 1 "
        "in it, finite in both images",
        metric));
  }
  return inside;
}

}  // namespace metrics
