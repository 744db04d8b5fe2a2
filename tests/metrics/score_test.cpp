#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "metrics/metric_list.h"
#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

metrics::ScoreOptions ignoring() { return {.ignore_non_finite = true, .with_map = true}; }

TEST(Score, SizesMustAgree) {
  const Image wide = gray_picture(4, 3, Encoding::display, 0.5F);
  const Image high = gray_picture(3, 4, Encoding::display, 0.5F);
  EXPECT_EQ(input_error_of([&] { score_of("mse", wide, high); }),
            "the reference is 4x3 pixels, the test 3x4; accepted: images of the same size");
  const Image mask = mask_where(3, 4, [](int, int) { return true; });
  EXPECT_EQ(input_error_of([&] { score_of("mse", wide, wide, &mask); }),
            "the reference is 4x3 pixels, the mask 3x4; accepted: images of the same size");
}

TEST(Score, EmptyImagesAndBadMasksAreRefused) {
  const Image empty;
  EXPECT_EQ(input_error_of([&] { score_of("mse", empty, empty); }),
            "the images have no pixels; accepted: at least 1x1");
  const Image image = gray_picture(2, 2, Encoding::display, 0.5F);
  Image mask = mask_where(2, 2, [](int, int) { return false; });
  EXPECT_EQ(input_error_of([&] { score_of("mse", image, image, &mask); }),
            "the mask leaves no pixel; accepted: a mask with at least one 1");
  mask.at(0, 0) = 0.5F;
  EXPECT_EQ(input_error_of([&] { score_of("mse", image, image, &mask); }),
            "the mask holds the value 0.5; accepted: 0 (left out) and 1");
  EXPECT_EQ(input_error_of([&] { score_of("mse", image, image, &image); }),
            "the mask has 3 channels; accepted: one channel of 0 and 1");
}

TEST(Score, ANonFinitePixelMakesTheValueNaN) {
  const Image reference = gray_picture(6, 5, Encoding::scene_linear, 0.5F);
  Image test = reference;
  test.at(4, 3, 1) = kInfinity;
  test.at(2, 3, 0) = kNan;
  test.at(2, 3, 1) = kNan;
  const auto score = score_of("mse", reference, test);
  EXPECT_TRUE(std::isnan(score.value));
  EXPECT_EQ(score.non_finite_pixels, 2U);
  EXPECT_EQ(detail(score, "first_non_finite_x_px"), 2.0);
  EXPECT_EQ(detail(score, "first_non_finite_y_px"), 3.0);
  EXPECT_FALSE(score.map.has_value());
}

TEST(Score, IgnoringNonFinitePixelsDividesByTheOthers) {
  const Image reference = gray_picture(2, 2, Encoding::scene_linear, 0.5F);
  Image test = gray_picture(2, 2, Encoding::scene_linear, 0.75F);
  test.at(0, 0, 2) = kNan;
  const auto score = score_of("mse", reference, test, nullptr, ignoring());
  // Dividing by all four pixels would give 0.046875.
  EXPECT_DOUBLE_EQ(score.value, 0.0625);
  EXPECT_EQ(score.non_finite_pixels, 1U);
  EXPECT_EQ(score.map->at(0, 0), 0.0F);
  EXPECT_DOUBLE_EQ(score_of("mae", reference, test, nullptr, ignoring()).value, 0.25);
}

TEST(Score, NonFinitePixelsOfEitherImageCountOnce) {
  Image reference = gray_picture(3, 1, Encoding::scene_linear, 0.5F);
  Image test = reference;
  reference.at(0, 0, 0) = kNan;
  test.at(0, 0, 0) = kNan;
  reference.at(1, 0, 0) = kInfinity;
  const auto score = score_of("mse", reference, test, nullptr, ignoring());
  EXPECT_EQ(score.non_finite_pixels, 2U);
  EXPECT_EQ(score.value, 0.0);
}

TEST(Score, NothingFiniteIsRefusedEvenWhenIgnoring) {
  const Image reference = gray_picture(2, 2, Encoding::scene_linear, kNan);
  EXPECT_EQ(input_error_of([&] { score_of("mse", reference, reference, nullptr, ignoring()); }),
            "no pixel is finite in both images; nothing is left to score");
}

TEST(Score, NonFinitePixelsOutsideTheMaskDoNotCountButAreReported) {
  const Image reference = gray_picture(4, 4, Encoding::scene_linear, 0.5F);
  Image test = gray_picture(4, 4, Encoding::scene_linear, 0.75F);
  test.at(0, 0, 0) = kNan;
  const Image mask = mask_where(4, 4, [](int x, int) { return x > 1; });
  const auto score = score_of("mse", reference, test, &mask);
  EXPECT_DOUBLE_EQ(score.value, 0.0625);
  EXPECT_EQ(score.non_finite_pixels, 0U);
  EXPECT_EQ(detail(score, "non_finite_pixels_outside_mask"), 1.0);
}

TEST(Score, OnlyRedGreenAndBlueCount) {
  Image reference(2, 1, {"R", "G", "B", "Z"}, Encoding::scene_linear);
  Image test = reference;
  test.at(0, 0, 3) = kInfinity;
  const auto score = score_of("mse", reference, test);
  EXPECT_EQ(score.value, 0.0);
  EXPECT_EQ(score.non_finite_pixels, 0U);
}

TEST(Score, MapsAreLeftOutOnRequest) {
  const Image image = gray_picture(2, 2, Encoding::display, 0.5F);
  EXPECT_TRUE(score_of("flip", image, image).map.has_value());
  const metrics::ScoreOptions options{.ignore_non_finite = false, .with_map = false};
  EXPECT_FALSE(score_of("flip", image, image, nullptr, options).map.has_value());
}

}  // namespace
