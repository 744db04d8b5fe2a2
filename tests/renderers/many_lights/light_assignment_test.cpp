#include "renderers/many_lights/light_assignment.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

namespace renderers::many_lights {
namespace {

std::vector<int> dealt(const std::vector<LightSlot>& slots, std::size_t emitters) {
  std::vector<int> counts(emitters, 0);
  for (const LightSlot& slot : slots) ++counts[static_cast<std::size_t>(slot.emitter)];
  return counts;
}

TEST(LightAssignment, SharesAreProportionalAndEverySumIsN) {
  EXPECT_EQ(light_counts(std::vector<double>{3.0, 1.0}, 1024), (std::vector<int>{768, 256}));
  EXPECT_EQ(light_counts(std::vector<double>{1.0, 1.0, 1.0}, 10), (std::vector<int>{4, 3, 3}));
  for (const int n : {1, 2, 7, 64, 1000, 1024}) {
    const std::vector<double> weights{5.0, 0.0, 1.7, 1e-9, 33.3};
    const std::vector<int> counts = light_counts(weights, n);
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), n);
    EXPECT_EQ(counts[1], 0) << "no flux, no light";
    for (const std::size_t e : {0U, 2U, 4U}) {
      EXPECT_LE(std::abs(counts[e] - weights[e] / 40.0 * n), 2.0) << n << " lights, emitter " << e;
    }
  }
}

TEST(LightAssignment, EveryEmitterWithFluxGetsALightIfThereAreEnough) {
  EXPECT_EQ(light_counts(std::vector<double>{1e6, 1.0, 1.0}, 8), (std::vector<int>{6, 1, 1}));
  // Too few: the heaviest get them.
  EXPECT_EQ(light_counts(std::vector<double>{1.0, 3.0, 2.0}, 2), (std::vector<int>{0, 1, 1}));
}

TEST(LightAssignment, NothingToDealWithoutFlux) {
  EXPECT_TRUE(assign_lights(std::vector<double>{}, 16).empty());
  EXPECT_TRUE(assign_lights(std::vector<double>{0.0, 0.0}, 16).empty());
}

TEST(LightAssignment, RanksCountUpAndMatchTheCounts) {
  const std::vector<double> weights{5.0, 1.7, 0.1, 33.3};
  const auto slots = assign_lights(weights, 333);
  ASSERT_EQ(slots.size(), 333U);
  EXPECT_EQ(dealt(slots, 4), light_counts(weights, 333));
  std::vector<int> next(4, 0);
  for (const LightSlot& slot : slots) {
    EXPECT_EQ(slot.index, next[static_cast<std::size_t>(slot.emitter)]++);
  }
}

TEST(LightAssignment, EveryRunOfSixteenHoldsItsShare) {
  const std::vector<double> weights{1.0, 2.0, 5.0, 8.0, 0.01};
  const int n = 1024;
  const auto slots = assign_lights(weights, n);
  const auto counts = light_counts(weights, n);
  for (std::size_t first = 0; first + 16 <= slots.size(); ++first) {
    const std::vector<LightSlot> run(slots.begin() + static_cast<std::ptrdiff_t>(first),
                                     slots.begin() + static_cast<std::ptrdiff_t>(first) + 16);
    const auto in_run = dealt(run, weights.size());
    for (std::size_t e = 0; e < weights.size(); ++e) {
      EXPECT_LE(std::abs(in_run[e] - 16.0 * counts[e] / n), 2.0) << "run at " << first;
    }
    EXPECT_GE(*std::min_element(in_run.begin(), in_run.begin() + 4), 0);
    EXPECT_GT(in_run[1] * in_run[2] * in_run[3], 0) << "every large emitter is in every run";
  }
}

}  // namespace
}  // namespace renderers::many_lights
