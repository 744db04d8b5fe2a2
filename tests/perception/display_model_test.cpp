#include "perception/display_model.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "perception/color_conversion.h"
#include "tests/expect_error.h"

namespace perception {
namespace {

/// Light of a grey pixel of one channel.
float light_of(float value, Encoding encoding, const ViewingConditions& viewing) {
  Image image = make_gray_image(1, 1, "Y", encoding);
  image.pixels = {value};
  return to_display_light(image, viewing).pixels[0];
}

float signal_light(float value, const ViewingConditions& viewing) {
  return light_of(value, Encoding::display, viewing);
}

/// A display without ambient light whose black is 0.
ViewingConditions dark(DisplayTransfer transfer, double peak_cd_m2) {
  ViewingConditions viewing;
  viewing.transfer = transfer;
  viewing.peak_cd_m2 = peak_cd_m2;
  viewing.black_cd_m2 = 0.0;
  viewing.ambient_lux = 0.0;
  return viewing;
}

TEST(SrgbDisplay, PublishedLightOfStandard4k) {
  const ViewingConditions viewing = viewing_preset("standard_4k", {});
  EXPECT_NEAR(signal_light(0.0F, viewing), 0.59789F, 5e-6F);
  EXPECT_NEAR(signal_light(0.25F, viewing), 10.763F, 5e-4F);
  EXPECT_NEAR(signal_light(0.5F, viewing), 43.363F, 5e-4F);
  EXPECT_NEAR(signal_light(0.75F, viewing), 104.998F, 5e-4F);
  EXPECT_NEAR(signal_light(1.0F, viewing), 200.398F, 5e-4F);
}

TEST(SrgbDisplay, ClipsTheSignalAndKeepsNonFiniteValues) {
  const ViewingConditions viewing;
  EXPECT_EQ(signal_light(1.5F, viewing), signal_light(1.0F, viewing));
  EXPECT_EQ(signal_light(-0.5F, viewing), signal_light(0.0F, viewing));
  EXPECT_TRUE(std::isnan(signal_light(std::numeric_limits<float>::quiet_NaN(), viewing)));
  EXPECT_TRUE(std::isinf(signal_light(std::numeric_limits<float>::infinity(), viewing)));
}

TEST(DisplayLight, LevelsOfEightBitsAreLookedUpWithoutChangingABit) {
  for (const DisplayTransfer transfer : {DisplayTransfer::srgb, DisplayTransfer::bt1886}) {
    ViewingConditions viewing;
    viewing.transfer = transfer;
    for (int level = 0; level < 256; ++level) {
      const float signal = static_cast<float>(level) / 255.0F;
      Image image = make_rgb_image(2, 1, Encoding::display);
      image.pixels = {signal, signal, signal, signal, signal, 0.1234567F};  // the last is no level
      const Image light = to_display_light(image, viewing);
      EXPECT_EQ(light.at(0, 0, 0), light.at(1, 0, 0)) << level;
      EXPECT_EQ(light.at(0, 0, 2), light.at(1, 0, 1)) << level;
      // What is close to a level is not taken for it.
      if (level < 255) {
        EXPECT_LT(signal_light(signal, viewing), signal_light(signal + 1e-3F, viewing));
      }
    }
  }
}

TEST(PqDisplay, KnownCodeValues) {
  const ViewingConditions viewing = dark(DisplayTransfer::pq, 10000.0);
  // Signals of 1, 100, 1000 and 10000 cd/m2 by the inverse of ST 2084.
  EXPECT_NEAR(signal_light(0.149946F, viewing), 1.0F, 2e-5F);
  EXPECT_NEAR(signal_light(0.508078F, viewing), 100.0F, 1e-3F);
  EXPECT_NEAR(signal_light(0.751827F, viewing), 1000.0F, 1e-2F);
  EXPECT_NEAR(signal_light(1.0F, viewing), 10000.0F, 1e-2F);
  EXPECT_NEAR(signal_light(0.0F, viewing), 0.005F, 1e-9F);  // the model's floor
}

TEST(PqDisplay, ClipsAtThePeakThenAddsBlackAndReflection) {
  const ViewingConditions viewing = viewing_preset("standard_hdr_pq", {});
  const double reflected = 10.0 * 0.005 / std::numbers::pi;
  EXPECT_NEAR(signal_light(1.0F, viewing), 1500.0 + 0.0015 + reflected, 1e-3);
}

TEST(HlgDisplay, PeakAndReferenceWhite) {
  const ViewingConditions viewing = dark(DisplayTransfer::hlg, 1000.0);
  EXPECT_NEAR(signal_light(1.0F, viewing), 1000.0F, 1e-2F);
  // ITU-R BT.2408: HDR reference white at 75 % HLG is 203 cd/m2 on a 1000 cd/m2 display.
  EXPECT_NEAR(signal_light(0.75F, viewing), 203.0F, 0.5F);
  EXPECT_EQ(signal_light(0.0F, viewing), 0.0F);
  // In the square-law half, E = V^2 / 3 and L = 1000 E^1.2.
  EXPECT_NEAR(signal_light(0.3F, viewing), 1000.0 * std::pow(0.03, 1.2), 1e-3);
}

TEST(HlgDisplay, GammaGrowsWithThePeakAboveAThousand) {
  const ViewingConditions viewing = dark(DisplayTransfer::hlg, 2000.0);
  const double gamma = 1.2 + 0.42 * std::log10(2.0);
  EXPECT_NEAR(signal_light(0.3F, viewing), 2000.0 * std::pow(0.03, gamma), 1e-3);
}

TEST(Bt1886Display, ReachesBlackAndPeakAndIsAPowerLawWithoutBlack) {
  ViewingConditions viewing = dark(DisplayTransfer::bt1886, 100.0);
  EXPECT_NEAR(signal_light(0.5F, viewing), 100.0 * std::pow(0.5, 2.4), 1e-4);
  viewing.black_cd_m2 = 0.1;
  EXPECT_NEAR(signal_light(0.0F, viewing), 0.1, 1e-6);
  EXPECT_NEAR(signal_light(1.0F, viewing), 100.0, 1e-4);
}

TEST(WideDisplays, GreyStaysGreyAndRedLeavesRec709) {
  const ViewingConditions viewing = dark(DisplayTransfer::pq, 10000.0);
  Image image = make_rgb_image(2, 1, Encoding::display);
  image.pixels = {0.5F, 0.5F, 0.5F, 0.6F, 0.0F, 0.0F};
  const Image light = to_display_light(image, viewing);
  EXPECT_NEAR(light.at(0, 0, 0), light.at(0, 0, 1), 1e-4F);
  EXPECT_NEAR(light.at(0, 0, 0), signal_light(0.5F, viewing), 1e-4F);
  EXPECT_LT(light.at(1, 0, 1), 0.0F);  // BT.2020 red is outside BT.709
  // Luminance is the same in both sets of primaries: 0.2627 of the red light.
  const float luminance = kRec709Luma[0] * light.at(1, 0, 0) + kRec709Luma[1] * light.at(1, 0, 1) +
                          kRec709Luma[2] * light.at(1, 0, 2);
  EXPECT_NEAR(luminance / signal_light(0.6F, viewing), 0.2627F, 2e-4F);
}

TEST(SceneLight, IsScaledExposedClippedAndLitByTheRoom) {
  ViewingConditions viewing = viewing_preset("standard_4k", {});
  viewing.luminance_scale_cd_m2 = 50.0;
  viewing.exposure_ev = 1.0;
  const double reflected = 250.0 * 0.005 / std::numbers::pi;
  const auto light = [&](float v) { return light_of(v, Encoding::scene_linear, viewing); };
  EXPECT_NEAR(light(0.5F), 50.0 + reflected, 1e-4);
  EXPECT_NEAR(light(100.0F), 200.0 + reflected, 1e-4);
  EXPECT_NEAR(light(0.0F), 0.2 + reflected, 1e-6);
  EXPECT_TRUE(std::isnan(light(std::numeric_limits<float>::quiet_NaN())));
  EXPECT_TRUE(std::isinf(light(std::numeric_limits<float>::infinity())));
}

TEST(SceneLight, OfColorsKeepsTheChannels) {
  Image image(1, 1, {"R", "G", "B", "A"}, Encoding::scene_linear);
  image.pixels = {0.25F, 0.5F, 1.0F, 0.0F};
  const Image light = to_display_light(image, dark(DisplayTransfer::srgb, 200.0));
  EXPECT_EQ(light.encoding, Encoding::luminance_cd_m2);
  EXPECT_EQ(light.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(light.pixels, (std::vector<float>{25.0F, 50.0F, 100.0F}));
}

TEST(DisplayLight, AbsoluteLightStaysAndLinearSignalsAreRefused) {
  EXPECT_EQ(light_of(12345.0F, Encoding::luminance_cd_m2, ViewingConditions{}), 12345.0F);
  tests::expect_error<base::InputError>(
      [] { signal_light(0.5F, dark(DisplayTransfer::linear_hdr, 1000.0)); },
      "a display-encoded image cannot be shown with the display transfer \"linear_hdr\"; accepted "
      "for it: srgb, bt1886, pq, hlg");
}

TEST(DisplayEncoded, ExposesClampsAndEncodes) {
  Image image = make_rgb_image(1, 1, Encoding::scene_linear);
  image.pixels = {0.1F, 0.4F, -1.0F};
  const Image encoded = to_display_encoded(image, 1.0);
  EXPECT_EQ(encoded.encoding, Encoding::display);
  EXPECT_NEAR(encoded.pixels[0], srgb_encode(0.2F), 1e-6F);
  EXPECT_NEAR(encoded.pixels[1], srgb_encode(0.8F), 1e-6F);
  EXPECT_EQ(encoded.pixels[2], 0.0F);
  EXPECT_NEAR(to_display_encoded(image, 5.0).pixels[1], 1.0F, 1e-6F);
  EXPECT_EQ(to_display_encoded(encoded, 3.0).pixels, encoded.pixels);  // no exposure twice
  image.encoding = Encoding::luminance_cd_m2;
  EXPECT_THROW(to_display_encoded(image, 0.0), base::InputError);
}

}  // namespace
}  // namespace perception
