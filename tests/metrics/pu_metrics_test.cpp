#include "metrics/pu_metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "perception/perceptual_encoding.h"
#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;
using perception::PerceptualCurve;
using perception::pu_encode;

Image light(float cd_m2) { return gray_picture(24, 20, Encoding::luminance_cd_m2, cd_m2); }

TEST(PuMetrics, PsnrOfUniformLightIsTheDifferenceOfTheEncodedValues) {
  // 256.3839 - 212.7873 for 100 and 50 cd/m2.
  EXPECT_NEAR(score_of("pu-psnr", light(100.0F), light(50.0F)).value,
              20.0 * std::log10(256.0 / (256.3839 - 212.7873)), 1e-4);
  const double peaks =
      pu_encode(100.0, PerceptualCurve::peaks) - pu_encode(50.0, PerceptualCurve::peaks);
  EXPECT_NEAR(score_of("pu-psnr,encoding=peaks", light(100.0F), light(50.0F)).value,
              20.0 * std::log10(256.0 / peaks), 1e-6);
}

TEST(PuMetrics, TheSameStepOfLightCountsMoreInTheDark) {
  EXPECT_LT(score_of("pu-psnr", light(1.0F), light(3.0F)).value,
            score_of("pu-psnr", light(1000.0F), light(1002.0F)).value - 40.0);
}

TEST(PuMetrics, LuminanceMissesWhatOnlyChangesColour) {
  const Image gray = light(40.0F);
  // Red up, green down: luminance 0.212656 R + 0.715158 G + 0.072186 B stays.
  const float red = 10.0F;
  const Image tinted = uniform_picture(24, 20, Encoding::luminance_cd_m2,
                                       {40.0F + red, 40.0F - red * 0.212656F / 0.715158F, 40.0F});
  EXPECT_LT(score_of("pu-psnr", gray, tinted).value, 35.0);
  EXPECT_GT(score_of("pu-psnr,channels=luminance", gray, tinted).value, 100.0);
}

TEST(PuMetrics, SsimIsThatOfTheEncodedLuminance) {
  const double a = pu_encode(100.0, PerceptualCurve::banding_glare) / 256.0;
  const double b = pu_encode(50.0, PerceptualCurve::banding_glare) / 256.0;
  const double expected = (2.0 * a * b + 1e-4) / (a * a + b * b + 1e-4);
  EXPECT_NEAR(score_of("pu-ssim", light(100.0F), light(50.0F)).value, expected, 1e-6);
  EXPECT_NEAR(score_of("pu-ms-ssim,scales=1", light(100.0F), light(50.0F)).value,
              std::pow(expected, 1.0001), 1e-6);
}

TEST(PuMetrics, CountsLightOutsideTheEncoding) {
  Image dark = light(10.0F);
  dark.at(3, 4, 0) = -1.0F;
  dark.at(5, 6, 2) = 2e4F;
  const auto score = score_of("pu-psnr", light(10.0F), dark);
  EXPECT_EQ(detail(score, "clipped_values"), 2.0);
  EXPECT_TRUE(std::isfinite(score.value));
  EXPECT_EQ(detail(score_of("pu-ssim", light(10.0F), light(0.001F)), "clipped_values"), 480.0);
}

TEST(PuMetrics, TheDisplayDecidesWhatIsVisible) {
  const Image reference = wavy_picture(40, 40, Encoding::display);
  const Image test = with_noise(reference, 0.05F);
  perception::ViewingConditions bright;
  bright.ambient_lux = 20000.0;  // washes out
  const auto choice = metrics::parse_metric_choice("pu-psnr", {});
  EXPECT_GT(metrics::score(choice, {reference, test}, bright).value,
            score_of("pu-psnr", reference, test).value + 0.5);
}

TEST(PuMetrics, RefusesAnUnknownEncoding) {
  EXPECT_EQ(input_error_of([] { metrics::parse_metric_choice("pu-ssim,encoding=pu08", {}); }),
            "parameter \"encoding\" of metric \"pu-ssim\" cannot be \"pu08\"; accepted: one of "
            "banding, banding_glare, peaks, peaks_glare");
}

}  // namespace
