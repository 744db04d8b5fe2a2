#include "suites/bisection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace {

using suites::bisect;
using suites::Bisection;
using suites::Trial;

TEST(Bisection, FindsTheFirstBadOneOfEveryListInAboutLog2Tries) {
  for (std::size_t count = 2; count <= 70; ++count) {
    std::size_t most_tries = 0;
    while ((std::size_t{1} << most_tries) < count - 1) ++most_tries;
    for (std::size_t first_bad = 1; first_bad < count; ++first_bad) {
      std::set<std::size_t> tried;
      const Bisection found = bisect(count, [&](std::size_t i) {
        EXPECT_TRUE(i > 0 && i < count - 1 && tried.insert(i).second) << i;
        return i < first_bad ? Trial::good : Trial::bad;
      });
      EXPECT_EQ(found.first_bad, first_bad);
      EXPECT_EQ(found.last_good, first_bad - 1);
      EXPECT_TRUE(found.is_exact());
      EXPECT_LE(tried.size(), most_tries) << count << " revisions, first bad " << first_bad;
    }
  }
}

/// What cannot be judged is passed over where its neighbours tell, and named where they do not.
TEST(Bisection, PassesOverWhatCannotBeJudged) {
  constexpr std::size_t kCount = 12;
  for (std::size_t first_bad = 1; first_bad < kCount; ++first_bad) {
    for (std::size_t pattern = 0; pattern < (1U << (kCount - 2)); ++pattern) {
      const auto is_unknown = [&](std::size_t i) {
        return i > 0 && i < kCount - 1 && (pattern >> (i - 1) & 1U) != 0;
      };
      const Bisection found = bisect(kCount, [&](std::size_t i) {
        if (is_unknown(i)) return Trial::unknown;
        return i < first_bad ? Trial::good : Trial::bad;
      });
      std::size_t last_good = first_bad - 1;
      while (is_unknown(last_good)) --last_good;
      std::size_t first_seen = first_bad;
      while (is_unknown(first_seen)) ++first_seen;
      ASSERT_EQ(found.last_good, last_good);
      ASSERT_EQ(found.first_bad, first_seen);
      ASSERT_EQ(found.unknown_between.size(), first_seen - last_good - 1);
    }
  }
}

}  // namespace
