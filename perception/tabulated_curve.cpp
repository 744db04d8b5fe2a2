#include "perception/tabulated_curve.h"

#include <utility>

namespace perception {
namespace {

constexpr float kLowest = 0x1p-24F;

}  // namespace

TabulatedCurve::TabulatedCurve(std::function<double(double)> function)
    : function_(std::move(function)),
      at_zero_(static_cast<float>(function_(0.0))),
      lines_(kPieces) {
  const auto start_of = [](std::uint32_t piece) {
    return static_cast<double>(
        std::bit_cast<float>((kFirstPiece + piece) << static_cast<std::uint32_t>(kFractionBits)));
  };
  double here = function_(start_of(0));
  for (std::uint32_t piece = 0; piece < kPieces; ++piece) {
    const double next = function_(start_of(piece + 1));
    const double rise = (next - here) / static_cast<double>(1U << kFractionBits);
    lines_[piece] = {static_cast<float>(here), static_cast<float>(rise)};
    here = next;
  }
}

float TabulatedCurve::outside(float x) const {
  if (x >= 0.0F && x < kLowest) return at_zero_ + (lines_[0][0] - at_zero_) * (x / kLowest);
  return static_cast<float>(function_(static_cast<double>(x)));
}

}  // namespace perception
