#include "renderers/ray_tracing/sample_sequence.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace renderers::ray_tracing {
namespace {

double as_number(std::uint32_t fraction) { return static_cast<double>(fraction) * 0x1p-32; }

TEST(SobolPoint, GivesThePublishedFirstPoints) {
  // Joe and Kuo 2008, unscrambled; their generator visits them in Gray code order.
  const std::vector<std::array<double, 4>> expected{
      {0, 0, 0, 0}, {0.5, 0.5, 0.5, 0.5}, {0.25, 0.75, 0.75, 0.75}, {0.75, 0.25, 0.25, 0.25}};
  for (std::uint32_t i = 0; i < expected.size(); ++i) {
    const auto point = sobol_point(i);
    for (std::size_t d = 0; d < 4; ++d) EXPECT_EQ(as_number(point[d]), expected[i][d]) << i;
  }
  const auto sixth = sobol_point(6);
  EXPECT_EQ(as_number(sixth[0]), 0.375);
  EXPECT_EQ(as_number(sixth[1]), 0.375);
  EXPECT_EQ(as_number(sixth[2]), 0.625);
  EXPECT_EQ(as_number(sixth[3]), 0.875);
}

/// True if every cell of every 2^a x 2^(m-a) grid holds exactly one of the 2^m points.
bool is_net(const std::vector<glm::vec4>& points, int x, int y, int log_count) {
  for (int a = 0; a <= log_count; ++a) {
    std::set<std::pair<int, int>> cells;
    for (const glm::vec4& p : points) {
      cells.emplace(static_cast<int>(p[x] * std::ldexp(1.0F, a)),
                    static_cast<int>(p[y] * std::ldexp(1.0F, log_count - a)));
    }
    if (cells.size() != points.size()) return false;
  }
  return true;
}

std::vector<glm::vec4> first_points(SequenceKind kind, std::uint64_t seed, int set, int count) {
  std::vector<glm::vec4> points;
  for (int i = 0; i < count; ++i) {
    SampleSequence sequence(kind, seed, static_cast<std::uint32_t>(i));
    glm::vec4 numbers(0.0F);
    for (int s = 0; s <= set; ++s) numbers = sequence.next();
    points.push_back(numbers);
  }
  return points;
}

TEST(SampleSequence, FirstTwoDimensionsOfEverySetAreNets) {
  for (const std::uint64_t seed : {1ULL, 77ULL, 123456789ULL}) {
    for (const int set : {0, 1, 5}) {
      EXPECT_TRUE(is_net(first_points(SequenceKind::sobol, seed, set, 64), 0, 1, 6));
    }
  }
  EXPECT_FALSE(is_net(first_points(SequenceKind::random, 1, 0, 64), 0, 1, 6));
}

TEST(SampleSequence, EveryDimensionIsStratified) {
  const auto points = first_points(SequenceKind::sobol, 9, 2, 256);
  for (int d = 0; d < 4; ++d) {
    std::set<int> strata;
    for (const glm::vec4& p : points) strata.insert(static_cast<int>(p[d] * 256.0F));
    EXPECT_EQ(strata.size(), 256U);
  }
}

TEST(SampleSequence, SetsAreNotCopiesOfEachOther) {
  const auto first = first_points(SequenceKind::sobol, 9, 0, 256);
  const auto second = first_points(SequenceKind::sobol, 9, 1, 256);
  double correlation = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    correlation +=
        (static_cast<double>(first[i].x) - 0.5) * (static_cast<double>(second[i].x) - 0.5);
  }
  // Of independent numbers: mean 0, standard deviation 1 / (12 sqrt(256)).
  EXPECT_LT(std::fabs(correlation / 256.0), 4.5 / (12.0 * 16.0));
}

