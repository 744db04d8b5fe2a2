#include "perception/fourier_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "perception/base/parallel.h"
#include "tests/perception/luminance_patterns.h"

namespace perception {
namespace {

/// A response from gain(fx, fy).
template <class Gain>
FrequencyResponse response_of(const Gain& gain) {
  return [gain](float fx, std::span<const float> fy, std::span<float> gains) {
    for (std::size_t i = 0; i < fy.size(); ++i) {
      gains[i] = static_cast<float>(gain(double{fx}, double{fy[i]}));
    }
    return true;
  };
}

/// exp(-rho^2 / (2 s^2)): in space a Gaussian of sigma 1 / (2 pi s) px.
FrequencyResponse gaussian_response(double s) {
  return response_of(
      [s](double fx, double fy) { return std::exp(-(fx * fx + fy * fy) / (2.0 * s * s)); });
}

Image filtered(Image image, const FrequencyResponse& response) {
  FourierFilter(image.width_px, image.height_px).filter(image, response);
  return image;
}

TEST(FourierFilter, WithoutAResponseTheImageComesBack) {
  const auto all_pass = response_of([](double, double) { return 1.0; });
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 3}, {75, 50}, {131, 77}}) {
    const Image picture = tests::noise(width, height, 1.0, 1.0);
    const FourierFilter filter(width, height);
    Image back = make_gray_image(width, height, "Y", Encoding::luminance_cd_m2);
    filter.filter(filter.spectrum_of(picture), all_pass, back);
    const Image in_place = filtered(picture, all_pass);
    for (std::size_t p = 0; p < picture.pixels.size(); ++p) {
      EXPECT_NEAR(back.pixels[p], picture.pixels[p], 2e-6F) << width << "x" << height;
      EXPECT_NEAR(in_place.pixels[p], picture.pixels[p], 2e-6F) << width << "x" << height;
    }
  }
}

TEST(FourierFilter, AGaussianResponseSpreadsAPointToAGaussian) {
  constexpr int kSize = 101;
  constexpr double kSigma_px = 3.0;
  Image point = tests::light_image(kSize, kSize, [](int, int) { return 0.0; });
  point.at(60, 45) = 1.0F;
  const Image spread = filtered(point, gaussian_response(0.5 / (std::numbers::pi * kSigma_px)));
  for (int y = 30; y < 60; ++y) {
    for (int x = 45; x < 75; ++x) {
      const double r2 = (x - 60) * (x - 60) + (y - 45) * (y - 45);
      const double expected = std::exp(-0.5 * r2 / (kSigma_px * kSigma_px)) /
                              (2.0 * std::numbers::pi * kSigma_px * kSigma_px);
      EXPECT_NEAR(spread.at(x, y), expected, 1e-6) << x << ", " << y;
    }
  }
}

