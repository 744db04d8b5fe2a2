#pragma once

#include <cstdint>

namespace renderers::many_lights {

/// The digits of an index mirrored at the point, in [0, 1): coordinate of a Halton point, one prime
/// base per dimension. Index 0 gives 0, a corner of the map, so sequences start at 1.
/// Source: Halton 1960, "On the efficiency of certain quasi-random sequences of points in
/// evaluating multi-dimensional integrals", doi:10.1007/BF01386213.
/// @param base  >= 2
constexpr double radical_inverse(std::uint64_t index, std::uint64_t base) {
  // Numerator and denominator are exact integers: one rounding in all.
  std::uint64_t numerator = 0;
  std::uint64_t denominator = 1;
  for (; index > 0; index /= base) {
    numerator = numerator * base + index % base;
    denominator *= base;
  }
  return static_cast<double>(numerator) / static_cast<double>(denominator);
}

}  // namespace renderers::many_lights
