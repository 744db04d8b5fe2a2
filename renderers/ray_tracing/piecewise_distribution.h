#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace renderers::ray_tracing {

/// Chooses an index with a probability proportional to its weight, by inversion of the cumulative
/// sum, so that well distributed numbers give well distributed choices.
class PiecewiseDistribution {
 public:
  struct Choice {
    std::size_t index = 0;
    float probability = 0.0F;
    float rest = 0.0F;  ///< the number that chose, stretched to [0, 1) within its piece
  };

  PiecewiseDistribution() = default;
  /// @param weights  finite, >= 0; all zero: nothing can be chosen
  explicit PiecewiseDistribution(std::span<const double> weights);

  /// Sum of the weights.
  double total() const { return total_; }
  std::size_t size() const { return cumulative_.empty() ? 0 : cumulative_.size() - 1; }
  float probability(std::size_t index) const {
    return static_cast<float>(cumulative_[index + 1] - cumulative_[index]);
  }
  /// An index of weight > 0; only if `total() > 0`. @param u  in [0, 1)
  Choice choose(float u) const;

 private:
  std::vector<double> cumulative_;  ///< size + 1 values from 0 to 1
  double total_ = 0.0;
};

}  // namespace renderers::ray_tracing
