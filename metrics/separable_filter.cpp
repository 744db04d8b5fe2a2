#include "metrics/separable_filter.h"

namespace metrics {
namespace {

template <typename Value>
[[gnu::always_inline]] inline void add_up(std::span<const Value> weights,
                                          std::span<const Value* const> inputs, std::size_t count,
                                          Value* out) {
  // Pairs of blocks of columns whose sums stay in registers while the taps go by.
  constexpr std::size_t kBlock = 16;
  std::size_t x = 0;
  for (; x + 2 * kBlock <= count; x += 2 * kBlock) {
    Value left[kBlock] = {};
    Value right[kBlock] = {};
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const Value weight = weights[k];
      const Value* input = inputs[k] + x;
      for (std::size_t i = 0; i < kBlock; ++i) left[i] += weight * input[i];
      for (std::size_t i = 0; i < kBlock; ++i) right[i] += weight * input[kBlock + i];
    }
    std::copy(left, left + kBlock, out + x);
    std::copy(right, right + kBlock, out + x + kBlock);
  }
  for (; x < count; ++x) {
    Value sum = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * inputs[k][x];
    out[x] = sum;
  }
}

}  // namespace

// Compiled twice; the loader picks one. AVX2 without fused multiply-add rounds as the baseline
// does.
[[gnu::target_clones("avx2", "default")]] void weighted_sum(std::span<const float> weights,
                                                            std::span<const float* const> inputs,
                                                            std::size_t count, float* out) {
  add_up(weights, inputs, count, out);
}

[[gnu::target_clones("avx2", "default")]] void weighted_sum(std::span<const double> weights,
                                                            std::span<const double* const> inputs,
                                                            std::size_t count, double* out) {
  add_up(weights, inputs, count, out);
}

}  // namespace metrics
