#include "renderers/ray_tracing/piecewise_distribution.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::ray_tracing {

PiecewiseDistribution::PiecewiseDistribution(std::span<const double> weights) {
  cumulative_.reserve(weights.size() + 1);
  cumulative_.push_back(0.0);
  for (const double weight : weights) {
    assert(std::isfinite(weight) && weight >= 0.0);
    total_ += weight;
    cumulative_.push_back(total_);
  }
  if (total_ <= 0.0) return;
  for (double& value : cumulative_) value /= total_;
}

PiecewiseDistribution::Choice PiecewiseDistribution::choose(float u) const {
  // The first sum beyond u ends the piece; pieces of no width cannot be found this way, and the
  // last sum with any weight is exactly 1.
  const auto end =
      std::upper_bound(cumulative_.begin() + 1, cumulative_.end(), static_cast<double>(u));
  const auto index = static_cast<std::size_t>(end - cumulative_.begin()) - 1;
  const double low = cumulative_[index];
  const double width = cumulative_[index + 1] - low;
  Choice choice;
  choice.index = index;
  choice.probability = static_cast<float>(width);
  choice.rest = std::min(static_cast<float>((static_cast<double>(u) - low) / width), kBelowOne);
  return choice;
}

}  // namespace renderers::ray_tracing
