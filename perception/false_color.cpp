#include "perception/false_color.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace perception {
namespace {

using Color = std::array<double, 3>;

/// sRGB anchors, equally spaced. They follow a path of our own through CIE 1976 L*a*b*: L* rises
/// evenly from 1.5 to 97.5, the hue turns from 298 degrees (violet) over red to 462 (yellow), the
/// chroma is 72 sin(pi (0.06 + 0.88 t))^0.8 or 0.92 of what sRGB can show, whichever is less.
constexpr std::array<Color, 33> kAnchors{{
    {0.0336, 0.0009, 0.1265}, {0.0643, 0.0353, 0.1764}, {0.0910, 0.0597, 0.2245},
    {0.1337, 0.0695, 0.2697}, {0.1831, 0.0760, 0.3110}, {0.2378, 0.0787, 0.3478},
    {0.2963, 0.0770, 0.3798}, {0.3577, 0.0701, 0.4064}, {0.4209, 0.0569, 0.4276},
    {0.4765, 0.0657, 0.4357}, {0.5318, 0.0762, 0.4418}, {0.5874, 0.0868, 0.4460},
    {0.6434, 0.0974, 0.4480}, {0.7001, 0.1082, 0.4474}, {0.7573, 0.1190, 0.4436},
    {0.8152, 0.1299, 0.4360}, {0.8737, 0.1411, 0.4239}, {0.9122, 0.1978, 0.4105},
    {0.9450, 0.2546, 0.3970}, {0.9699, 0.3145, 0.3856}, {0.9722, 0.3894, 0.3872},
    {0.9745, 0.4540, 0.3940}, {0.9768, 0.5125, 0.4060}, {0.9790, 0.5670, 0.4229},
    {0.9812, 0.6186, 0.4446}, {0.9833, 0.6681, 0.4709}, {0.9855, 0.7158, 0.5017},
    {0.9876, 0.7623, 0.5370}, {0.9897, 0.8076, 0.5769}, {0.9919, 0.8519, 0.6223},
    {0.9940, 0.8952, 0.6749}, {0.9946, 0.9370, 0.7472}, {0.9982, 0.9758, 0.8388},
}};

constexpr std::array<float, 3> kNonFinite{0.0F, 1.0F, 1.0F};  ///< cyan: on no map of this family

}  // namespace

std::array<float, 3> false_color(double position) {
  assert(!std::isnan(position));
  const double scaled = std::clamp(position, 0.0, 1.0) * static_cast<double>(kAnchors.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(scaled), kAnchors.size() - 2);
  const double weight = scaled - static_cast<double>(low);
  std::array<float, 3> color{};
  for (std::size_t c = 0; c < 3; ++c) {
    color[c] =
        static_cast<float>((1.0 - weight) * kAnchors[low][c] + weight * kAnchors[low + 1][c]);
  }
  return color;
}

double scale_position(double value, const MapScale& scale) {
  assert(scale.high > scale.low && (!scale.is_logarithmic || scale.low > 0.0));
  if (std::isnan(value)) return value;
  if (value <= scale.low) return 0.0;
  if (value >= scale.high) return 1.0;
  if (!scale.is_logarithmic) return (value - scale.low) / (scale.high - scale.low);
  return std::log(value / scale.low) / std::log(scale.high / scale.low);
}

Image false_color_image(const Image& map, const MapScale& scale) {
  assert(map.channel_count() == 1);
  Image picture = make_rgb_image(map.width_px, map.height_px, Encoding::display);
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    const float value = map.pixels[i];
    const std::array<float, 3> color =
        std::isfinite(value) ? false_color(scale_position(value, scale)) : kNonFinite;
    std::copy(color.begin(), color.end(),
              picture.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return picture;
}

}  // namespace perception
