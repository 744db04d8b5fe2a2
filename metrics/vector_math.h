#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

/// Powers and roots without branches or calls, so that loops over rows are vectorised.
///
/// Every function is exact to a few units in the last place of a float over its stated range; the
/// same operations run on every machine, so results do not depend on the vector width.
namespace metrics {

/// Cube root. @param x  in [1e-30, 1e30]
inline float cube_root(float x) {
  // A third of the exponent and mantissa bits is a guess within 4 %: 0x2A517D3C is 2/3 of the
  // exponent bias, shifted so that the largest error over one octave is smallest.
  constexpr float kThird = 1.0F / 3.0F;
  constexpr std::int32_t kOffset = 0x2A517D3C;
  const auto bits = std::bit_cast<std::int32_t>(x);
  float y =
      std::bit_cast<float>(static_cast<std::int32_t>(static_cast<float>(bits) * kThird) + kOffset);
  // Two steps of Halley's iteration, each cubing the relative error.
  float cube = y * y * y;
  y *= (cube + 2.0F * x) / (2.0F * cube + x);
  cube = y * y * y;
  y *= (cube + 2.0F * x) / (2.0F * cube + x);
  // One step of Newton's with the residual in double precision leaves the rounding of the result.
  const double root = y;
  const auto residual = static_cast<float>(root * root * root - static_cast<double>(x));
  return static_cast<float>(root - static_cast<double>(residual / (3.0F * y * y)));
}

/// Logarithm to base 2. @param x  a normal positive number
inline float log2_of(float x) {
  // x = 2^exponent * m with m in [sqrt(1/2), sqrt(2)).
  constexpr std::int32_t kSqrtHalfBits = 0x3F3504F3;
  const auto bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - kSqrtHalfBits) >> 23;
  const float m = std::bit_cast<float>(bits - (exponent << 23));
  // ln m = 2 atanh(s), s = (m - 1) / (m + 1), |s| < 0.1716: the series' rest is below 1e-9.
  constexpr float kTwoOverLn2 = 2.88539008F;
  const float s = (m - 1.0F) / (m + 1.0F);
  const float s2 = s * s;
  const float series =
      1.0F + s2 * (1.0F / 3.0F + s2 * (1.0F / 5.0F + s2 * (1.0F / 7.0F + s2 * (1.0F / 9.0F))));
  return static_cast<float>(exponent) + kTwoOverLn2 * s * series;
}

/// 2 to a power. @param x  below 127; results under 2^-126 are 2^-126
inline float exp2_of(float x) {
  // Adding and subtracting 1.5 * 2^23 rounds to the nearest whole number.
  constexpr float kRounder = 12582912.0F;
  constexpr float kLn2 = 0.693147181F;
  const float bounded = x < -126.0F ? -126.0F : x;
  const float whole = (bounded + kRounder) - kRounder;
  const float t = (bounded - whole) * kLn2;
  // Taylor series of e^t for |t| < 0.3466: the rest is below 6e-9.
  const float series =
      1.0F +
      t * (1.0F + t * (1.0F / 2.0F +
                       t * (1.0F / 6.0F + t * (1.0F / 24.0F +
                                               t * (1.0F / 120.0F +
                                                    t * (1.0F / 720.0F + t * (1.0F / 5040.0F)))))));
  const std::int32_t scale_bits = (static_cast<std::int32_t>(whole) + 127) << 23;
  return series * std::bit_cast<float>(scale_bits);
}

/// x to a power, x > 0. @return x^power; smaller results than 2^-126 are 2^-126
inline float power_of(float x, float power) { return exp2_of(power * log2_of(x)); }

/// The sRGB transfer to linear light (IEC 61966-2-1), as perception::srgb_decode for values >= 0.
inline float srgb_to_linear(float encoded) {
  const float base = (encoded + 0.055F) * (1.0F / 1.055F);
  const float curve = power_of(base, 2.4F);
  const float line = encoded * (1.0F / 12.92F);
  return encoded <= 0.04045F ? line : curve;
}

}  // namespace metrics
