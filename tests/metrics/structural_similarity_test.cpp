#include "metrics/structural_similarity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;

cv::Mat luma_matrix(const Image& display) {
  cv::Mat luma(display.height_px, display.width_px, CV_64F);
  for (int y = 0; y < display.height_px; ++y) {
    for (int x = 0; x < display.width_px; ++x) {
      luma.at<double>(y, x) = 0.2126 * static_cast<double>(display.at(x, y, 0)) +
                              0.7152 * static_cast<double>(display.at(x, y, 1)) +
                              0.0722 * static_cast<double>(display.at(x, y, 2));
    }
  }
  return luma;
}

cv::Mat local_mean(const cv::Mat& values) {
  cv::Mat mean;
  cv::GaussianBlur(values, mean, cv::Size(11, 11), 1.5, 1.5, cv::BORDER_REPLICATE);
  return mean;
}

/// SSIM per pixel built from OpenCV's filters (Wang et al. 2004, Eq. 13).
cv::Mat opencv_ssim(const cv::Mat& x, const cv::Mat& y) {
  const double c1 = 0.01 * 0.01;
  const double c2 = 0.03 * 0.03;
  const cv::Mat mx = local_mean(x);
  const cv::Mat my = local_mean(y);
  const cv::Mat vx = local_mean(x.mul(x)) - mx.mul(mx);
  const cv::Mat vy = local_mean(y.mul(y)) - my.mul(my);
  const cv::Mat vxy = local_mean(x.mul(y)) - mx.mul(my);
  const cv::Mat above = (2.0 * mx.mul(my) + c1).mul(2.0 * vxy + c2);
  const cv::Mat below = (mx.mul(mx) + my.mul(my) + c1).mul(vx + vy + c2);
  cv::Mat ratio;
  cv::divide(above, below, ratio);
  return ratio;
}

TEST(StructuralSimilarity, AgreesWithOneBuiltFromOpenCv) {
  const Image reference = wavy_picture(61, 47, Encoding::display);
  const Image test = with_noise(reference, 0.15F);
  const cv::Mat expected = opencv_ssim(luma_matrix(reference), luma_matrix(test));
  const cv::Mat inside = expected(cv::Rect(5, 5, 61 - 10, 47 - 10));

  const auto score = score_of("ssim", reference, test);
  EXPECT_NEAR(score.value, cv::mean(inside)[0], 1e-7);
  EXPECT_EQ(detail(score, "pooled_pixels"), 51.0 * 37.0);
  for (int y = 0; y < 47; ++y) {
    for (int x = 0; x < 61; ++x) {
      ASSERT_NEAR(score.map->at(x, y), 1.0 - expected.at<double>(y, x), 1e-6) << x << "," << y;
    }
  }
  // The mean over all pixels, borders included, is another number.
  EXPECT_GT(std::abs(cv::mean(expected)[0] - cv::mean(inside)[0]), 1e-4);
}

TEST(StructuralSimilarity, OfUniformImagesIsTheLuminanceTerm) {
  const Image reference = gray_picture(20, 20, Encoding::display, 0.5F);
  const Image test = gray_picture(20, 20, Encoding::display, 0.25F);
  const double expected = (2.0 * 0.5 * 0.25 + 1e-4) / (0.25 + 0.0625 + 1e-4);
  EXPECT_NEAR(score_of("ssim", reference, test).value, expected, 1e-7);
}

TEST(StructuralSimilarity, OfAnInvertedPatternIsNegative) {
  const auto stripes = [](float sign) {
    return picture(32, 32, Encoding::display, [&](int x, int) -> std::array<float, 3> {
      const float value = 0.5F + sign * (x % 2 == 0 ? 0.3F : -0.3F);
      return {value, value, value};
    });
  };
  EXPECT_LT(score_of("ssim", stripes(1.0F), stripes(-1.0F)).value, -0.9);
}

TEST(StructuralSimilarity, PoolsEverythingWhereNoWindowFits) {
  const Image reference = wavy_picture(10, 30, Encoding::display);
  const auto score = score_of("ssim", reference, with_noise(reference, 0.1F));
  EXPECT_EQ(detail(score, "pooled_pixels"), 300.0);
}

TEST(StructuralSimilarity, FactorsMultiplyToTheIndex) {
  const Image reference = wavy_picture(24, 24, Encoding::display);
  const Image test = with_noise(reference, 0.2F);
  const auto maps =
      metrics::similarity_maps(metrics::display_luma(reference), metrics::display_luma(test));
  const auto score = score_of("ssim", reference, test);
  for (std::size_t i = 0; i < maps.luminance.values.size(); ++i) {
    EXPECT_FLOAT_EQ(score.map->pixels[i],
                    1.0F - maps.luminance.values[i] * maps.contrast_structure.values[i]);
  }
}

}  // namespace
