#include "results/figures/pareto_front.h"

#include <gtest/gtest.h>

namespace {

using results::Estimate;
using results::figures::Contestant;
using results::figures::front_of;
using results::figures::pareto_standings;
using results::figures::Standing;

Estimate about(double value, double half, std::size_t count = 4) {
  return {value, value - half, value + half, count};
}

TEST(ParetoFront, OnlyClearDominanceRemovesARow) {
  const std::vector<Contestant> rows{
      {about(1.0, 0.1), about(4.0, 0.1)},    // fast
      {about(2.0, 0.1), about(2.0, 0.1)},    // in between
      {about(2.05, 0.1), about(2.05, 0.1)},  // worse than it, within the noise of both
      {about(2.05, 0.1), about(3.0, 0.1)},   // as fast, clearly less exact
      {about(3.0, 0.1), about(2.0, 0.1)},    // as exact, clearly slower
      {about(5.0, 0.1), about(1.0, 0.1)}};   // exact
  const auto standings = pareto_standings(rows);
  EXPECT_EQ(standings, (std::vector{Standing::front, Standing::front, Standing::undecided,
                                    Standing::dominated, Standing::dominated, Standing::front}));
  EXPECT_EQ(front_of(rows, standings), (std::vector<std::size_t>{0, 1, 5}));
}

TEST(ParetoFront, NothingIsClearAboutASingleSample) {
  const std::vector<Contestant> rows{{about(1.0, 0.0, 1), about(1.0, 0.0, 1)},
                                     {about(9.0, 0.0, 1), about(9.0, 0.0, 1)}};
  EXPECT_EQ(pareto_standings(rows)[1], Standing::undecided);
}

TEST(ParetoFront, EqualRowsAreBothOnIt) {
  const Contestant row{about(1.0, 0.1), about(1.0, 0.1)};
  EXPECT_EQ(pareto_standings({row, row}), (std::vector{Standing::front, Standing::front}));
}

}  // namespace
