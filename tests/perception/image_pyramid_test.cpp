#include "perception/image_pyramid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/perception/luminance_patterns.h"

namespace perception {
namespace {

using tests::grating;
using tests::light_image;
using tests::noise;

float largest_in_middle(const Image& a, const Image& b) {
  float largest = 0.0F;
  for (int y = a.height_px / 4; y < 3 * a.height_px / 4; ++y) {
    for (int x = a.width_px / 4; x < 3 * a.width_px / 4; ++x) {
      largest = std::max(largest, std::abs(a.at(x, y) - b.at(x, y)));
    }
  }
  return largest;
}

/// Amplitude that a band of the stack leaves of a unit grating, measured on pixels.
float band_gain(LowPassStack::Kind kind, int band, double cycles_px) {
  LowPassStack stack(grating(256, 1.0, 1.0, cycles_px), kind);
  while (stack.level() <= band) stack.advance();
  return largest_in_middle(stack.previous(), stack.current());
}

TEST(Smooth, OfAnImpulseIsTheKernel) {
  const Image impulse =
      light_image(9, 9, [](int x, int y) { return x == 4 && y == 4 ? 1.0 : 0.0; });
  Image scratch;
  Image result;
  smooth(impulse, burt_adelson_kernel(1), Border::replicate, scratch, result);
  const float w[] = {0.0F, 0.0F, 0.05F, 0.25F, 0.4F, 0.25F, 0.05F, 0.0F, 0.0F};
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 9; ++x) EXPECT_NEAR(result.at(x, y), w[x] * w[y], 1e-7F);
  }
  EXPECT_NEAR(burt_adelson_kernel(1).variance_px2(), 0.9, 1e-6);
  EXPECT_NEAR(burt_adelson_kernel(4).variance_px2(), 14.4, 1e-5);
}

TEST(Smooth, BordersAreReplicatedOrMirroredAsYeeDoes) {
  const Image ramp = light_image(8, 1, [](int x, int) { return x; });
  Image scratch;
  Image result;
  smooth(ramp, burt_adelson_kernel(1), Border::replicate, scratch, result);
  EXPECT_NEAR(result.at(0, 0), 0.25 * 1 + 0.05 * 2, 1e-6);
  EXPECT_NEAR(result.at(7, 0), 7 - 0.25 * 1 - 0.05 * 2, 1e-6);
  smooth(ramp, burt_adelson_kernel(1), Border::yee_mirror, scratch, result);
  EXPECT_NEAR(result.at(0, 0), 2 * 0.25 * 1 + 2 * 0.05 * 2, 1e-6);
  // 2 w - x - 1: pixels 7 and 6 stand at 8 and 9.
  EXPECT_NEAR(result.at(7, 0), 0.4 * 7 + 0.25 * (6 + 7) + 0.05 * (5 + 6), 1e-6);
}

TEST(Smooth, KeepsUniformImagesBitForBitAndMirrors) {
  const Image uniform = light_image(67, 31, [](int, int) { return 17.3; });
  const Image picture = noise(66, 30, 10.0, 1.0);
  Image scratch;
  Image result;
  Image flipped;
  for (const int spacing : {1, 4, 32, 128}) {
    smooth(uniform, burt_adelson_kernel(spacing), Border::replicate, scratch, result);
    EXPECT_EQ(result.pixels, uniform.pixels) << spacing;
    smooth(picture, burt_adelson_kernel(spacing), Border::replicate, scratch, result);
    smooth(tests::mirrored(picture, true, true), burt_adelson_kernel(spacing), Border::replicate,
           scratch, flipped);
    EXPECT_EQ(tests::mirrored(flipped, true, true).pixels, result.pixels) << spacing;
  }
}

TEST(Smooth, WorksOnTheSmallestImages) {
  Image scratch;
  Image result;
  for (const Border border : {Border::replicate, Border::yee_mirror}) {
    const Image one = light_image(1, 1, [](int, int) { return 3.5; });
    smooth(one, burt_adelson_kernel(8), border, scratch, result);
    EXPECT_EQ(result.pixels, one.pixels);
    smooth(light_image(2, 1, [](int x, int) { return x; }), burt_adelson_kernel(2), border, scratch,
           result);
    EXPECT_GE(result.at(0, 0), 0.0F);
    EXPECT_LE(result.at(1, 0), 1.0F);
  }
}

