#include "perception/image.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "tests/expect_error.h"

namespace perception {
namespace {

/// A picture whose every value is different.
Image numbered(int width_px, int height_px, std::vector<std::string> channels) {
  Image image(width_px, height_px, std::move(channels), Encoding::scene_linear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i);
  return image;
}

TEST(Encoding, NamesGoBothWays) {
  for (const Encoding encoding :
       {Encoding::scene_linear, Encoding::luminance_cd_m2, Encoding::display}) {
    EXPECT_EQ(encoding_from_text(to_string(encoding)), encoding);
  }
  EXPECT_EQ(encoding_from_text("scene-linear"), Encoding::scene_linear);
  tests::expect_error<base::InputError>(
      [] { encoding_from_text("displai"); },
      "unknown encoding \"displai\"; did you mean \"display\"? known: "
      "scene_linear, luminance_cd_m2, display");
}

TEST(Image, IsRowMajorTopLeftFirstAndInterleaved) {
  const Image image = numbered(4, 3, {"R", "G", "B"});
  EXPECT_EQ(image.pixels.size(), 36U);
  EXPECT_EQ(image.at(1, 0, 0), 3.0F);
  EXPECT_EQ(image.at(0, 1, 0), 12.0F);
  EXPECT_EQ(image.at(2, 1, 1), 19.0F);
  EXPECT_EQ(image.pixel(3, 2)[2], 35.0F);
}

TEST(RgbOf, PicksByNameInAnyOrderAndLeavesAlphaOut) {
  const Image rgb = rgb_of(numbered(2, 1, {"A", "b", "G", "R"}));
  EXPECT_EQ(rgb.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(rgb.pixels, (std::vector<float>{3, 2, 1, 7, 6, 5}));
}

TEST(RgbOf, RepeatsTheOnlyChannel) {
  EXPECT_EQ(rgb_of(numbered(1, 2, {"Y"})).pixels, (std::vector<float>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(rgb_of(numbered(1, 2, {"Y", "A"})).pixels, (std::vector<float>{0, 0, 0, 2, 2, 2}));
}

TEST(RgbOf, RefusesOtherChannels) {
  tests::expect_error<base::InputError>(
      [] {
        rgb_of(numbered(1, 1, {"X", "Y"}));
      },
      "no colour in an image with the channels X, Y; accepted: R, G, B, or one channel");
}

TEST(Crop, TakesTheRectangle) {
  const Image part = crop(numbered(5, 4, {"Y"}), 1, 2, 3, 2);
  EXPECT_EQ(part.width_px, 3);
  EXPECT_EQ(part.pixels, (std::vector<float>{11, 12, 13, 16, 17, 18}));
  EXPECT_EQ(crop(part, 0, 0, 3, 2).pixels, part.pixels);
}

TEST(Crop, RefusesWhatLeavesTheImage) {
  const Image image = numbered(5, 4, {"Y"});
  tests::expect_error<base::InputError>(
      [&] { crop(image, 3, 0, 3, 1); },
      "region 3,0,3,1 (x,y,width,height) leaves the image; accepted: "
      "within 5x4 pixels, at least 1x1");
  EXPECT_THROW(crop(image, -1, 0, 2, 2), base::InputError);
  EXPECT_THROW(crop(image, 0, 0, 0, 2), base::InputError);
  EXPECT_THROW(crop(image, 0, 4, 1, 1), base::InputError);
  EXPECT_THROW(crop(image, 2147483647, 0, 2147483647, 1), base::InputError);
}

TEST(CountNonFinite, CountsPixelsAndGivesTheFirst) {
  Image image = numbered(3, 3, {"R", "G", "B"});
  EXPECT_EQ(count_non_finite(image).pixels, 0U);
  EXPECT_EQ(count_non_finite(image).first_x_px, -1);
  image.at(2, 1, 1) = std::numeric_limits<float>::quiet_NaN();
  image.at(2, 1, 2) = std::numeric_limits<float>::infinity();  // the same pixel counts once
  image.at(0, 2, 0) = -std::numeric_limits<float>::infinity();
  const NonFinite found = count_non_finite(image);
  EXPECT_EQ(found.pixels, 2U);
  EXPECT_EQ(found.first_x_px, 2);
  EXPECT_EQ(found.first_y_px, 1);
}

TEST(PixelHash, ChangesWithEverythingThatMatters) {
  const Image image = numbered(4, 2, {"Y"});
  const std::string hash = pixel_hash(image);
  EXPECT_EQ(hash.size(), 32U);
  EXPECT_EQ(pixel_hash(Image(image)), hash);
  Image other = image;
  other.pixels[3] = std::nextafter(other.pixels[3], 100.0F);
  EXPECT_NE(pixel_hash(other), hash);
  other = image;
  other.pixels[0] = -0.0F;  // equal to 0 as a number, different as bits
  EXPECT_NE(pixel_hash(other), hash);
  other = image;
  other.channels = {"Z"};
  EXPECT_NE(pixel_hash(other), hash);
  other = image;
  other.encoding = Encoding::display;
  EXPECT_NE(pixel_hash(other), hash);
  other = image;
  std::swap(other.width_px, other.height_px);
  EXPECT_NE(pixel_hash(other), hash);
}

}  // namespace
}  // namespace perception
