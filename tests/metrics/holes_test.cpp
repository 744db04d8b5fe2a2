#include "metrics/holes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;

constexpr int kSide = 40;
constexpr double kPixels = kSide * kSide;

/// Light that rises by 1 % a pixel to the right and 0.5 % downwards.
Image slope() {
  return picture(kSide, kSide, Encoding::scene_linear, [](int x, int y) -> std::array<float, 3> {
    const float value =
        0.5F * std::pow(1.01F, static_cast<float>(x)) * std::pow(1.005F, static_cast<float>(y));
    return {value, value, value};
  });
}

/// A square of pixels times a factor.
void scale(Image& image, int x0, int y0, int side, float factor) {
  for (int y = y0; y < y0 + side; ++y) {
    for (int x = x0; x < x0 + side; ++x) {
      for (float& value : image.pixel(x, y)) value *= factor;
    }
  }
}

double pixels(const metrics::Score& score) { return score.value * kPixels; }

TEST(Holes, PlantedOnesAreCounted) {
  Image test = slope();
  // In the field, at a border and in a corner; dark and bright.
  for (const auto& [x, y] : {std::pair{5, 5}, {20, 9}, {9, 30}, {0, 17}, {39, 39}}) {
    scale(test, x, y, 1, 0.5F);
  }
  for (const auto& [x, y] : {std::pair{12, 12}, {33, 0}}) scale(test, x, y, 1, 1.5F);
  const auto score = score_of("holes", slope(), test);
  EXPECT_NEAR(pixels(score), 7.0, 1e-9);
  EXPECT_NEAR(detail(score, "dark") * kPixels, 5.0, 1e-9);
  EXPECT_NEAR(detail(score, "bright") * kPixels, 2.0, 1e-9);
  EXPECT_NEAR(detail(score, "pixels"), 7.0, 1e-9);
  EXPECT_EQ(detail(score, "connected"), 7.0);
  EXPECT_EQ(detail(score, "reference"), 0.0);
  EXPECT_EQ(score.regions.size(), 7U);
  // Half of it against the lowest neighbour, which is 1.5 % darker.
  EXPECT_NEAR(score.map->at(20, 9), 1.0 - 0.5 * 1.01 * 1.005, 1e-5);
  EXPECT_EQ(score.map->at(21, 9), 0.0F);
}

TEST(Holes, MustBeDeeperThanTheThreshold) {
  Image test = slope();
  scale(test, 20, 20, 1, 0.955F);  // 3 % below the lowest neighbour
  scale(test, 10, 10, 1, 0.90F);   // 8.6 %
  EXPECT_NEAR(pixels(score_of("holes", slope(), test)), 1.0, 1e-9);
  EXPECT_NEAR(pixels(score_of("holes,threshold=0.02", slope(), test)), 2.0, 1e-9);
  EXPECT_NEAR(pixels(score_of("holes,threshold=0.2", slope(), test)), 0.0, 1e-9);
}

TEST(Holes, ThoseOfTheReferenceAreNone) {
  Image reference = slope();
  scale(reference, 20, 20, 1, 0.5F);
  scale(reference, 10, 10, 1, 1.5F);
  Image test = reference;
  scale(test, 20, 20, 1, 0.8F);
  EXPECT_EQ(score_of("holes", reference, test).value, 0.0);
  EXPECT_NEAR(detail(score_of("holes", reference, test), "reference") * kPixels, 2.0, 1e-9);
  // Where the reference has a dip and the test a peak, the peak is new; a filled hole is no hole.
  scale(test, 20, 20, 1, 10.0F);
  EXPECT_NEAR(detail(score_of("holes", reference, test), "bright") * kPixels, 1.0, 1e-9);
  EXPECT_EQ(score_of("holes", reference, slope()).value, 0.0);
}

TEST(Holes, TheRadiusIsTheSideOfTheLargestSpot) {
  Image test = slope();
  scale(test, 10, 10, 2, 0.5F);
  scale(test, 25, 25, 3, 0.5F);
  EXPECT_EQ(score_of("holes", slope(), test).value, 0.0);
  // Of the larger spot, only the middle is away from its own other side.
  EXPECT_NEAR(pixels(score_of("holes,radius=2", slope(), test)), 4.0 + 1.0, 1e-9);
  const auto wide = score_of("holes,radius=3", slope(), test);
  EXPECT_NEAR(pixels(wide), 4.0 + 9.0, 1e-9);
  EXPECT_EQ(detail(wide, "connected"), 2.0);
}

TEST(Holes, StepsAndLinesAreNone) {
  Image test = slope();
  for (int y = 0; y < kSide; ++y) {
    scale(test, 10, y, 1, 0.5F);
    for (int x = 20; x < kSide; ++x) scale(test, x, y, 1, 2.0F);
  }
  EXPECT_EQ(score_of("holes", slope(), test).value, 0.0);
}

TEST(Holes, NearlyBlackPixelsAreNotComparedWithEachOther) {
  Image reference = slope();
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < 20; ++x) scale(reference, x, y, 1, 0.0F);
  }
  Image test = reference;
  for (float& value : test.pixel(10, 10)) value = 1e-4F;
  EXPECT_EQ(score_of("holes", reference, test).value, 0.0);
  for (float& value : test.pixel(10, 10)) value = 1e-2F;
  EXPECT_NEAR(pixels(score_of("holes", reference, test)), 1.0, 1e-9);
  for (int y = 8; y < 13; ++y) {
    for (int x = 8; x < 13; ++x) {
      for (float& value : reference.pixel(x, y)) value = 1e-4F;
    }
  }
  test = reference;
  for (float& value : test.pixel(10, 10)) value = 0.0F;
  EXPECT_EQ(score_of("holes", reference, test).value, 0.0);
  // Pictures without light have no holes, and one lit pixel in black is one.
  const Image black = gray_picture(kSide, kSide, Encoding::scene_linear, 0.0F);
  EXPECT_EQ(score_of("holes", black, black).value, 0.0);
  Image lit = black;
  for (float& value : lit.pixel(3, 3)) value = 1.0F;
  EXPECT_NEAR(pixels(score_of("holes", black, lit)), 1.0, 1e-9);
}

TEST(Holes, LooksAtTheRegionAlone) {
  Image test = slope();
  scale(test, 5, 5, 1, 0.5F);
  scale(test, 30, 30, 1, 0.5F);
  EXPECT_NEAR(score_of("holes,width=0.5,height=0.5", slope(), test).value, 4.0 / kPixels, 1e-12);
  EXPECT_EQ(score_of("holes,x=0.5,width=0.5,height=0.5", slope(), test).value, 0.0);
}

TEST(Holes, RefusesBadParameters) {
  const auto parse_error = [](const char* text) {
    return input_error_of([&] { metrics::parse_metric_choice(text, {}); });
  };
  EXPECT_EQ(parse_error("holes,radius=0"),
            "parameter \"radius\" of metric \"holes\" cannot be \"0\"; accepted: a whole number "
            "from 1 to 64 (px)");
  EXPECT_EQ(parse_error("holes,threshold=5%"),
            "parameter \"threshold\" of metric \"holes\" cannot be \"5%\"; accepted: a number from "
            "0 to 1");
}

}  // namespace
