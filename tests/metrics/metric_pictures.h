#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "metrics/metric_list.h"

namespace tests {

using perception::Encoding;
using perception::Image;

/// A picture from a function of pixel coordinates that returns {R, G, B}.
template <typename Function>
Image picture(int width_px, int height_px, Encoding encoding, const Function& function) {
  Image image = perception::make_rgb_image(width_px, height_px, encoding);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const std::array<float, 3> color = function(x, y);
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = color[static_cast<std::size_t>(c)];
    }
  }
  return image;
}

inline Image uniform_picture(int width_px, int height_px, Encoding encoding,
                             std::array<float, 3> color) {
  return picture(width_px, height_px, encoding, [&](int, int) { return color; });
}

inline Image gray_picture(int width_px, int height_px, Encoding encoding, float value) {
  return uniform_picture(width_px, height_px, encoding, {value, value, value});
}

/// Smooth waves of all three channels with values in [0.3, 0.7].
inline Image wavy_picture(int width_px, int height_px, Encoding encoding) {
  return picture(width_px, height_px, encoding, [](int x, int y) -> std::array<float, 3> {
    const auto u = static_cast<float>(x);
    const auto v = static_cast<float>(y);
    return {0.5F + 0.2F * std::sin(0.21F * u), 0.5F + 0.2F * std::cos(0.17F * v),
            0.5F + 0.2F * std::sin(0.13F * (u + v))};
  });
}

/// The picture plus uniform noise in [-amplitude, amplitude], the same for every amplitude.
inline Image with_noise(Image image, float amplitude) {
  std::uint32_t state = 7;
  for (float& value : image.pixels) {
    state = state * 1664525U + 1013904223U;
    value += amplitude * (static_cast<float>(state >> 8) * 0x1p-23F - 1.0F);
  }
  return image;
}

/// Left and right exchanged.
inline Image in_mirror(const Image& image) {
  return picture(image.width_px, image.height_px, image.encoding,
                 [&](int x, int y) -> std::array<float, 3> {
                   const int from = image.width_px - 1 - x;
                   return {image.at(from, y, 0), image.at(from, y, 1), image.at(from, y, 2)};
                 });
}

/// One channel of ones, zero where the function of (x, y) is false.
template <typename Function>
Image mask_where(int width_px, int height_px, const Function& function) {
  Image mask = perception::make_gray_image(width_px, height_px, "mask", Encoding::scene_linear);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) mask.at(x, y) = function(x, y) ? 1.0F : 0.0F;
  }
  return mask;
}

inline metrics::Score score_of(const std::string& metric, const Image& reference, const Image& test,
                               const Image* mask = nullptr,
                               const metrics::ScoreOptions& options = {}) {
  return metrics::score(metrics::parse_metric_choice(metric, {}), {reference, test, nullptr, mask},
                        perception::ViewingConditions{}, options);
}

/// The detail of a score, or NaN if it has none of that name.
inline double detail(const metrics::Score& score, const std::string& name) {
  for (const auto& entry : score.details) {
    if (entry.name == name) return entry.value;
  }
  return std::nan("");
}

}  // namespace tests
