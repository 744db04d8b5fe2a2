#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <vector>

namespace perception {

/// A smooth function of a positive number, tabulated for whole images: 128 straight pieces in each
/// octave from 2^-24 to 2^24, one below, the exact function beyond. The function is finite at 0.
///
/// For power laws x^p the relative error is below |p (p - 1)| / 8 / 128^2 = 8e-6 |p (p - 1)|; a
/// step of the function is spread over one piece, 0.8 % of x. Internal.
class TabulatedCurve {
 public:
  explicit TabulatedCurve(std::function<double(double)> function);

  float operator()(float x) const {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
    const std::uint32_t piece = (bits >> kFractionBits) - kFirstPiece;  // wraps below the range
    if (piece >= kPieces) return outside(x);
    const auto fraction = static_cast<float>(bits & ((1U << kFractionBits) - 1U));
    const std::array<float, 2>& line = lines_[piece];
    return line[0] + line[1] * fraction;
  }

 private:
  static constexpr int kMantissaBits = 23;
  static constexpr int kPieceBits = 7;  // 128 pieces in an octave
  static constexpr int kFractionBits = kMantissaBits - kPieceBits;
  static constexpr std::uint32_t kExponentBias = 127;
  static constexpr std::uint32_t kLowExponent = kExponentBias - 24;
  static constexpr std::uint32_t kOctaves = 48;
  static constexpr std::uint32_t kFirstPiece = kLowExponent << kPieceBits;
  static constexpr std::uint32_t kPieces = kOctaves << kPieceBits;

  /// Below 2^-24, above 2^24, negative or not a number.
  float outside(float x) const;

  std::function<double(double)> function_;
  float at_zero_;
  std::vector<std::array<float, 2>> lines_;  ///< value at the piece's start; rise per mantissa unit
};

}  // namespace perception
