#include "metrics/flicker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "perception/base/parallel.h"
#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;
using perception::Image;

constexpr int kWidthPx = 64;
constexpr int kHeightPx = 48;
constexpr std::size_t kFrames = 4;

/// A pattern that moves by `speed_px` from frame to frame.
std::vector<Image> moving(int speed_px) {
  std::vector<Image> frames;
  for (int t = 0; t < static_cast<int>(kFrames); ++t) {
    frames.push_back(
        picture(kWidthPx, kHeightPx, Encoding::display, [&](int x, int y) -> std::array<float, 3> {
          const auto u = static_cast<float>(x + speed_px * t);
          const auto v = static_cast<float>(y);
          const float value = 0.5F + 0.2F * std::sin(0.3F * u) * std::cos(0.2F * v);
          return {value, value, value};
        }));
  }
  return frames;
}

/// The frames with noise that is another one in each.
std::vector<Image> with_temporal_noise(std::vector<Image> frames, float amplitude) {
  std::uint32_t state = 3;
  for (Image& frame : frames) {
    for (float& value : frame.pixels) {
      state = state * 1664525U + 1013904223U;
      value += amplitude * (static_cast<float>(state >> 8) * 0x1p-23F - 1.0F);
    }
  }
  return frames;
}

std::vector<metrics::Score> scores_of(const std::vector<Image>& reference,
                                      const std::vector<Image>& test, const Image* mask = nullptr,
                                      const std::string& metric = "flicker") {
  const auto choice = metrics::parse_sequence_metric_choice(metric, {});
  return choice.info->create(choice.parameters)
      ->evaluate({.reference = reference, .test = test, .mask = mask}, {});
}

TEST(Flicker, StillPicturesHaveNoneHoweverWrong) {
  std::vector<Image> wrong = moving(0);
  for (Image& frame : wrong) frame = with_noise(frame, 0.2F);
  const auto scores = scores_of(moving(0), wrong);
  ASSERT_EQ(scores.size(), kFrames - 1);
  for (const auto& score : scores) {
    EXPECT_EQ(score.value, 0.0);
    EXPECT_EQ(detail(score, "jnd_max"), 0.0);
    for (const float value : score.map->pixels) EXPECT_EQ(value, 0.0F);
  }
}

TEST(Flicker, MovingAsTheReferenceDoesIsNone) {
  for (const auto& score : scores_of(moving(3), moving(3))) EXPECT_EQ(score.value, 0.0);
}

TEST(Flicker, MotionThatTheReferenceHasNotIsSome) {
  for (const auto& score : scores_of(moving(0), moving(3))) EXPECT_GT(score.value, 0.1);
  for (const auto& score : scores_of(moving(3), moving(0))) EXPECT_GT(score.value, 0.1);
}

TEST(Flicker, GrowsWithTemporalNoise) {
  for (const int speed_px : {0, 2}) {
    double last = 0.0;
    for (const float amplitude : {0.001F, 0.01F, 0.05F, 0.1F}) {
      const auto scores =
          scores_of(moving(speed_px), with_temporal_noise(moving(speed_px), amplitude));
      double sum = 0.0;
      for (const auto& score : scores) sum += score.value;
      EXPECT_GT(sum, last) << amplitude;
      last = sum;
    }
  }
}

TEST(Flicker, AStepOfOneThresholdIsOneJnd) {
  const auto gray = [](float light) {
    return gray_picture(kWidthPx, kHeightPx, Encoding::luminance_cd_m2, light);
  };
  // Ward Larson et al. 1997: the threshold at 100 cd/m2 is 5.55904.
  const auto scores = scores_of({gray(100.0F), gray(100.0F), gray(100.0F)},
                                {gray(100.0F), gray(105.55904F), gray(105.55904F)});
  ASSERT_EQ(scores.size(), 2U);
  EXPECT_NEAR(scores[0].value, 1.0, 1e-4);
  EXPECT_EQ(scores[1].value, 0.0);
}

TEST(Flicker, TextureHidesIt) {
  const auto textured = [](float amplitude, float extra) {
    std::vector<Image> frames;
    for (int t = 0; t < 2; ++t) {
      frames.push_back(picture(
          kWidthPx, kHeightPx, Encoding::luminance_cd_m2, [&](int x, int) -> std::array<float, 3> {
            const float side = x / 4 % 2 == 0 ? 1.0F : -1.0F;
            const float value = 60.0F + amplitude * side + extra * static_cast<float>(t);
            return {value, value, value};
          }));
    }
    return frames;
  };
  const auto value = [&](float amplitude) {
    return scores_of(textured(amplitude, 0.0F), textured(amplitude, 4.0F))[0].value;
  };
  EXPECT_LT(value(20.0F), 0.5 * value(0.0F));
}

