#include "metrics/penumbra_width.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;

constexpr Encoding kLinear = Encoding::scene_linear;

/// Light of 1 that falls to `dark` over a straight border of a linear ramp.
struct Shadow {
  double middle_px = 64.0;  ///< along the normal, from the corner at the top left
  double ramp_px = 20.0;
  double dark = 0.2;
  double normal_deg = 0.0;  ///< 0: the shadow lies to the right
};

Image shadow_picture(const Shadow& shadow, int width_px = 128, int height_px = 64) {
  const double radians = shadow.normal_deg * std::acos(-1.0) / 180.0;
  return picture(width_px, height_px, kLinear, [&](int x, int y) -> std::array<float, 3> {
    const double along = (x + 0.5) * std::cos(radians) + (y + 0.5) * std::sin(radians);
    const double share = std::clamp((along - shadow.middle_px) / shadow.ramp_px + 0.5, 0.0, 1.0);
    const auto value = static_cast<float>(1.0 - (1.0 - shadow.dark) * share);
    return {value, value, value};
  });
}

TEST(PenumbraWidth, OfALinearRampIsEightTenthsOfIt) {
  const Image reference = shadow_picture({});
  for (const double ramp_px : {6.0, 12.5, 24.0, 40.0}) {
    for (const double middle_px : {60.0, 63.3, 64.5}) {
      const Image test = shadow_picture({.middle_px = middle_px, .ramp_px = ramp_px});
      const auto score = score_of("penumbra-width", reference, test);
      EXPECT_NEAR(detail(score, "width_px"), 0.8 * ramp_px, 0.1) << ramp_px << " at " << middle_px;
      EXPECT_NEAR(detail(score, "reference_width_px"), 16.0, 0.01);
      EXPECT_NEAR(detail(score, "shift_px"), middle_px - 64.0, 0.1);
      EXPECT_DOUBLE_EQ(score.value, std::abs(std::log2(detail(score, "width_px")) -
                                             std::log2(detail(score, "reference_width_px"))));
    }
  }
}

TEST(PenumbraWidth, OfANarrowRampIsWithinTheBendsOfItsEnds) {
  for (const double ramp_px : {2.0, 3.0, 4.0}) {
    const Image image = shadow_picture({.middle_px = 63.3, .ramp_px = ramp_px});
    EXPECT_NEAR(detail(score_of("penumbra-width", image, image), "width_px"), 0.8 * ramp_px, 0.25);
  }
}

TEST(PenumbraWidth, IsMeasuredAlongTheLine) {
  // The line runs along the normal of a slanted border: 60 px from (34, 10) at 36.87 degrees.
  const Image reference = shadow_picture(
      {.middle_px = 34.0 * 0.8 + 10.0 * 0.6 + 30.0, .ramp_px = 20.0, .normal_deg = 36.8699});
  const std::string line = ",from_x=0.265625,from_y=0.15625,to_x=0.640625,to_y=0.71875";
  EXPECT_NEAR(detail(score_of("penumbra-width" + line, reference, reference), "width_px"), 16.0,
              0.1);
  // Along a row the same border is wider by the cosine.
  EXPECT_NEAR(
      detail(score_of("penumbra-width,from_y=0.3,to_y=0.3", reference, reference), "width_px"),
      16.0 / 0.8, 0.1);
}

TEST(PenumbraWidth, DoesNotDependOnTheLevels) {
  const Image reference = shadow_picture({.ramp_px = 16.0});
  const Image lighter = shadow_picture({.ramp_px = 16.0, .dark = 0.6});
  const auto score = score_of("penumbra-width", reference, lighter);
  EXPECT_NEAR(score.value, 0.0, 1e-5);
  EXPECT_NEAR(detail(score, "step"), 0.4, 1e-6);
  EXPECT_NEAR(detail(score, "reference_step"), 0.8, 1e-6);
}

TEST(PenumbraWidth, HalfAndTwiceTheWidthAreOneOctave) {
  const Image reference = shadow_picture({.ramp_px = 20.0});
  const Image wide = shadow_picture({.ramp_px = 40.0});
  const auto score = score_of("penumbra-width", reference, wide);
  EXPECT_NEAR(score.value, 1.0, 1e-3);
  EXPECT_NEAR(detail(score, "ratio"), 2.0, 1e-3);
  const auto exchanged = score_of("penumbra-width", wide, reference);
  EXPECT_DOUBLE_EQ(exchanged.value, score.value);
  EXPECT_NEAR(detail(exchanged, "ratio"), 0.5, 1e-3);
}

TEST(PenumbraWidth, ASharpBorderMeasuresEightTenthsOfAPixel) {
  const Image sharp = shadow_picture({.ramp_px = 1e-6});
  EXPECT_NEAR(detail(score_of("penumbra-width", sharp, sharp), "width_px"), 0.8, 1e-6);
}

