#include "metrics/metric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;
using metrics::Score;

/// How much more the first pixel changes than it does in the reference: the smallest metric that
/// looks at two frames.
class FirstPixelFlicker : public metrics::SequenceMetric {
 public:
  int history_frames() const override { return 1; }
  std::vector<Score> evaluate(const metrics::SequencePair& pair,
                              const perception::ViewingConditions&) const override {
    std::vector<Score> scores;
    for (std::size_t i = 1; i < pair.test.size(); ++i) {
      const auto change = [i](std::span<const Image> frames) {
        return std::abs(double{frames[i].at(0, 0)} - double{frames[i - 1].at(0, 0)});
      };
      scores.emplace_back().value = change(pair.test) - change(pair.reference);
    }
    return scores;
  }
};

TEST(SequenceMetric, SpansThatOverlapByTheHistoryGiveTheScoresOfTheWhole) {
  std::vector<Image> reference, test;
  for (const float value : {0.0F, 0.5F, 0.5F, 0.25F, 1.0F}) {
    reference.push_back(gray_picture(2, 2, Encoding::display, 0.5F));
    test.push_back(gray_picture(2, 2, Encoding::display, value));
  }
  const FirstPixelFlicker metric;
  const auto values_of = [&](std::size_t first, std::size_t count) {
    const std::span<const Image> r(reference), t(test);
    std::vector<double> values;
    for (const Score& score :
         metric.evaluate({r.subspan(first, count), t.subspan(first, count)}, {})) {
      values.push_back(score.value);
    }
    return values;
  };
  EXPECT_EQ(values_of(0, 5), (std::vector<double>{0.5, 0.0, 0.25, 0.75}));
  std::vector<double> pieces = values_of(0, 3);
  for (const double value : values_of(2, 3)) pieces.push_back(value);
  EXPECT_EQ(pieces, values_of(0, 5));
  EXPECT_TRUE(values_of(0, 1).empty());
}

}  // namespace