TEST(SampleSequence, EveryNumberIsUniformOverSeeds) {
  // A scrambled point is uniform: chi-square over 16 bins, 15 degrees of freedom, p = 1e-5: 46.
  for (const SequenceKind kind : {SequenceKind::sobol, SequenceKind::random}) {
    for (const std::uint32_t index : {0U, 1U, 6U}) {
      for (int d = 0; d < 4; ++d) {
        std::array<double, 16> bins{};
        constexpr int kSeeds = 16000;
        for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
          const glm::vec4 numbers = SampleSequence(kind, hash_combine(3, seed), index).next();
          ASSERT_GE(numbers[d], 0.0F);
          ASSERT_LT(numbers[d], 1.0F);
          bins[static_cast<std::size_t>(numbers[d] * 16.0F)] += 1.0;
        }
        double chi2 = 0.0;
        for (const double bin : bins) chi2 += (bin - 1000.0) * (bin - 1000.0) / 1000.0;
        EXPECT_LT(chi2, 46.0) << "index " << index << " dimension " << d;
      }
    }
  }
}

TEST(HashCombine, SeedsAndFramesNeverShareTheirNumbers) {
  std::set<std::uint64_t> hashes;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    for (std::uint64_t frame = 0; frame < 100; ++frame) hashes.insert(hash_combine(seed, frame));
  }
  EXPECT_EQ(hashes.size(), 100000U);
}

/// Whole numbers of cells and the greatest number below 1 round up without care.
TEST(Stratum, StaysBelowOne) {
  int rounded_up = 0;
  for (int count = 1; count <= 4096; ++count) {
    const int last = count - 1;
    if ((static_cast<float>(last) + kBelowOne) / static_cast<float>(count) >= 1.0F) ++rounded_up;
    ASSERT_LT(in_stratum(last, kBelowOne, count), 1.0F) << count;
    ASSERT_EQ(in_stratum(last, 0.0F, count), static_cast<float>(last) / static_cast<float>(count));
  }
  EXPECT_GT(rounded_up, 4000);
}

/// Points 2^32 apart are those of other randomisations, not copies.
TEST(SampleSequence, IndicesDoNotWrap) {
  for (const SequenceKind kind : {SequenceKind::sobol, SequenceKind::random}) {
    std::set<float> numbers;
    for (std::uint64_t run = 0; run < 50; ++run) {
      numbers.insert(SampleSequence(kind, 5, 3 + (run << 32)).next().x);
    }
    EXPECT_EQ(numbers.size(), 50U);
  }
}

TEST(SampleSequence, IsAFunctionOfSeedAndIndex) {
  SampleSequence a(SequenceKind::sobol, 5, 3);
  SampleSequence b(SequenceKind::sobol, 5, 3);
  EXPECT_EQ(a.next(), b.next());
  EXPECT_EQ(a.next(), b.next());
  EXPECT_NE(SampleSequence(SequenceKind::sobol, 6, 3).next(),
            SampleSequence(SequenceKind::sobol, 5, 3).next());
}

/// Burley's construction as it is written down, bit by bit.
glm::vec4 set_by_definition(std::uint64_t seed, std::uint32_t index, std::uint32_t set) {
  const std::uint64_t set_seed = hash_combine(seed, set);
  const auto fractions =
      sobol_point(owen_scramble(index, static_cast<std::uint32_t>(set_seed >> 32)));
  glm::vec4 numbers;
  for (int i = 0; i < kSobolDimensions; ++i) {
    const auto scramble =
        static_cast<std::uint32_t>(hash_combine(set_seed, static_cast<unsigned>(i)));
    const std::uint32_t bits = owen_scramble(fractions[static_cast<std::size_t>(i)], scramble);
    numbers[i] = static_cast<float>(bits >> 8) * 0x1p-24F;
  }
  return numbers;
}

TEST(SampleSequence, TablesGiveTheNumbersOfTheDefinition) {
  for (const std::uint32_t index : {0U, 1U, 2U, 3U, 17U, 255U, 256U, 65537U, 0x80000001U, ~0U}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      SampleSequence sequence(SequenceKind::sobol, seed, index);
      for (std::uint32_t set = 0; set < 8; ++set) {
        EXPECT_EQ(sequence.next(), set_by_definition(seed, index, set)) << index << " " << seed;
      }
    }
  }
}

}  // namespace
}  // namespace renderers::ray_tracing
