#include "suites/canary.h"

#include <gtest/gtest.h>

#include "perception/base/parallel.h"

namespace suites {
namespace {

/// The work is the same whoever does it: a time that differs is the machine's.
TEST(Canary, DoesTheSameWorkWithAnyNumberOfThreads) {
  const Canary canary;
  const CanaryResult two = canary.run();
  EXPECT_GT(two.wall_s, 0.0);
  const base::ThreadLimit limit(1);
  const CanaryResult one = canary.run();
  EXPECT_EQ(one.checksum, two.checksum);
  EXPECT_NE(one.checksum, 0U);
}

}  // namespace
}  // namespace suites
