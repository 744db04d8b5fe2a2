#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "perception/image.h"

namespace tests {

/// A one-channel image of light, cd/m2, of value(x, y).
template <class Value>
perception::Image light_image(int width_px, int height_px, const Value& value) {
  perception::Image image =
      perception::make_gray_image(width_px, height_px, "Y", perception::Encoding::luminance_cd_m2);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) image.at(x, y) = static_cast<float>(value(x, y));
  }
  return image;
}

/// mean (1 + contrast cos(2 pi f d)) with d along the orientation; 0 degrees are vertical bars.
inline perception::Image grating(int size_px, double mean_cd_m2, double contrast, double cycles_px,
                                 double orientation_deg = 0.0) {
  const double angle = orientation_deg * std::numbers::pi / 180.0;
  return light_image(size_px, size_px, [=](int x, int y) {
    const double d = (x - size_px / 2) * std::cos(angle) + (y - size_px / 2) * std::sin(angle);
    return mean_cd_m2 * (1.0 + contrast * std::cos(2.0 * std::numbers::pi * cycles_px * d));
  });
}

/// Uniform noise, mean (1 + amplitude u), u in [-1, 1), the same in every run.
inline perception::Image noise(int width_px, int height_px, double mean_cd_m2, double amplitude,
                               std::uint32_t seed = 1) {
  std::uint32_t state = seed;
  return light_image(width_px, height_px, [&](int, int) {
    state = state * 1664525U + 1013904223U;
    return mean_cd_m2 * (1.0 + amplitude * (static_cast<double>(state >> 8) * 0x1p-23 - 1.0));
  });
}

inline perception::Image mirrored(const perception::Image& image, bool in_x, bool in_y) {
  return light_image(image.width_px, image.height_px, [&](int x, int y) {
    return image.at(in_x ? image.width_px - 1 - x : x, in_y ? image.height_px - 1 - y : y);
  });
}

}  // namespace tests