TEST(FourierFilter, EveryFrequencyHasItsGain) {
  // Different for fx and fy, and for the two diagonals.
  const auto response = response_of([](double fx, double fy) { return fx - 0.3 * fy + fx * fy; });
  for (const double degrees : {0.0, 40.0, 140.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const double fx = 0.125 * std::cos(angle), fy = 0.125 * std::sin(angle);
    const double sign = fx < -1e-12 ? -1.0 : 1.0;  // the half of the spectrum with fx >= 0
    const double gain = sign * (fx - 0.3 * fy) + fx * fy;
    const Image wave = tests::grating(256, 1.0, 1.0, 0.125, degrees);
    const Image out = filtered(wave, response);
    for (int x = 112; x < 144; ++x) {
      EXPECT_NEAR(out.at(x, 130), gain * double{wave.at(x, 130) - 1.0F}, 2e-3)
          << degrees << " at " << x;
    }
  }
}

TEST(FourierFilter, AUniformImageHasTheGainOfFrequencyZero) {
  const auto response = response_of([](double fx, double fy) { return 0.5 + fx + fy * fy; });
  const Image out = filtered(tests::light_image(30, 40, [](int, int) { return 8.0; }), response);
  for (const float value : out.pixels) EXPECT_NEAR(value, 4.0F, 1e-5F);
}

TEST(FourierFilter, ColumnsWithoutAGainAreLeftOut) {
  const auto whole = response_of([](double fx, double fy) {
    return std::hypot(fx, fy) < 0.1 ? 1.0 - 10.0 * std::hypot(fx, fy) : 0.0;
  });
  const FrequencyResponse short_cut = [&](float fx, std::span<const float> fy,
                                          std::span<float> gains) {
    return fx < 0.1F && whole(fx, fy, gains);
  };
  const Image picture = tests::noise(120, 90, 1.0, 0.5);
  EXPECT_EQ(filtered(picture, whole).pixels, filtered(picture, short_cut).pixels);
  const FourierFilter filter(120, 90);
  const auto spectrum = filter.spectrum_of(picture);
  Image a = picture, b = picture;
  filter.filter(spectrum, whole, a);
  filter.filter(spectrum, short_cut, b);
  EXPECT_EQ(a.pixels, b.pixels);
  // A response of the spectrum itself is the same filter.
  filter.filter(filter.spectrum_of(picture, short_cut),
                response_of([](double, double) { return 1.0; }), b);
  for (std::size_t p = 0; p < a.pixels.size(); ++p) EXPECT_NEAR(a.pixels[p], b.pixels[p], 1e-5F);
}

TEST(FourierFilter, ATabulatedResponseIsTheSameFilter) {
  const FrequencyResponse response = [](float fx, std::span<const float> fy,
                                        std::span<float> gains) {
    for (std::size_t i = 0; i < fy.size(); ++i) gains[i] = std::exp(-3.0F * fx - fy[i] * fy[i]);
    return fx < 0.3F;
  };
  const Image picture = tests::noise(123, 91, 1.0, 0.5);
  const FourierFilter filter(123, 91);
  Image plain = picture, tabulated = picture;
  filter.filter(plain, response);
  filter.filter(tabulated, filter.tabulated(response));
  EXPECT_EQ(plain.pixels, tabulated.pixels);
  EXPECT_NE(plain.pixels, picture.pixels);
}

TEST(FourierFilter, OppositeBordersDoNotMeet) {
  // A bright stripe at the left: a filter around the corner would show it at the right.
  const Image stripe = tests::light_image(100, 60, [](int x, int) { return x < 4 ? 1.0 : 0.0; });
  const Image out = filtered(stripe, gaussian_response(0.5 / (std::numbers::pi * 5.0)));
  EXPECT_GT(out.at(0, 30), 0.5F);
  EXPECT_NEAR(out.at(99, 30), 0.0F, 1e-4F);
  // Mirrored, the border's stripe is twice as wide, and the columns stay uniform.
  EXPECT_NEAR(out.at(0, 0), out.at(0, 59), 1e-5F);
  EXPECT_NEAR(out.at(0, 0), out.at(0, 30), 1e-5F);
  EXPECT_NEAR(out.at(0, 30), std::erf(4.0 / (5.0 * std::numbers::sqrt2)), 0.02);
}

TEST(FourierFilter, AMirroredImageGivesTheMirroredResult) {
  const Image picture = tests::noise(57, 43, 1.0, 1.0);
  const auto response = gaussian_response(0.05);
  const Image out = tests::mirrored(filtered(picture, response), true, true);
  const Image mirrored_out = filtered(tests::mirrored(picture, true, true), response);
  for (std::size_t p = 0; p < out.pixels.size(); ++p) {
    EXPECT_NEAR(out.pixels[p], mirrored_out.pixels[p], 1e-5F);
  }
}

TEST(FourierFilter, ThreadsDoNotChangeAByte) {
  const Image picture = tests::noise(301, 207, 1.0, 1.0);
  const auto with_threads = [&](int threads) {
    const base::ThreadLimit limit(threads);
    return filtered(picture, gaussian_response(0.07)).pixels;
  };
  EXPECT_EQ(with_threads(1), with_threads(2));
}

TEST(FourierFilter, AnImageOfZerosStaysExactlyZero) {
  const Image zeros = tests::light_image(33, 21, [](int, int) { return 0.0; });
  for (const float value : filtered(zeros, gaussian_response(0.1)).pixels) EXPECT_EQ(value, 0.0F);
}

}  // namespace
}  // namespace perception
