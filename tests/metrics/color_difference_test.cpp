#include "metrics/color_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;
using metrics::ciede2000;

struct PublishedPair {
  metrics::Lab first, second;
  double difference;
};

// Sharma, Wu, Dalal 2005, Table 1, doi:10.1002/col.20070.
constexpr PublishedPair kPublished[] = {
    {{50.0000, 2.6772, -79.7751}, {50.0000, 0.0000, -82.7485}, 2.0425},
    {{50.0000, 3.1571, -77.2803}, {50.0000, 0.0000, -82.7485}, 2.8615},
    {{50.0000, 2.8361, -74.0200}, {50.0000, 0.0000, -82.7485}, 3.4412},
    {{50.0000, -1.3802, -84.2814}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -1.1848, -84.8006}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -0.9009, -85.5211}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, 0.0000, 0.0000}, {50.0000, -1.0000, 2.0000}, 2.3669},
    {{50.0000, -1.0000, 2.0000}, {50.0000, 0.0000, 0.0000}, 2.3669},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0009}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0010}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0011}, 7.2195},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0012}, 7.2195},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0009, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0010, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0011, -2.4900}, 4.7461},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 0.0000, -2.5000}, 4.3065},
    {{50.0000, 2.5000, 0.0000}, {73.0000, 25.0000, -18.0000}, 27.1492},
    {{50.0000, 2.5000, 0.0000}, {61.0000, -5.0000, 29.0000}, 22.8977},
    {{50.0000, 2.5000, 0.0000}, {56.0000, -27.0000, -3.0000}, 31.9030},
    {{50.0000, 2.5000, 0.0000}, {58.0000, 24.0000, 15.0000}, 19.4535},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.1736, 0.5854}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2972, 0.0000}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 1.8634, 0.5757}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2592, 0.3350}, 1.0000},
    {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
    {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
    {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
    {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
    {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
    {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
    {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
    {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
    {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
    {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
};

TEST(ColorDifference, HasThePublishedValuesInBothDirections) {
  for (const PublishedPair& pair : kPublished) {
    EXPECT_NEAR(ciede2000(pair.first, pair.second), pair.difference, 5.1e-5);
    EXPECT_NEAR(ciede2000(pair.second, pair.first), pair.difference, 5.1e-5);
    EXPECT_EQ(ciede2000(pair.first, pair.first), 0.0);
  }
}

TEST(ColorDifference, PlainDistanceIsAnotherNumber) {
  // A negative control: the published pairs do not pass without the weights.
  const auto& pair = kPublished[16];
  const double plain = std::hypot(pair.second[0] - pair.first[0], pair.second[1] - pair.first[1],
                                  pair.second[2] - pair.first[2]);
  EXPECT_GT(std::abs(plain - pair.difference), 5.0);
}

TEST(ColorDifference, OfBlackAndWhiteOnADisplayWithoutBlackIsTheLightnessRange) {
  perception::ViewingConditions viewing;
  viewing.black_cd_m2 = 0.0;
  viewing.ambient_lux = 0.0;
  const Image black = gray_picture(3, 2, Encoding::display, 0.0F);
  const Image white = gray_picture(3, 2, Encoding::display, 1.0F);
  const auto choice = metrics::parse_metric_choice("delta-e-2000", {});
  const auto score = metrics::score(choice, {black, white}, viewing);
  // L* from 0 to 100: the mean is 50, where the weight of lightness is 1.
  EXPECT_NEAR(score.value, 100.0, 1e-4);
  EXPECT_EQ(detail(score, "white_cd_m2"), 200.0);
  // Reflected light lifts the black.
  viewing.ambient_lux = 5000.0;
  EXPECT_LT(metrics::score(choice, {black, white}, viewing).value, 80.0);
}

TEST(ColorDifference, TheWhiteIsPeakAndReflection) {
  const Image gray = gray_picture(2, 2, Encoding::display, 0.5F);
  const auto score = score_of("delta-e-2000", gray, gray);
  EXPECT_NEAR(detail(score, "white_cd_m2"), 200.0 + 250.0 * 0.005 / std::numbers::pi, 1e-9);
}

TEST(ColorDifference, TakesLightAsItIs) {
  // 18.4187 % of the white is L* = 50; twice the light of a display pixel is not twice the signal.
  const float white = static_cast<float>(200.0 + 250.0 * 0.005 / std::numbers::pi);
  const Image middle = gray_picture(2, 2, Encoding::luminance_cd_m2, 0.184187F * white);
  const Image full = gray_picture(2, 2, Encoding::luminance_cd_m2, white);
  const double expected = ciede2000({50.0, 0.0, 0.0}, {100.0, 0.0, 0.0});
  EXPECT_NEAR(score_of("delta-e-2000", middle, full).value, expected, 1e-3);
}

TEST(ColorDifference, NegativeLightHasAValue) {
  const Image negative = uniform_picture(2, 2, Encoding::luminance_cd_m2, {-1.0F, 20.0F, 5.0F});
  const Image positive = uniform_picture(2, 2, Encoding::luminance_cd_m2, {1.0F, 20.0F, 5.0F});
  EXPECT_GT(score_of("delta-e-2000", negative, positive).value, 0.0);
}

TEST(ColorDifference, DetailsNameTheWorstPixel) {
  const Image reference = gray_picture(20, 10, Encoding::display, 0.5F);
  Image test = reference;
  test.at(7, 3, 0) = 0.9F;
  const auto score = score_of("delta-e-2000", reference, test);
  EXPECT_EQ(detail(score, "maximum_x_px"), 7.0);
  EXPECT_EQ(detail(score, "maximum_y_px"), 3.0);
  EXPECT_NEAR(score.value, detail(score, "maximum") / 200.0, 1e-6);
  EXPECT_EQ(detail(score, "p95"), 0.0);
}

}  // namespace
