#include "metrics/pixel_error.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "perception/color_conversion.h"
#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;

TEST(PixelError, ClosedFormsOnUniformImages) {
  const Image reference = gray_picture(7, 5, Encoding::scene_linear, 0.5F);
  const Image test = gray_picture(7, 5, Encoding::scene_linear, 0.75F);
  EXPECT_DOUBLE_EQ(score_of("mse", reference, test).value, 0.0625);
  EXPECT_DOUBLE_EQ(score_of("mae", reference, test).value, 0.25);
  EXPECT_DOUBLE_EQ(score_of("relmse", reference, test).value, 0.0625 / 0.26);
  EXPECT_DOUBLE_EQ(score_of("smape", reference, test).value, 0.25 / 1.26);
}

TEST(PixelError, MeanGoesOverPixelsAndChannels) {
  // One of two pixels differs, by 0.5 in one of three channels.
  const Image reference = gray_picture(2, 1, Encoding::scene_linear, 1.0F);
  Image test = reference;
  test.at(1, 0, 2) = 1.5F;
  const auto score = score_of("mse", reference, test);
  EXPECT_DOUBLE_EQ(score.value, 0.25 / 6.0);
  EXPECT_EQ(score.map->at(0, 0), 0.0F);
  EXPECT_FLOAT_EQ(score.map->at(1, 0), 0.25F / 3.0F);
}

TEST(PixelError, NegativeValuesCountWithTheirSize) {
  const Image reference = gray_picture(1, 1, Encoding::scene_linear, 0.25F);
  const Image test = gray_picture(1, 1, Encoding::scene_linear, -0.25F);
  EXPECT_DOUBLE_EQ(score_of("smape", reference, test).value, 0.5 / 0.51);
}

TEST(PixelError, RelativeErrorsHoldForEveryFloat) {
  // Squares beyond the range of floats, among pixels that are not.
  const Image reference = picture(70, 2, Encoding::scene_linear, [](int x, int) {
    return x % 2 == 0 ? std::array<float, 3>{1e30F, 1e30F, 1e30F}
                      : std::array<float, 3>{0.5F, 0.5F, 0.5F};
  });
  Image test = reference;
  for (float& value : test.pixels) value *= -1.0F;
  const auto relmse = score_of("relmse", reference, test);
  EXPECT_FLOAT_EQ(relmse.map->at(0, 0), 4.0F);
  EXPECT_FLOAT_EQ(relmse.map->at(1, 0), 1.0F / 0.26F);
  EXPECT_DOUBLE_EQ(relmse.value, (4.0 + 1.0 / 0.26) / 2.0);
  const Image greatest = gray_picture(3, 1, Encoding::scene_linear, 3e38F);
  const Image least = gray_picture(3, 1, Encoding::scene_linear, -3e38F);
  EXPECT_DOUBLE_EQ(score_of("smape", greatest, least).value, 1.0);
}

TEST(PixelError, RelativeRmseIsTheRootOverTheMean) {
  // One of two pixels is 1.5 instead of 1 in one channel; the means go over six values.
  const Image reference = picture(2, 1, Encoding::scene_linear, [](int x, int) {
    return x == 0 ? std::array<float, 3>{0.5F, 1.0F, 3.0F} : std::array<float, 3>{2.0F, 0.5F, 1.0F};
  });
  Image test = reference;
  test.at(1, 0, 2) = 1.5F;
  const auto score = score_of("relative-rmse", reference, test);
  EXPECT_DOUBLE_EQ(score.value, std::sqrt(0.25 / 6.0) / (8.0 / 6.0));
  EXPECT_DOUBLE_EQ(detail(score, "mse"), 0.25 / 6.0);
  EXPECT_DOUBLE_EQ(detail(score, "reference_mean"), 8.0 / 6.0);
  EXPECT_EQ(score.map->at(0, 0), 0.0F);
  EXPECT_FLOAT_EQ(score.map->at(1, 0), std::sqrt(0.25F / 3.0F) / (8.0F / 6.0F));
  // Both means go over what the mask leaves; relmse's root is another number.
  const Image right = mask_where(2, 1, [](int x, int) { return x == 1; });
  EXPECT_DOUBLE_EQ(score_of("relative-rmse", reference, test, &right).value,
                   std::sqrt(0.25 / 3.0) / (3.5 / 3.0));
  EXPECT_GT(std::abs(std::sqrt(score_of("relmse", reference, test).value) - score.value), 0.01);
}