TEST(PenumbraWidth, MirrorAndReverseChangeNothing) {
  const Image reference = shadow_picture({.middle_px = 50.0});
  const Image test = with_noise(shadow_picture({.middle_px = 55.0, .ramp_px = 30.0}), 0.02F);
  const auto value = [&](const char* line, bool is_mirrored) {
    const std::string metric = std::string("penumbra-width") + line;
    return is_mirrored ? score_of(metric, in_mirror(reference), in_mirror(test)).value
                       : score_of(metric, reference, test).value;
  };
  const double forth = value(",from_x=0.125,to_x=0.75", false);
  EXPECT_GT(forth, 0.3);
  EXPECT_NEAR(value(",from_x=0.75,to_x=0.125", false), forth, 1e-9);
  EXPECT_NEAR(value(",from_x=0.875,to_x=0.25", true), forth, 1e-9);
}

TEST(PenumbraWidth, OtherSizesMeasureTheSamePlace) {
  const std::string line = "penumbra-width,from_x=0.2,to_x=0.9,from_y=0.25,to_y=0.25";
  const Image small = shadow_picture({});
  const Image large = shadow_picture({.middle_px = 128.0, .ramp_px = 40.0}, 256, 128);
  EXPECT_NEAR(detail(score_of(line, large, large), "width_px"),
              2.0 * detail(score_of(line, small, small), "width_px"), 0.05);
}

TEST(PenumbraWidth, TheStripFightsNoise) {
  const Image reference = shadow_picture({.ramp_px = 30.0});
  const Image noisy = with_noise(reference, 0.15F);
  const double narrow = score_of("penumbra-width,strip=1", reference, noisy).value;
  const double wide = score_of("penumbra-width,strip=61", reference, noisy).value;
  EXPECT_LT(wide, 0.1);
  EXPECT_GT(narrow, 2.0 * wide);
}

TEST(PenumbraWidth, WithoutATransitionThereIsNoValue) {
  const Image reference = shadow_picture({});
  const Image lit = gray_picture(128, 64, kLinear, 1.0F);
  const auto lost = score_of("penumbra-width", reference, lit);
  EXPECT_TRUE(std::isnan(lost.value));
  EXPECT_TRUE(std::isnan(detail(lost, "width_px")));
  EXPECT_NEAR(detail(lost, "reference_width_px"), 16.0, 0.01);
  EXPECT_EQ(lost.non_finite_pixels, 0U);
  for (const float value : lost.map->pixels) EXPECT_EQ(value, 0.0F);
  EXPECT_TRUE(std::isnan(score_of("penumbra-width", lit, lit).value));
  // A line that stays in the light has none either.
  EXPECT_TRUE(std::isnan(score_of("penumbra-width,to_x=0.4", reference, reference).value));
}

TEST(PenumbraWidth, TheMaskLeavesPixelsOfTheStripOut) {
  const Image reference = shadow_picture({});
  Image test = reference;
  for (int x = 0; x < 128; ++x) {
    for (float& value : test.pixel(x, 31)) value = x < 90 ? 1.0F : 0.2F;
  }
  const Image others = mask_where(128, 64, [](int, int y) { return y != 31; });
  EXPECT_GT(score_of("penumbra-width", reference, test).value, 0.1);
  EXPECT_EQ(score_of("penumbra-width", reference, test, &others).value, 0.0);
}

TEST(PenumbraWidth, TheMapShowsTheStrip) {
  const auto score = score_of("penumbra-width,strip=6,to_x=0.75", shadow_picture({.ramp_px = 20.0}),
                              shadow_picture({.ramp_px = 40.0}));
  // 4.5 px behind the middle of both ramps: 0.725 against 0.6125 of the step.
  EXPECT_NEAR(score.map->at(68, 31), 0.725 - 0.6125, 0.02);
  EXPECT_EQ(score.map->at(68, 40), 0.0F);
  EXPECT_EQ(score.map->at(100, 31), 0.0F);
}

TEST(PenumbraWidth, RefusesBadLines) {
  const auto parse_error = [](const char* text) {
    return input_error_of([&] { metrics::parse_metric_choice(text, {}); });
  };
  EXPECT_EQ(parse_error("penumbra-width,from_x=0.5,to_x=0.5"),
            "metric \"penumbra-width\": the line starts and ends at (0.5, 0.5); accepted: two "
            "points");
  EXPECT_EQ(parse_error("penumbra-width,to_x=1.5"),
            "parameter \"to_x\" of metric \"penumbra-width\" cannot be \"1.5\"; accepted: a number "
            "from 0 to 1 (image widths)");
  EXPECT_EQ(parse_error("penumbra-width,strip=0"),
            "parameter \"strip\" of metric \"penumbra-width\" cannot be \"0\"; accepted: a whole "
            "number from 1 to 1000 (px)");
}

}  // namespace
