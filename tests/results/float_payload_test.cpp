// The floats inside a report: what is kept of them, and how they get there.
#include "results/html_report/float_payload.h"

#include <zlib.h>

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <Imath/half.h>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "results/html_report/float_store.h"
#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using perception::Encoding;
using perception::Image;
using results::html_report::float_payload;
using results::html_report::FloatPayload;
using results::html_report::FloatStore;
using results::html_report::Split;

/// Reads a payload as the page's script does.
std::vector<double> decoded(const FloatPayload& payload) {
  const auto count = static_cast<std::size_t>(payload.width_px * payload.height_px);
  const auto channels = static_cast<std::size_t>(payload.channels);
  std::vector<unsigned char> bytes(2 * count * channels);
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(bytes.data(), &size, reinterpret_cast<const Bytef*>(payload.deflated.data()),
                       payload.deflated.size()),
            Z_OK);
  EXPECT_EQ(size, bytes.size());
  std::vector<double> values(count * channels);
  for (std::size_t c = 0; c < channels; ++c) {
    unsigned bits = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % static_cast<std::size_t>(payload.width_px) == 0) bits = 0;
      bits += 256U * bytes[2 * count * c + i] + bytes[2 * count * c + count + i];
      bits &= 0xFFFFU;
      values[i * channels + c] = std::ldexp(
          double{imath_half_to_float(static_cast<unsigned short>(bits))}, payload.exponent);
    }
  }
  return values;
}

Image noise(int width_px, int height_px, int channels, double stops) {
  Image image = channels == 3
                    ? perception::make_rgb_image(width_px, height_px, Encoding::scene_linear)
                    : perception::make_gray_image(width_px, height_px, "Y", Encoding::scene_linear);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-stops, stops);
  for (float& value : image.pixels) value = static_cast<float>(std::exp2(exponent(random)));
  return image;
}

TEST(FloatPayload, KeepsElevenBitsOfEveryValue) {
  for (const int channels : {1, 3}) {
    const Image image = noise(17, 9, channels, 8.0);
    const FloatPayload payload = float_payload(image);
    EXPECT_EQ(payload.width_px, 17);
    EXPECT_EQ(payload.height_px, 9);
    EXPECT_EQ(payload.channels, channels);
    const std::vector<double> values = decoded(payload);
    ASSERT_EQ(values.size(), image.pixels.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_NEAR(values[i], image.pixels[i], image.pixels[i] * std::ldexp(1.0, -11)) << i;
    }
  }
}

TEST(FloatPayload, NeitherBrightNorDarkImagesLoseTheirValues) {
  // Alone a half-float ends at 65504, and below 6e-8.
  for (const float factor : {1e-12F, 1e-3F, 1.0F, 1e6F, 1e30F}) {
    Image image = noise(4, 4, 1, 3.0);
    for (float& value : image.pixels) value *= factor;
    const std::vector<double> values = decoded(float_payload(image));
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_NEAR(values[i] / image.pixels[i], 1.0, std::ldexp(1.0, -11)) << factor;
    }
  }
}

TEST(FloatPayload, NegativeZeroAndTheLargestFloatSurvive) {
  Image image = perception::make_gray_image(3, 1, "Y", Encoding::scene_linear);
  image.pixels = {-0.25F, 0.0F, std::numeric_limits<float>::max()};
  const FloatPayload payload = float_payload(image);
  EXPECT_TRUE(std::isfinite(decoded(payload)[2]));
  image.pixels[2] = 2.0F;
  EXPECT_EQ(decoded(float_payload(image)), (std::vector<double>{-0.25, 0.0, 2.0}));
}

TEST(FloatPayload, WhatIsNotFiniteStaysSoAndIsCountedOncePerPixel) {
  Image image = perception::make_rgb_image(2, 2, Encoding::scene_linear);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  image.pixels = {1, kNan, kNan, 1, 2, 3, kInfinity, 0, 0, 0, -kInfinity, 5};
  const FloatPayload payload = float_payload(image);
  EXPECT_EQ(payload.non_finite, 3U);
  const std::vector<double> values = decoded(payload);
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_EQ(values[4], 2.0F);
  EXPECT_EQ(values[6], kInfinity);
  EXPECT_EQ(values[10], -kInfinity);
  EXPECT_EQ(values[11], 5.0F);
}

TEST(FloatPayload, AnImageWithoutAFiniteValueHasOneToo) {
  Image image = perception::make_gray_image(2, 1, "Y", Encoding::scene_linear);
  EXPECT_EQ(decoded(float_payload(image)), (std::vector<double>{0.0, 0.0}));
  image.pixels.assign(2, std::numeric_limits<float>::infinity());
  EXPECT_EQ(float_payload(image).non_finite, 2U);
}

TEST(FloatPayload, LeavesOutAlphaAndRefusesWhatIsNoPicture) {
  Image image(1, 1, {"R", "G", "B", "A"}, Encoding::scene_linear);
  image.pixels = {1.0F, 2.0F, 3.0F, 0.5F};
  EXPECT_EQ(decoded(float_payload(image)), (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_THROW(float_payload(Image(1, 1, {"x", "y"}, Encoding::scene_linear)), base::InputError);
}

TEST(FloatPayload, SmoothImagesBecomeMuchSmaller) {
  Image image = perception::make_gray_image(64, 64, "Y", Encoding::scene_linear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = 1.0F + 0.01F * static_cast<float>(i % 64);
  }
  EXPECT_LT(float_payload(image).deflated.size(), 2 * image.pixels.size() / 20);
}

TEST(FloatStore, InOnePageDataAreElementsInTheOrderOfTheirNumbers) {
  FloatStore store(Split::never, {}, 4);
  store.put(1, "BBBB");
  store.put(0, "AAAA");
  store.finish();
  EXPECT_FALSE(store.is_split());
  EXPECT_EQ(store.bytes(), 8U);
  EXPECT_EQ(store.elements(),
            "<script type=\"text/plain\" id=\"f0\">AAAA</script>\n"
            "<script type=\"text/plain\" id=\"f1\">BBBB</script>\n");
}

TEST(FloatStore, AboveTheLimitEveryImageHasAFile) {
  const tests::TemporaryFolder folder;
  FloatStore store(Split::automatic, folder.path(), 9);
  store.put(0, "AAAA");
  store.put(2, "CCCC");
  EXPECT_FALSE(store.is_split());
  store.put(1, "BBBB");
  store.finish();
  EXPECT_TRUE(store.is_split());
  EXPECT_EQ(store.elements(), "");
  EXPECT_EQ(base::read_text_file(folder.path() / "data/f0.js"), "discernData(\"f0\",\"AAAA\");\n");
  EXPECT_EQ(base::read_text_file(folder.path() / "data/f1.js"), "discernData(\"f1\",\"BBBB\");\n");
  EXPECT_EQ(base::read_text_file(folder.path() / "data/f2.js"), "discernData(\"f2\",\"CCCC\");\n");
  EXPECT_FALSE(fs::exists(folder.path() / "data.new"));
}

TEST(FloatStore, FilesOfAnEarlierReportGo) {
  const tests::TemporaryFolder folder;
  FloatStore first(Split::always, folder.path());
  first.put(7, "AAAA");
  first.finish();
  EXPECT_EQ(first.put_file("p7.png", "picture"), "data/p7.png");
  ASSERT_TRUE(fs::exists(folder.path() / "data/f7.js"));
  FloatStore second(Split::automatic, folder.path());
  second.put(0, "AAAA");
  second.finish();
  EXPECT_FALSE(fs::exists(folder.path() / "data"));
}

}  // namespace
