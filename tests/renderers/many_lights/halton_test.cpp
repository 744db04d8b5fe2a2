#include "renderers/many_lights/halton.h"

#include <array>

#include <gtest/gtest.h>

namespace renderers::many_lights {
namespace {

TEST(Halton, FirstSixteenPointsAreTheExactRationals) {
  const std::array<std::array<int, 2>, 16> base_2{{{1, 2},
                                                   {1, 4},
                                                   {3, 4},
                                                   {1, 8},
                                                   {5, 8},
                                                   {3, 8},
                                                   {7, 8},
                                                   {1, 16},
                                                   {9, 16},
                                                   {5, 16},
                                                   {13, 16},
                                                   {3, 16},
                                                   {11, 16},
                                                   {7, 16},
                                                   {15, 16},
                                                   {1, 32}}};
  const std::array<std::array<int, 2>, 16> base_3{{{1, 3},
                                                   {2, 3},
                                                   {1, 9},
                                                   {4, 9},
                                                   {7, 9},
                                                   {2, 9},
                                                   {5, 9},
                                                   {8, 9},
                                                   {1, 27},
                                                   {10, 27},
                                                   {19, 27},
                                                   {4, 27},
                                                   {13, 27},
                                                   {22, 27},
                                                   {7, 27},
                                                   {16, 27}}};
  for (std::size_t i = 0; i < 16; ++i) {
    const auto quotient = [](const std::array<int, 2>& q) {
      return static_cast<double>(q[0]) / static_cast<double>(q[1]);
    };
    EXPECT_EQ(radical_inverse(i + 1, 2), quotient(base_2[i])) << i;
    EXPECT_EQ(radical_inverse(i + 1, 3), quotient(base_3[i])) << i;
  }
}

TEST(Halton, IsBelowOneFarOut) {
  for (const std::uint64_t index : {0xffffffffULL, 1000000007ULL, 3486784400ULL}) {
    for (const std::uint64_t base : {2, 3, 5}) {
      EXPECT_GE(radical_inverse(index, base), 0.0);
      EXPECT_LT(radical_inverse(index, base), 1.0) << index << " in base " << base;
    }
  }
}

}  // namespace
}  // namespace renderers::many_lights
