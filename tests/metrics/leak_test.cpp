#include "metrics/leak.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;

constexpr Encoding kLinear = Encoding::scene_linear;

/// Two rooms of 20 x 20 pixels beside each other.
Image rooms(float left, float right) {
  return picture(40, 20, kLinear, [=](int x, int) -> std::array<float, 3> {
    const float value = x < 20 ? left : right;
    return {value, value, value};
  });
}

TEST(Leak, IsTheShareOfTheReferencesLight) {
  const auto score = score_of("leak", rooms(0.0F, 1.0F), rooms(0.1F, 1.0F));
  EXPECT_NEAR(score.value, 0.1, 1e-7);
  EXPECT_NEAR(detail(score, "leaked_share"), 0.1, 1e-7);
  EXPECT_NEAR(detail(score, "energy_error"), 0.1, 1e-7);
  EXPECT_NEAR(detail(score, "dark_share"), 0.5, 1e-12);
  EXPECT_NEAR(detail(score, "dark_mean"), 0.2, 1e-7);
  EXPECT_NEAR(detail(score, "reference_mean"), 0.5, 1e-7);
  EXPECT_NEAR(score.map->at(3, 3), 0.2, 1e-6);
  EXPECT_EQ(score.map->at(30, 3), 0.0F);
}

TEST(Leak, LightThatOnlyMovesIsNoEnergyError) {
  const auto score = score_of("leak", rooms(0.0F, 1.0F), rooms(0.1F, 0.9F));
  EXPECT_NEAR(score.value, 0.1, 1e-7);
  EXPECT_NEAR(detail(score, "energy_error"), 0.0, 1e-7);
}

TEST(Leak, LightThatIsLostOrAddedToLightIsNoLeak) {
  const auto lost = score_of("leak", rooms(0.0F, 1.0F), rooms(0.0F, 0.25F));
  EXPECT_EQ(lost.value, 0.0);
  EXPECT_NEAR(detail(lost, "energy_error"), -0.75, 1e-7);
  const auto brighter = score_of("leak", rooms(0.0F, 1.0F), rooms(0.0F, 2.0F));
  EXPECT_EQ(brighter.value, 0.0);
  EXPECT_NEAR(detail(brighter, "energy_error"), 1.0, 1e-7);
  EXPECT_EQ(score_of("leak", rooms(0.005F, 1.0F), rooms(0.0F, 1.0F)).value, 0.0);
}

TEST(Leak, MoreLightIsWorse) {
  double last = 0.0;
  for (const float light : {0.001F, 0.01F, 0.1F, 1.0F}) {
    const double value = score_of("leak", rooms(0.0F, 1.0F), rooms(light, 1.0F)).value;
    EXPECT_GT(value, last) << light;
    last = value;
  }
}

TEST(Leak, TheRegionIsWhereTheImageIsTheScale) {
  const auto left = score_of("leak,width=0.5", rooms(0.0F, 1.0F), rooms(0.1F, 1.0F));
  EXPECT_NEAR(left.value, 0.2, 1e-7);
  EXPECT_NEAR(detail(left, "leaked_share"), 0.1, 1e-7);
  EXPECT_EQ(detail(left, "dark_share"), 1.0);
  EXPECT_TRUE(std::isnan(detail(left, "energy_error")));
  const auto right = score_of("leak,x=0.5,width=0.5", rooms(0.0F, 1.0F), rooms(0.1F, 1.0F));
  EXPECT_EQ(right.value, 0.0);
  EXPECT_EQ(detail(right, "dark_share"), 0.0);
  EXPECT_EQ(detail(right, "dark_mean"), 0.0);
}

TEST(Leak, DarkIsAShareOfTheMean) {
  const Image reference = rooms(0.02F, 0.98F);
  const Image test = rooms(0.12F, 0.98F);
  EXPECT_EQ(score_of("leak", reference, test).value, 0.0);
  EXPECT_NEAR(score_of("leak,dark=0.05", reference, test).value, 0.1, 1e-6);
  EXPECT_EQ(score_of("leak,dark=0", reference, test).value, 0.0);
}

TEST(Leak, TheMaskLeavesPixelsOut) {
  // A quarter of the dark room is left, and all light.
  const Image mask = mask_where(40, 20, [](int x, int) { return x >= 15; });
  EXPECT_NEAR(score_of("leak", rooms(0.0F, 1.0F), rooms(0.1F, 1.0F), &mask).value, 0.1 / 4.0, 1e-7);
}

TEST(Leak, ABlackReferenceHasNoScale) {
  EXPECT_TRUE(std::isnan(score_of("leak", rooms(0.0F, 0.0F), rooms(0.1F, 0.0F)).value));
  EXPECT_EQ(score_of("leak", rooms(0.0F, 0.0F), rooms(0.0F, 0.0F)).value, 0.0);
}

}  // namespace