TEST(PixelError, RelativeRmseDoesNotChangeWithTheScale) {
  const Image reference = wavy_picture(16, 16, Encoding::scene_linear);
  const Image test = with_noise(reference, 0.1F);
  const auto doubled = [](Image image) {
    for (float& value : image.pixels) value *= 2.0F;
    return image;
  };
  EXPECT_DOUBLE_EQ(score_of("relative-rmse", doubled(reference), doubled(test)).value,
                   score_of("relative-rmse", reference, test).value);
}

TEST(PixelError, RelativeRmseOfABlackReferenceIsUndefined) {
  const Image black = gray_picture(4, 4, Encoding::scene_linear, 0.0F);
  const auto score =
      score_of("relative-rmse", black, gray_picture(4, 4, Encoding::scene_linear, 1.0F));
  EXPECT_TRUE(std::isnan(score.value));
  EXPECT_EQ(detail(score, "reference_mean"), 0.0);
  EXPECT_EQ(score.non_finite_pixels, 0U);
  for (const float value : score.map->pixels) EXPECT_EQ(value, 0.0F);
  EXPECT_EQ(score_of("relative-rmse", black, black).value, 0.0);
}

TEST(PixelError, TrimDropsTheOneWrongPixel) {
  // The example of SimpleImageIO's tests: 2 x 2 pixels, one of them 0 against 1.
  const Image reference = gray_picture(2, 2, Encoding::scene_linear, 1.0F);
  Image test = reference;
  for (float& value : test.pixel(1, 0)) value = 0.0F;
  EXPECT_DOUBLE_EQ(score_of("mse", reference, test).value, 0.25);
  EXPECT_DOUBLE_EQ(score_of("mse,trim=0.25", reference, test).value, 0.0);
  // A twelfth of the channel errors less: two ones of eleven values are left.
  EXPECT_DOUBLE_EQ(score_of("mse,trim=0.0834", reference, test).value, 2.0 / 11.0);
}

TEST(PixelError, DisplayImagesAreDecoded) {
  const Image reference = wavy_picture(16, 16, Encoding::display);
  const Image test = with_noise(reference, 0.1F);
  const auto linear = [](const Image& image) { return perception::srgb_decoded(image); };
  for (const char* metric : {"mse", "relmse", "relative-rmse", "mae", "smape"}) {
    EXPECT_DOUBLE_EQ(score_of(metric, reference, test).value,
                     score_of(metric, linear(reference), linear(test)).value);
  }
}

TEST(PixelError, PsnrOfATenthOfThePeakIsTwentyDecibels) {
  const Image reference = gray_picture(4, 4, Encoding::display, 0.5F);
  const auto score = score_of("psnr", reference, gray_picture(4, 4, Encoding::display, 0.6F));
  EXPECT_NEAR(score.value, 20.0, 1e-5);
  EXPECT_NEAR(detail(score, "mse"), 0.01, 1e-8);
}

TEST(PixelError, PsnrUsesTheExposureOfTheViewingConditions) {
  const auto at_exposure = [](float reference, float test, double exposure_ev) {
    perception::ViewingConditions viewing;
    viewing.exposure_ev = exposure_ev;
    const Image a = gray_picture(4, 4, Encoding::scene_linear, reference);
    const Image b = gray_picture(4, 4, Encoding::scene_linear, test);
    return metrics::score(metrics::parse_metric_choice("psnr", {}), {a, b}, viewing).value;
  };
  EXPECT_NEAR(at_exposure(0.25F, 0.2F, 1.0), at_exposure(0.5F, 0.4F, 0.0), 1e-5);
  EXPECT_GT(std::abs(at_exposure(0.25F, 0.2F, 1.0) - at_exposure(0.25F, 0.2F, 0.0)), 0.5);
  // Both are above the display's white.
  EXPECT_TRUE(std::isinf(at_exposure(0.25F, 0.5F, 3.0)));
}

TEST(PixelError, AbsoluteLightIsRefused) {
  const Image light = gray_picture(2, 2, Encoding::luminance_cd_m2, 80.0F);
  EXPECT_EQ(input_error_of([&] { score_of("relmse", light, light); }),
            "metric \"relmse\" takes images with encoding scene_linear or display, not "
            "luminance_cd_m2");
}

}  // namespace
