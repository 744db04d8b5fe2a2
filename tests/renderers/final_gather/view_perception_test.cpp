#include "renderers/final_gather/view_perception.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "renderers/ray_tracing/sample_sequence.h"

/// What a viewer of a preview can tell apart.
namespace renderers::test {
namespace {

using final_gather::MaskedBy;
using final_gather::ViewPerception;
using perception::Image;

constexpr int kSide_px = 256;

/// 100 cd/m2 with the soft edge of a shadow, 2 degrees wide, over all of it; the right half has a
/// fine texture of 40 % contrast besides.
Image shadow_over_two_halves(double pixels_per_degree) {
  Image image =
      perception::make_gray_image(kSide_px, kSide_px, "Y", perception::Encoding::luminance_cd_m2);
  for (int y = 0; y < kSide_px; ++y) {
    const double t = std::clamp((y - kSide_px / 2) / (2.0 * pixels_per_degree) + 0.5, 0.0, 1.0);
    const double light = 100.0 * (0.8 + 0.2 * t * t * (3.0 - 2.0 * t));
    for (int x = 0; x < kSide_px; ++x) {
      const auto number = static_cast<std::uint64_t>(y / 8 * kSide_px + x / 8);
      const bool is_bright = ray_tracing::hash_combine(7, number) % 2 == 0;
      const double texture = x < kSide_px / 2 ? 1.0 : is_bright ? 1.4 : 0.6;
      image.at(x, y) = static_cast<float>(texture * light);
    }
  }
  return image;
}

double mean_elevation(const ViewPerception& view, int first_x, int last_x) {
  double sum = 0.0;
  int count = 0;
  for (int y = 64; y < 192; ++y) {
    for (int x = first_x; x < last_x; ++x, ++count) {
      sum += view.elevation(static_cast<std::size_t>(y * kSide_px + x));
    }
  }
  return sum / count;
}

/// Fig. 4: a shadow that is clear on plain floor hides on a textured one. Together, all contrasts
/// do not tell the two apart, since the shadow's own ones are there.
TEST(ViewPerception, MatchedContrastsTellTextureFromPlainFloor) {
  constexpr double kPpd = 30.0;
  const auto seen = [&](MaskedBy by) {
    return ViewPerception(
        shadow_over_two_halves(kPpd),
        {.tone = final_gather::ToneOperator::linear, .masked_by = by, .pixels_per_degree = kPpd});
  };
  const ViewPerception matched = seen(MaskedBy::matched);
  EXPECT_LT(mean_elevation(matched, 16, 96), 1.1);
  EXPECT_GT(mean_elevation(matched, 160, 240), 2.5);
  const ViewPerception all = seen(MaskedBy::all);
  EXPECT_GT(mean_elevation(all, 16, 96), 1.4);
}

TEST(ViewPerception, ThresholdsBetweenFrequenciesAreBetweenTheirs) {
  const ViewPerception view(shadow_over_two_halves(30.0), {.pixels_per_degree = 30.0});
  const std::size_t count = view.frequency_count();
  ASSERT_GT(count, 4U);
  std::vector<double> thresholds(count);
  for (std::size_t i = 0; i < count; ++i) thresholds[i] = 1.0 + static_cast<double>(i * i);
  const double best = view.edge_frequency_cpd();
  const auto edge = static_cast<double>(view.edge());
  EXPECT_NEAR(view.at_frequency(thresholds, best), 1.0 + edge * edge, 1e-12);
  const double above = (edge + 1.0) * (edge + 1.0);
  EXPECT_NEAR(view.at_frequency(thresholds, best * std::sqrt(2.0)),
              1.0 + 0.5 * (edge * edge + above), 1e-9);
  EXPECT_EQ(view.at_frequency(thresholds, 1e-6), thresholds.front());
  EXPECT_EQ(view.at_frequency(thresholds, 1e6), thresholds.back());
}

/// Steps of a staircase: as many as the contrast has thresholds where the penumbra is wide, fewer
/// where they are so fine that the eye sees them less.
TEST(HiddenSteps, FinerStepsNeedNotBeAsLow) {
  const ViewPerception view(shadow_over_two_halves(60.0), {.pixels_per_degree = 60.0});
  std::vector<double> thresholds(view.frequency_count(), 0.5);
  for (std::size_t i = view.edge() + 1; i < thresholds.size(); ++i) {
    thresholds[i] = 2.0 * thresholds[i - 1];  // the threshold doubles with the frequency
  }
  constexpr double kChange = 20.0;
  const double best = view.edge_frequency_cpd();
  EXPECT_NEAR(hidden_steps(view, thresholds, kChange, 1000.0), 40.0, 1e-3);
  EXPECT_NEAR(hidden_steps(view, thresholds, kChange, 0.0), 40.0, 1e-3);
  // At an octave above the best frequency: N steps of N thresholds of 1 on N / (2 best) degrees.
  EXPECT_NEAR(hidden_steps(view, thresholds, kChange, 20.0 / (2.0 * best)), 20.0, 1e-3);
  const ViewPerception literal(shadow_over_two_halves(60.0),
                               {.masked_by = MaskedBy::all, .pixels_per_degree = 60.0});
  ASSERT_EQ(literal.frequency_count(), 1U);
  EXPECT_EQ(hidden_steps(literal, std::vector<double>{0.5}, kChange, 0.01), 40.0);
}

}  // namespace
}  // namespace renderers::test
