#include "metrics/multi_scale_similarity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "metrics/structural_similarity.h"
#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;

/// Mean luminance and contrast-structure terms of one scale, from OpenCV's filters.
struct Terms {
  double similarity = 0.0;
  double contrast_structure = 0.0;
};

Terms opencv_terms(const cv::Mat& x, const cv::Mat& y) {
  const auto mean = [](const cv::Mat& values) {
    cv::Mat blurred;
    cv::GaussianBlur(values, blurred, cv::Size(11, 11), 1.5, 1.5, cv::BORDER_REPLICATE);
    return blurred;
  };
  const double c1 = 1e-4;
  const double c2 = 9e-4;
  const cv::Mat mx = mean(x), my = mean(y);
  const cv::Mat vx = mean(x.mul(x)) - mx.mul(mx), vy = mean(y.mul(y)) - my.mul(my);
  const cv::Mat vxy = mean(x.mul(y)) - mx.mul(my);
  const cv::Mat cs = (2.0 * vxy + c2) / (vx + vy + c2);
  const cv::Mat l = (2.0 * mx.mul(my) + c1) / (mx.mul(mx) + my.mul(my) + c1);
  const cv::Rect inside(5, 5, x.cols - 10, x.rows - 10);
  const cv::Mat index = l.mul(cs);
  return {cv::mean(index(inside))[0], cv::mean(cs(inside))[0]};
}

/// MS-SSIM of sides that are divisible by 16.
double opencv_ms_ssim(cv::Mat x, cv::Mat y) {
  const double weights[] = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};
  double product = 1.0;
  for (int scale = 0; scale < 5; ++scale) {
    const Terms terms = opencv_terms(x, y);
    product *= std::pow(scale == 4 ? terms.similarity : terms.contrast_structure, weights[scale]);
    cv::resize(x, x, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
    cv::resize(y, y, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
  }
  return product;
}

cv::Mat luma_matrix(const Image& display) {
  const auto luma = metrics::display_luma(display);
  cv::Mat matrix(display.height_px, display.width_px, CV_64F);
  for (int y = 0; y < display.height_px; ++y) {
    for (int x = 0; x < display.width_px; ++x) matrix.at<double>(y, x) = luma.row(y)[x];
  }
  return matrix;
}

TEST(MultiScaleSimilarity, AgreesWithOneBuiltFromOpenCv) {
  const Image reference = wavy_picture(208, 192, Encoding::display);
  for (const float amplitude : {0.02F, 0.1F, 0.3F}) {
    const Image test = with_noise(reference, amplitude);
    const double expected = opencv_ms_ssim(luma_matrix(reference), luma_matrix(test));
    const auto score = score_of("ms-ssim", reference, test);
    EXPECT_NEAR(score.value, expected, 1e-7) << amplitude;
    EXPECT_EQ(detail(score, "scales"), 5.0);
  }
}

TEST(MultiScaleSimilarity, FitsAsManyScalesAsWindowsDo) {
  EXPECT_EQ(metrics::fitting_scales(1920, 1080), 5);
  EXPECT_EQ(metrics::fitting_scales(176, 176), 5);
  EXPECT_EQ(metrics::fitting_scales(300, 175), 4);
  EXPECT_EQ(metrics::fitting_scales(88, 500), 4);
  EXPECT_EQ(metrics::fitting_scales(44, 87), 3);
  EXPECT_EQ(metrics::fitting_scales(22, 22), 2);
  EXPECT_EQ(metrics::fitting_scales(21, 21), 1);
  EXPECT_EQ(metrics::fitting_scales(1, 1), 1);
}

TEST(MultiScaleSimilarity, WithOneScaleIsSsimToThePowerOfAllWeights) {
  const Image reference = wavy_picture(20, 16, Encoding::display);
  const Image test = with_noise(reference, 0.1F);
  const double ssim = score_of("ssim", reference, test).value;
  EXPECT_NEAR(score_of("ms-ssim", reference, test).value, std::pow(ssim, 1.0001), 1e-9);
  const Image large = wavy_picture(200, 180, Encoding::display);
  const Image noisy = with_noise(large, 0.1F);
  EXPECT_NEAR(score_of("ms-ssim,scales=1", large, noisy).value,
              std::pow(score_of("ssim", large, noisy).value, 1.0001), 1e-9);
}

TEST(MultiScaleSimilarity, RefusesScalesThatDoNotFit) {
  const Image small = wavy_picture(100, 90, Encoding::display);
  EXPECT_EQ(input_error_of([&] { score_of("ms-ssim,scales=5", small, small); }),
            "metric \"ms-ssim\": 5 scales need a shorter side of 176 pixels, the images are "
            "100x90; accepted: scales=1 to 4, or scales=0 for as many as fit");
  EXPECT_EQ(detail(score_of("ms-ssim,scales=3", small, small), "scales"), 3.0);
}

TEST(MultiScaleSimilarity, ForgivesFineNoiseMoreThanSsim) {
  const Image reference = wavy_picture(192, 192, Encoding::display);
  const Image test = with_noise(reference, 0.1F);
  EXPECT_GT(score_of("ms-ssim", reference, test).value,
            score_of("ssim", reference, test).value + 0.1);
}

TEST(MultiScaleSimilarity, ANegativeScaleGivesZeroAndIsCounted) {
  const auto stripes = [](float sign) {
    return picture(32, 32, Encoding::display, [&](int x, int) -> std::array<float, 3> {
      const float value = 0.5F + sign * (x % 2 == 0 ? 0.3F : -0.3F);
      return {value, value, value};
    });
  };
  const auto score = score_of("ms-ssim", stripes(1.0F), stripes(-1.0F));
  EXPECT_EQ(score.value, 0.0);
  EXPECT_EQ(detail(score, "negative_scales"), 1.0);
  EXPECT_LT(detail(score, "scale_1_mean"), -0.9);
}

TEST(MultiScaleSimilarity, TheMapIsLargestWhereTheErrorIs) {
  const Image reference = wavy_picture(96, 96, Encoding::display);
  Image test = reference;
  for (int y = 40; y < 48; ++y) {
    for (int x = 20; x < 28; ++x) test.at(x, y, 1) = (x + y) % 2 == 0 ? 0.1F : 0.9F;
  }
  const auto score = score_of("ms-ssim", reference, test);
  EXPECT_GT(score.map->at(24, 44), 0.2F);
  EXPECT_EQ(score.map->at(90, 90), 0.0F);
}

}  // namespace
