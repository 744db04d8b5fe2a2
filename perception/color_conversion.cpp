// sRGB: IEC 61966-2-1:1999. L*a*b*: CIE 15:2004.
// XYZ matrices: Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images",
// doi:10.1145/3406183, in the exact fractions of its reference code, which follow from the
// primaries of ITU-R BT.709 and a white of x = 0.3127, y = 0.3290.

#include "perception/color_conversion.h"

#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "perception/base/parallel.h"

namespace perception {
namespace {

using Vector = std::array<float, 3>;
using Matrix = std::array<std::array<double, 3>, 3>;

constexpr Matrix kXyzFromRgb{{
    {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0},
}};
constexpr Matrix kRgbFromXyz{{
    {3.241003275, -1.537398934, -0.498615861},
    {-0.969224334, 1.875930071, 0.041554224},
    {0.055639423, -0.204011202, 1.057148933},
}};

/// Values of one piece of parallel work; fixed, so that it never depends on the thread count.
constexpr std::size_t kGrain = 1 << 14;

constexpr Vector product(const Matrix& matrix, const Vector& v) {
  Vector result{};
  for (std::size_t row = 0; row < 3; ++row) {
    const double sum = matrix[row][0] * static_cast<double>(v[0]) +
                       matrix[row][1] * static_cast<double>(v[1]) +
                       matrix[row][2] * static_cast<double>(v[2]);
    result[row] = static_cast<float>(sum);
  }
  return result;
}

constexpr Vector kWhiteXyz = product(kXyzFromRgb, {1.0F, 1.0F, 1.0F});

constexpr float kLabDelta = 6.0F / 29.0F;  ///< where the cube root meets the line, CIE 15:2004

float lab_curve(float t) {
  if (t > kLabDelta * kLabDelta * kLabDelta) return std::cbrt(t);
  return t / (3.0F * kLabDelta * kLabDelta) + 4.0F / 29.0F;
}

float lab_curve_inverse(float f) {
  if (f > kLabDelta) return f * f * f;
  return 3.0F * kLabDelta * kLabDelta * (f - 4.0F / 29.0F);
}

Image transferred(const Image& image, Encoding to, float (*transfer)(float)) {
  Image result = rgb_of(image);
  result.encoding = to;
  base::parallel_for(result.pixels.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result.pixels[i] = transfer(result.pixels[i]);
  });
  return result;
}

}  // namespace

float srgb_encode(float linear) {
  const float size = std::fabs(linear);
  const float encoded =
      size <= 0.0031308F ? 12.92F * size : 1.055F * std::pow(size, 1.0F / 2.4F) - 0.055F;
  return std::copysign(encoded, linear);
}

float srgb_decode(float encoded) {
  const float size = std::fabs(encoded);
  const float linear = size <= 0.04045F ? size / 12.92F : std::pow((size + 0.055F) / 1.055F, 2.4F);
  return std::copysign(linear, encoded);
}

std::array<float, 3> xyz_from_linear_rgb(std::array<float, 3> rgb) {
  return product(kXyzFromRgb, rgb);
}

std::array<float, 3> linear_rgb_from_xyz(std::array<float, 3> xyz) {
  return product(kRgbFromXyz, xyz);
}

std::array<float, 3> lab_from_xyz(std::array<float, 3> xyz) {
  const float fx = lab_curve(xyz[0] / kWhiteXyz[0]);
  const float fy = lab_curve(xyz[1] / kWhiteXyz[1]);
  const float fz = lab_curve(xyz[2] / kWhiteXyz[2]);
  return {116.0F * fy - 16.0F, 500.0F * (fx - fy), 200.0F * (fy - fz)};
}

std::array<float, 3> xyz_from_lab(std::array<float, 3> lab) {
  const float fy = (lab[0] + 16.0F) / 116.0F;
  return {kWhiteXyz[0] * lab_curve_inverse(fy + lab[1] / 500.0F),
          kWhiteXyz[1] * lab_curve_inverse(fy),
          kWhiteXyz[2] * lab_curve_inverse(fy - lab[2] / 200.0F)};
}

Image srgb_encoded(const Image& linear) {
  assert(linear.encoding == Encoding::scene_linear);
  return transferred(linear, Encoding::display, srgb_encode);
}

Image srgb_decoded(const Image& display) {
  assert(display.encoding == Encoding::display);
  return transferred(display, Encoding::scene_linear, srgb_decode);
}

Image linear_rgb_of(const Image& image) {
  return image.encoding == Encoding::display ? srgb_decoded(image) : rgb_of(image);
}

}  // namespace perception
