#include "perception/color_conversion.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "perception/base/parallel.h"

namespace perception {
namespace {

using Vector = std::array<float, 3>;

void expect_near(const Vector& a, const Vector& b, float tolerance) {
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

/// Colours on a grid over the unit cube.
std::vector<Vector> cube() {
  std::vector<Vector> colors;
  for (const float r : {0.0F, 0.003F, 0.2F, 1.0F}) {
    for (const float g : {0.0F, 0.01F, 0.5F, 1.0F}) {
      for (const float b : {0.0F, 0.04F, 0.7F, 1.0F}) colors.push_back({r, g, b});
    }
  }
  return colors;
}

TEST(Srgb, KnownValues) {
  EXPECT_EQ(srgb_encode(0.0F), 0.0F);
  EXPECT_NEAR(srgb_encode(1.0F), 1.0F, 1e-7F);
  EXPECT_NEAR(srgb_encode(0.0031308F), 0.0404499F, 1e-6F);  // 12.92 x 0.0031308
  EXPECT_NEAR(srgb_encode(0.5F), 0.735357F, 1e-6F);
  EXPECT_NEAR(srgb_encode(0.18F), 0.461356F, 1e-6F);
  EXPECT_NEAR(srgb_decode(0.5F), 0.214041F, 1e-6F);
  EXPECT_NEAR(srgb_decode(0.04045F), 0.04045F / 12.92F, 1e-8F);
}

TEST(Srgb, RoundTripsEvery8BitValueAndBeyondTheUnitRange) {
  for (int i = 0; i <= 255; ++i) {
    const float encoded = static_cast<float>(i) / 255.0F;
    EXPECT_NEAR(srgb_encode(srgb_decode(encoded)), encoded, 1e-6F);
  }
  for (const float linear : {1e-6F, 0.002F, 0.5F, 4.0F, 1000.0F}) {
    EXPECT_NEAR(srgb_decode(srgb_encode(linear)), linear, 2e-6F * linear);
    EXPECT_EQ(srgb_encode(-linear), -srgb_encode(linear));
    EXPECT_EQ(srgb_decode(-linear), -srgb_decode(linear));
  }
  EXPECT_TRUE(std::isnan(srgb_encode(std::numeric_limits<float>::quiet_NaN())));
}

TEST(Xyz, WhiteIsThatOfFlip) {
  // (0.950428545, 1, 1.088900371): white of FLIP's reference code.
  expect_near(xyz_from_linear_rgb({1, 1, 1}), {0.950428545F, 1.0F, 1.088900371F}, 1e-7F);
}

TEST(Xyz, LuminanceRowIsBt709) {
  EXPECT_NEAR(xyz_from_linear_rgb({1, 0, 0})[1], kRec709Luma[0], 5e-5F);
  EXPECT_NEAR(xyz_from_linear_rgb({0, 1, 0})[1], kRec709Luma[1], 5e-5F);
  EXPECT_NEAR(xyz_from_linear_rgb({0, 0, 1})[1], kRec709Luma[2], 5e-5F);
}

TEST(Xyz, RoundTrips) {
  for (const Vector& color : cube()) {
    expect_near(linear_rgb_from_xyz(xyz_from_linear_rgb(color)), color, 3e-7F);
  }
}

TEST(Lab, WhiteIsExact) {
  EXPECT_EQ(lab_from_xyz(xyz_from_linear_rgb({1, 1, 1})), (Vector{100.0F, 0.0F, 0.0F}));
  EXPECT_EQ(lab_from_xyz({0, 0, 0})[0], 0.0F);
}

TEST(Lab, KnownValues) {
  // L* = 116 (0.18)^(1/3) - 16.
  expect_near(lab_from_xyz(xyz_from_linear_rgb({0.18F, 0.18F, 0.18F})),
              {116.0F * std::cbrt(0.18F) - 16.0F, 0.0F, 0.0F}, 2e-5F);
  // Below (6/29)^3 the curve is a line: L* = (29/3)^3 Y.
  expect_near(lab_from_xyz(xyz_from_linear_rgb({0.004F, 0.004F, 0.004F})),
              {static_cast<float>(std::pow(29.0 / 3.0, 3.0)) * 0.004F, 0.0F, 0.0F}, 1e-5F);
  // sRGB red, as published everywhere for D65: (53.24, 80.09, 67.20).
  expect_near(lab_from_xyz(xyz_from_linear_rgb({1, 0, 0})), {53.24F, 80.09F, 67.20F}, 0.02F);
}

TEST(Lab, RoundTripsOnBothSidesOfTheBend) {
  for (const Vector& color : cube()) {
    const Vector xyz = xyz_from_linear_rgb(color);
    expect_near(xyz_from_lab(lab_from_xyz(xyz)), xyz, 2e-6F);
  }
}

TEST(WholeImages, ChangeValuesAndEncoding) {
  Image linear(2, 1, {"B", "G", "R", "A"}, Encoding::scene_linear);
  linear.pixels = {0.1F, 0.2F, 0.3F, 0.9F, 0.0F, 1.0F, 2.0F, 0.9F};
  const Image encoded = srgb_encoded(linear);
  EXPECT_EQ(encoded.encoding, Encoding::display);
  EXPECT_EQ(encoded.channel_count(), 3);
  EXPECT_EQ(encoded.at(0, 0, 0), srgb_encode(0.3F));
  EXPECT_GT(encoded.at(1, 0, 0), 1.0F);  // not clamped
  const Image decoded = srgb_decoded(encoded);
  EXPECT_EQ(decoded.encoding, Encoding::scene_linear);
  EXPECT_NEAR(decoded.at(1, 0, 0), 2.0F, 1e-5F);
  EXPECT_EQ(linear_rgb_of(encoded).pixels, decoded.pixels);
  EXPECT_EQ(linear_rgb_of(linear).pixels, rgb_of(linear).pixels);
}

TEST(WholeImages, AreTheSameWithAnyNumberOfThreads) {
  Image image = make_rgb_image(301, 211, Encoding::scene_linear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = static_cast<float>(i % 977) / 700.0F;
  }
  const auto encode_with = [&image](int threads) {
    const base::ThreadLimit limit(threads);
    return srgb_encoded(image).pixels;
  };
  EXPECT_EQ(encode_with(1), encode_with(2));
}

}  // namespace
}  // namespace perception
