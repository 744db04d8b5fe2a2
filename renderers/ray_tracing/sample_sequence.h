#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include <glm/vec4.hpp>

/// Numbers in [0, 1) for the samples of a pixel: Owen-scrambled Sobol' points or independent ones.
///
/// Source: Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4): sets of four dimensions,
/// each shuffled and scrambled by hashes of the pixel's seed (Sec. 3 and 4, "padding").
/// Direction numbers: Joe and Kuo 2008, "Constructing Sobol sequences with better two-dimensional
/// projections", doi:10.1137/070709359, new-joe-kuo-6.21201.
namespace renderers::ray_tracing {

enum class SequenceKind { sobol, random };

/// Mixes all bits (finaliser of MurmurHash3, 64 bit; Appleby, public domain; constants recalled).
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x ^= x >> 33;
  x *= 0xff51afd7ed558ccdULL;
  x ^= x >> 33;
  x *= 0xc4ceb9fe1a85ec53ULL;
  x ^= x >> 33;
  return x;
}

/// Hash of a value under a seed; chain it for several values. Small seeds and values never collide:
/// multiples of 2^64 over the golden ratio (Knuth, TAOCP 3, Sec. 6.4) stay further apart than the
/// values reach.
constexpr std::uint64_t hash_combine(std::uint64_t seed, std::uint64_t value) {
  return mix_bits(seed * 0x9e3779b97f4a7c15ULL + value + 1);
}

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffU) << 8) | ((x & 0xff00ff00U) >> 8);
  x = ((x & 0x0f0f0f0fU) << 4) | ((x & 0xf0f0f0f0U) >> 4);
  x = ((x & 0x33333333U) << 2) | ((x & 0xccccccccU) >> 2);
  return ((x & 0x55555555U) << 1) | ((x & 0xaaaaaaaaU) >> 1);
}

/// Owen scrambling of a binary fraction whose bits are reversed: a Laine-Karras permutation, with
/// constants found by Vegdahl 2021 as pbrt-v4 uses them (recalled).
constexpr std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return x;
}

/// Nested uniform (Owen) scrambling of a binary fraction by a hash: each bit is flipped depending
/// on the more significant ones alone. Burley 2020, Sec. 3.2 and Listing 2.
constexpr std::uint32_t owen_scramble(std::uint32_t fraction, std::uint32_t seed) {
  return reverse_bits(scramble_reversed(reverse_bits(fraction), seed));
}

/// The largest number of the samples' interval [0, 1).
inline constexpr float kBelowOne = 1.0F - 0.5F * std::numeric_limits<float>::epsilon();

/// Place in [0, 1) of a number within one of `count` equal cells; the sum may round up to 1 and
/// is kept below.
/// @param cell  in [0, count)  @param u  in [0, 1)
constexpr float in_stratum(int cell, float u, int count) {
  return std::min((static_cast<float>(cell) + u) / static_cast<float>(count), kBelowOne);
}

inline constexpr int kSobolDimensions = 4;

/// The first four coordinates of Sobol' point `index`, as 32-bit binary fractions.
std::array<std::uint32_t, kSobolDimensions> sobol_point(std::uint32_t index);

/// Stream of the numbers of one sample of one pixel, in sets of four. The n-th set of all samples
/// of a randomisation is a scrambled (0, 2)-sequence in its first two coordinates.
class SampleSequence {
 public:
  /// @param seed   of the pixel and of the randomisation
  /// @param index  of the sample in the randomisation; the sequence has 2^32 points, and another
  ///               randomisation follows each such run
  SampleSequence(SequenceKind kind, std::uint64_t seed, std::uint64_t index)
      : kind_(kind),
        seed_(index >> 32 == 0 ? seed : hash_combine(seed, index >> 32)),
        index_(static_cast<std::uint32_t>(index)),
        reversed_index_(reverse_bits(index_)) {}

  /// The next four numbers, each in [0, 1).
  glm::vec4 next();
  /// Leaves four numbers out: what comes then is what comes after `next`.
  void skip() { set_ += 1; }

 private:
  SequenceKind kind_;
  std::uint64_t seed_;
  std::uint32_t index_;
  std::uint32_t reversed_index_;
  std::uint32_t set_ = 0;
};

}  // namespace renderers::ray_tracing
