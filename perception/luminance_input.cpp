#include "perception/luminance_input.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "perception/color_conversion.h"

namespace perception {
namespace {

constexpr std::size_t kGrainPixels = 1 << 14;

Image luminance_of(const Image& light) {
  Image luminance =
      make_gray_image(light.width_px, light.height_px, "Y", Encoding::luminance_cd_m2);
  if (light.channel_count() == 1) {
    luminance.pixels = light.pixels;
    return luminance;
  }
  const Image rgb = rgb_of(light);
  base::parallel_for(luminance.pixels.size(), kGrainPixels, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      const float* pixel = rgb.pixels.data() + 3 * i;
      luminance.pixels[i] =
          kRec709Luma[0] * pixel[0] + kRec709Luma[1] * pixel[1] + kRec709Luma[2] * pixel[2];
    }
  });
  return luminance;
}

/// Sums over rectangles of the finite pixels and of their number.
class FiniteSums {
 public:
  explicit FiniteSums(const Image& image)
      : width_(image.width_px),
        height_(image.height_px),
        sums_(static_cast<std::size_t>(width_ + 1) * static_cast<std::size_t>(height_ + 1)) {
    for (int y = 0; y < height_; ++y) {
      Cell row;
      for (int x = 0; x < width_; ++x) {
        const float value = image.at(x, y);
        if (std::isfinite(value)) {
          row.sum += static_cast<double>(value);
          row.count += 1.0;
        }
        const Cell& above = at(x + 1, y);
        at(x + 1, y + 1) = {above.sum + row.sum, above.count + row.count};
      }
    }
  }

  /// Mean in the smallest square of half-side 1, 2, 4, ... with a finite pixel; 0 if none has.
  float mean_around(int x, int y) const {
    for (int r = 1; r < 2 * std::max(width_, height_); r *= 2) {
      const int left = std::max(x - r, 0);
      const int right = std::min(x + r + 1, width_);
      const int top = std::max(y - r, 0);
      const int bottom = std::min(y + r + 1, height_);
      const double count = at(right, bottom).count - at(left, bottom).count - at(right, top).count +
                           at(left, top).count;
      if (count < 0.5) continue;
      const double sum =
          at(right, bottom).sum - at(left, bottom).sum - at(right, top).sum + at(left, top).sum;
      return static_cast<float>(sum / count);
    }
    return 0.0F;
  }

 private:
  struct Cell {
    double sum = 0.0;
    double count = 0.0;
  };

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) +
           static_cast<std::size_t>(x);
  }
  Cell& at(int x, int y) { return sums_[index(x, y)]; }
  const Cell& at(int x, int y) const { return sums_[index(x, y)]; }

  int width_;
  int height_;
  std::vector<Cell> sums_;
};

}  // namespace

LuminanceInput luminance_input(const Image& light) {
  if (light.encoding != Encoding::luminance_cd_m2) {
    throw base::InputError(
        fmt::format("thresholds are of light, but the image is {}; accepted: luminance_cd_m2, "
                    "through the display model",
                    to_string(light.encoding)));
  }
  LuminanceInput input;
  input.luminance = luminance_of(light);
  std::vector<float>& pixels = input.luminance.pixels;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!std::isfinite(pixels[i])) {
      input.non_finite_indices.push_back(i);
    } else if (pixels[i] < 0.0F) {
      pixels[i] = 0.0F;
      ++input.negative_pixels;
    }
  }
  if (input.non_finite_indices.empty()) return input;
  input.non_finite = count_non_finite(input.luminance);
  const FiniteSums sums(input.luminance);
  const auto width = static_cast<std::size_t>(light.width_px);
  for (const std::size_t i : input.non_finite_indices) {
    pixels[i] = sums.mean_around(static_cast<int>(i % width), static_cast<int>(i / width));
  }
  return input;
}

}  // namespace perception