TEST(Flicker, SpansThatOverlapGiveTheScoresOfTheWhole) {
  const auto reference = moving(1);
  const auto test = with_temporal_noise(reference, 0.05F);
  const auto whole = scores_of(reference, test);
  const auto later =
      scores_of({reference.begin() + 2, reference.end()}, {test.begin() + 2, test.end()});
  ASSERT_EQ(later.size(), 1U);
  EXPECT_EQ(later[0].value, whole[2].value);
  EXPECT_TRUE(scores_of({reference[0]}, {test[0]}).empty());
  const auto& info = metrics::find_sequence_metric("flicker", {});
  const auto choice = metrics::parse_sequence_metric_choice("flicker", {});
  EXPECT_EQ(info.create(choice.parameters)->history_frames(), 1);
}

TEST(Flicker, TheMaskRestricts) {
  auto test = moving(0);
  for (int y = 0; y < kHeightPx; ++y) {
    for (int x = 0; x < 10; ++x) test[1].at(x, y, 1) += 0.2F;
  }
  const Image left = mask_where(kWidthPx, kHeightPx, [](int x, int) { return x < 10; });
  const Image right = mask_where(kWidthPx, kHeightPx, [](int x, int) { return x >= 10; });
  const double whole = scores_of(moving(0), test)[0].value;
  EXPECT_GT(scores_of(moving(0), test, &left)[0].value, whole);
  EXPECT_EQ(scores_of(moving(0), test, &right)[0].value, 0.0);
}

TEST(Flicker, ThreadsDoNotChangeAByte) {
  const auto test = with_temporal_noise(moving(1), 0.05F);
  const auto with_threads = [&](int threads) {
    const base::ThreadLimit limit(threads);
    return scores_of(moving(1), test);
  };
  const auto one = with_threads(1);
  const auto two = with_threads(2);
  EXPECT_EQ(one[0].value, two[0].value);
  EXPECT_EQ(one[0].map->pixels, two[0].map->pixels);
}

TEST(Flicker, NonFinitePixelsPoisonTheirFramesOnly) {
  auto test = moving(0);
  test[0].at(3, 4, 1) = std::numeric_limits<float>::quiet_NaN();
  const auto scores = scores_of(moving(0), test);
  EXPECT_TRUE(std::isnan(scores[0].value));
  EXPECT_EQ(scores[0].non_finite_pixels, 1U);
  EXPECT_EQ(scores[1].value, 0.0);
}

TEST(Flicker, RefusesWhatDoesNotAgree) {
  auto shorter = moving(0);
  shorter.pop_back();
  EXPECT_EQ(input_error_of([&] { scores_of(moving(0), shorter); }),
            "metric \"flicker\": 4 reference frames and 3 test frames; accepted: equal numbers");
  EXPECT_EQ(input_error_of([&] { scores_of({}, {}); }),
            "metric \"flicker\": no frames; accepted: at least one");
  auto smaller = moving(0);
  smaller[2] = perception::crop(smaller[2], 0, 0, 5, 6);
  EXPECT_EQ(input_error_of([&] { scores_of(moving(0), smaller); }),
            "metric \"flicker\": test frame 2 is 5x6 pixels, the first reference frame 64x48; "
            "accepted: one size");
  EXPECT_EQ(input_error_of([&] { metrics::parse_sequence_metric_choice("flickr", {}); }),
            "unknown sequence metric \"flickr\"; did you mean \"flicker\"? known: flicker");
}

TEST(Flicker, ItsEntryDescribesItself) {
  ASSERT_EQ(metrics::sequence_metric_list().size(), 1U);
  const auto& info = metrics::sequence_metric_list()[0];
  EXPECT_EQ(info.name, "flicker");
  EXPECT_EQ(info.map_scale.unit, info.map_unit);
  EXPECT_EQ(info.shares_model_with, std::vector<std::string>{"grid-final-gather"});
  for (const auto& parameter : info.parameters) EXPECT_FALSE(parameter.doc.empty());
}

}  // namespace
