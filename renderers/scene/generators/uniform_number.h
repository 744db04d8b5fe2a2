#pragma once

#include <random>

namespace renderers::scene {

/// Uniform in [low, high). The engine is fixed by the standard, its distributions are not.
inline float uniform(std::mt19937_64& engine, float low, float high) {
  const auto bits = static_cast<float>(engine() >> 40U);
  return low + (high - low) * bits / 16777216.0F;
}

}  // namespace renderers::scene
