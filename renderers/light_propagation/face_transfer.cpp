#include "renderers/light_propagation/face_transfer.h"

#include <numbers>

#include "renderers/light_propagation/intensity_lobe.h"

namespace renderers::light_propagation {

namespace {

/// Solid angles of the far face and of the other four of a neighbour, seen from a cell's middle;
/// with kFarFace_sr = 4 atan(1 / (3 sqrt(11))) those of all faces around six cells add up to 4 pi.
constexpr float kFarFace_sr = 0.4006696846F;
constexpr float kSideFace_sr = 0.4234313545F;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kRoot5 = 2.23606798F;

}  // namespace

// Compiled twice; without fused multiply-add, so that both give the same numbers.
[[gnu::target_clones("avx2", "default")]] void add_way(const WayRow& row, int count) {
  constexpr float kFar = kFarFace_sr / kPi;
  constexpr float kSide = kSideFace_sr / kPi;
  const float far_along = kFar * kY1 * row.sign;
  const float side_along = kSide * (2.0F / kRoot5) * kY1 * row.sign;
  constexpr float kSideAcross = kSide * (1.0F / kRoot5) * kY1;
  const float lobe_along = kCosine1 * row.sign;
  const float least = row.least;
  const auto [even, along, across, second] = row.from;
  const auto [far, greater, less, second_greater, second_less] = row.shares;
  float* __restrict to_even = row.to[0];
  float* __restrict to_along = row.to[1];
  float* __restrict to_across = row.to[2];
  float* __restrict to_second = row.to[3];
#pragma GCC ivdep
  for (int x = 0; x < count; ++x) {
    const auto sent = [least](float light, float share) {
      return (light < least ? least : light) * share;
    };
    const float ahead = sent(kFar * kY0 * even[x] + far_along * along[x], far[x]);
    const float aside = kSide * kY0 * even[x] + side_along * along[x];
    const float lean = kSideAcross * across[x];
    const float second_lean = kSideAcross * second[x];
    const float a = sent(aside + lean, greater[x]);
    const float b = sent(aside - lean, less[x]);
    const float c = sent(aside + second_lean, second_greater[x]);
    const float d = sent(aside - second_lean, second_less[x]);
    to_even[x] += kCosine0 * (ahead + ((a + b) + (c + d)));
    to_along[x] += lobe_along * ahead;
    to_across[x] += kCosine1 * (a - b);
    to_second[x] += kCosine1 * (c - d);
  }
}

}  // namespace renderers::light_propagation