TEST(GaussianAverage, IsTheGaussianWithinOnePerCent) {
  constexpr int kSize = 512;
  const Image edge = light_image(kSize, 3, [](int x, int) { return x < kSize / 2 ? 0.0 : 1.0; });
  for (const double sigma : {0.5, 1.3, 5.2, 13.0, 33.5}) {
    const Image averaged = gaussian_average(edge, sigma);
    for (int x = 0; x < kSize; ++x) {
      const double z = (x + 0.5 - kSize / 2) / (sigma * std::numbers::sqrt2);
      const double exact = 0.5 * (1.0 + std::erf(z));
      EXPECT_NEAR(averaged.at(x, 1), exact, sigma < 1.0 ? 0.05 : 0.015) << sigma << " " << x;
    }
  }
  EXPECT_EQ(gaussian_average(edge, 0.0).pixels, edge.pixels);
}

TEST(LaplacianPyramid, ReconstructsAndReducesBySizeRule) {
  const Image picture = noise(101, 64, 5.0, 0.9);
  const LaplacianPyramid pyramid = laplacian_pyramid(picture, 4);
  ASSERT_EQ(pyramid.bands.size(), 4U);
  EXPECT_EQ(pyramid.bands[1].width_px, 51);
  EXPECT_EQ(pyramid.bands[1].height_px, 32);
  EXPECT_EQ(pyramid.base.width_px, 7);
  const Image back = reconstructed(pyramid);
  for (std::size_t i = 0; i < back.pixels.size(); ++i) {
    EXPECT_NEAR(back.pixels[i], picture.pixels[i], 2e-6F);
  }
  EXPECT_LT(laplacian_pyramid(picture, 30).bands.size(), 8U);
}

TEST(LaplacianPyramid, ExpandHoldsConstantsAndTheKernel) {
  const Image uniform = light_image(5, 4, [](int, int) { return 2.25; });
  for (const float value : expand(uniform, 9, 8).pixels) EXPECT_EQ(value, 2.25F);
  const Image impulse = light_image(5, 1, [](int x, int) { return x == 2 ? 1.0 : 0.0; });
  const float w[] = {0.0F, 0.0F, 0.1F, 0.5F, 0.8F, 0.5F, 0.1F, 0.0F, 0.0F};
  for (int x = 0; x < 9; ++x) EXPECT_NEAR(expand(impulse, 9, 1).at(x, 0), w[x], 1e-7F);
}

TEST(BandPeak, OctavesHalveAndTheRepeatedKernelDoesNot) {
  const auto octaves = LowPassStack::Kind::octaves;
  const auto repeated = LowPassStack::Kind::repeated_kernel;
  EXPECT_EQ(band_peak_cycles_px(octaves, 0), 0.5);
  for (int band = 1; band < 6; ++band) {
    const double ratio =
        band_peak_cycles_px(octaves, band) / band_peak_cycles_px(octaves, band + 1);
    EXPECT_NEAR(ratio, 2.0, band == 1 ? 0.12 : 0.04) << band;
  }
  EXPECT_NEAR(band_peak_cycles_px(octaves, 1), 0.2969 / 2.0, 5e-4);
  // What the kernel repeated at full size gives, while its labels say 0.5, 0.25, 0.125, ...
  const double published[] = {0.5, 0.193, 0.149, 0.126, 0.111, 0.101};
  for (int band = 0; band < 6; ++band) {
    EXPECT_NEAR(band_peak_cycles_px(repeated, band), published[band], 1e-3) << band;
  }
}

TEST(BandPeak, IsWherePixelsSayItIs) {
  for (const auto kind : {LowPassStack::Kind::octaves, LowPassStack::Kind::repeated_kernel}) {
    for (const int band : {1, 2, 3}) {
      const double peak = band_peak_cycles_px(kind, band);
      const float gain = band_gain(kind, band, peak);
      EXPECT_GT(gain, band_gain(kind, band, 0.75 * peak)) << band;
      EXPECT_GT(gain, band_gain(kind, band, 1.3 * peak)) << band;
    }
  }
  EXPECT_NEAR(band_gain(LowPassStack::Kind::octaves, 1, 0.14845), 0.554F, 0.01F);
}

TEST(LowPassStack, BandsAndTheLastLevelSumToTheImage) {
  const Image picture = noise(40, 40, 1.0, 0.5);
  LowPassStack stack(picture, LowPassStack::Kind::octaves);
  Image sum = light_image(40, 40, [](int, int) { return 0.0; });
  double variance = 0.0;
  for (int i = 0; i < 5; ++i) {
    stack.advance();
    variance += 0.9 * std::exp2(2 * i);
    for (std::size_t p = 0; p < sum.pixels.size(); ++p) {
      sum.pixels[p] += stack.previous().pixels[p] - stack.current().pixels[p];
    }
  }
  EXPECT_NEAR(stack.variance_px2(), variance, 1e-3);
  for (std::size_t p = 0; p < sum.pixels.size(); ++p) {
    EXPECT_NEAR(sum.pixels[p] + stack.current().pixels[p], picture.pixels[p], 2e-6F);
  }
}

}  // namespace
}  // namespace perception
