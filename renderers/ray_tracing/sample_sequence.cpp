#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::ray_tracing {

namespace {

using DirectionNumbers = std::array<std::array<std::uint32_t, kSobolDimensions>, 32>;

/// Primitive polynomial of a dimension: degree s, inner coefficients a, initial numbers m.
struct Polynomial {
  unsigned degree;
  unsigned coefficients;
  std::array<std::uint32_t, 3> initial;
};

/// Rows d = 2, 3, 4 of new-joe-kuo-6.21201.
constexpr std::array<Polynomial, kSobolDimensions - 1> kPolynomials{
    {{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}}};

/// Direction number `bit` of a dimension by the recurrence of Joe and Kuo 2008, Sec. 2.
constexpr std::uint32_t next_direction(const DirectionNumbers& numbers, std::size_t dimension,
                                       unsigned bit, const Polynomial& polynomial) {
  const unsigned degree = polynomial.degree;
  const std::uint32_t oldest = numbers[bit - degree][dimension];
  std::uint32_t value = oldest ^ (oldest >> degree);
  for (unsigned k = 1; k < degree; ++k) {
    const bool is_set = ((polynomial.coefficients >> (degree - 1 - k)) & 1U) != 0;
    if (is_set) value ^= numbers[bit - k][dimension];
  }
  return value;
}

constexpr DirectionNumbers make_direction_numbers() {
  DirectionNumbers numbers{};
  for (unsigned bit = 0; bit < 32; ++bit) {
    numbers[bit][0] = 1U << (31 - bit);
    for (std::size_t dimension = 1; dimension < kSobolDimensions; ++dimension) {
      const Polynomial& polynomial = kPolynomials[dimension - 1];
      numbers[bit][dimension] = bit < polynomial.degree
                                    ? polynomial.initial[bit] << (31 - bit)
                                    : next_direction(numbers, dimension, bit, polynomial);
    }
  }
  return numbers;
}

constexpr DirectionNumbers kDirectionNumbers = make_direction_numbers();

using SobolPoint = std::array<std::uint32_t, kSobolDimensions>;
/// By byte of an index whose bits are reversed, and its value: the sum of the byte's direction
/// numbers, their bits reversed, too. What Owen scrambling takes and gives needs no turning then.
using ReversedSums = std::array<std::array<SobolPoint, 256>, 4>;

constexpr ReversedSums make_reversed_sums() {
  ReversedSums sums{};
  for (std::size_t byte = 0; byte < 4; ++byte) {
    for (std::size_t value = 1; value < 256; ++value) {
      // The sum without the lowest bit, and that bit's number.
      std::size_t lowest = 0;
      while (((value >> lowest) & 1U) == 0) ++lowest;
      const auto& number = kDirectionNumbers[31 - (8 * byte + lowest)];
      for (std::size_t i = 0; i < kSobolDimensions; ++i) {
        sums[byte][value][i] = sums[byte][value & (value - 1)][i] ^ reverse_bits(number[i]);
      }
    }
  }
  return sums;
}

constexpr ReversedSums kReversedSums = make_reversed_sums();

/// Sobol' point, its bits reversed, of an index whose bits are reversed.
SobolPoint reversed_sobol_point(std::uint32_t reversed_index) {
  SobolPoint point{};
  for (std::size_t byte = 0; byte < 4; ++byte) {
    const SobolPoint& sum = kReversedSums[byte][(reversed_index >> (8 * byte)) & 0xffU];
    for (std::size_t i = 0; i < kSobolDimensions; ++i) point[i] ^= sum[i];
  }
  return point;
}

/// 24 random bits, so that the number stays below 1 as a float.
constexpr float unit_float(std::uint32_t fraction) {
  return static_cast<float>(fraction >> 8) * 0x1p-24F;
}

}  // namespace

std::array<std::uint32_t, kSobolDimensions> sobol_point(std::uint32_t index) {
  std::array<std::uint32_t, kSobolDimensions> point{};
  for (const auto& row : kDirectionNumbers) {
    const std::uint32_t mask = 0U - (index & 1U);
    for (std::size_t i = 0; i < kSobolDimensions; ++i) point[i] ^= row[i] & mask;
    index >>= 1;
  }
  return point;
}

glm::vec4 SampleSequence::next() {
  const std::uint64_t set_seed = hash_combine(seed_, set_++);
  std::array<std::uint32_t, kSobolDimensions> fractions{};
  if (kind_ == SequenceKind::sobol) {
    // The shuffle: scrambling the index (as a fraction, most significant bit first) permutes it
    // within every aligned block of a power of two, so that sets are independent of each other.
    const std::uint32_t shuffled =
        scramble_reversed(reversed_index_, static_cast<std::uint32_t>(set_seed >> 32));
    fractions = reversed_sobol_point(shuffled);
    for (std::size_t i = 0; i < kSobolDimensions; ++i) {
      const auto seed = static_cast<std::uint32_t>(hash_combine(set_seed, i));
      fractions[i] = reverse_bits(scramble_reversed(fractions[i], seed));
    }
  } else {
    const std::uint64_t low = hash_combine(set_seed, index_);
    const std::uint64_t high = mix_bits(low ^ 0x6a09e667f3bcc909ULL);
    fractions = {static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(low >> 32),
                 static_cast<std::uint32_t>(high), static_cast<std::uint32_t>(high >> 32)};
  }
  return {unit_float(fractions[0]), unit_float(fractions[1]), unit_float(fractions[2]),
          unit_float(fractions[3])};
}

}  // namespace renderers::ray_tracing
