#include "metrics/visible_difference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;
using perception::Encoding;
using perception::Image;

Image gray(float light_cd_m2) {
  return gray_picture(128, 96, Encoding::luminance_cd_m2, light_cd_m2);
}

Image with_square(Image image, int x0, int y0, int side, float added) {
  for (int y = y0; y < y0 + side; ++y) {
    for (int x = x0; x < x0 + side; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, y, c) += added;
    }
  }
  return image;
}

TEST(VisibleDifference, FindsASquareWhereItIs) {
  const auto score =
      score_of("visible-difference", gray(100.0F), with_square(gray(100.0F), 30, 40, 20, 20.0F));
  ASSERT_EQ(score.regions.size(), 1U);
  const auto& region = score.regions[0];
  EXPECT_NEAR(region.x_px + 0.5 * region.width_px, 40.0, 1.0);
  EXPECT_NEAR(region.y_px + 0.5 * region.height_px, 50.0, 1.0);
  EXPECT_GE(region.width_px, 20);
  EXPECT_EQ(region.value, detail(score, "jnd_max"));
  EXPECT_EQ(detail(score, "visible_regions"), 1.0);
  EXPECT_NEAR(score.value, detail(score, "largest_region_pixels") / (128.0 * 96.0), 1e-12);
  EXPECT_EQ(detail(score, "tvi"), 400.0 / (128.0 * 96.0));
  EXPECT_GT(detail(score, "p_detect"), 0.5 * score.value);
  EXPECT_LE(detail(score, "jnd_mean"), detail(score, "jnd_max"));
  EXPECT_LE(detail(score, "jnd_p95"), detail(score, "jnd_max"));
}

TEST(VisibleDifference, EdgeExcessCountsStepsTheReferenceHasNot) {
  const Image with_edges = with_square(gray(100.0F), 30, 40, 20, 20.0F);
  const auto excess = [](const Image& reference, const Image& test) {
    return detail(score_of("visible-difference", reference, test), "edge_excess");
  };
  // 20 pixels left of and 20 above the square, 20 at its right and 20 at its lower side, where the
  // corner counts once.
  EXPECT_EQ(excess(gray(100.0F), with_edges), 79.0 / (128.0 * 96.0));
  EXPECT_EQ(excess(with_edges, gray(100.0F)), 0.0);
  EXPECT_EQ(excess(with_edges, with_edges), 0.0);
  EXPECT_EQ(excess(gray(100.0F), gray(150.0F)), 0.0);
}

TEST(VisibleDifference, ContentHidesNoise) {
  // Stripes of four pixels, and faint stripes of the same width added to them and to a plain wall.
  const auto stripes = [](float mean, float amplitude, float extra) {
    return picture(128, 96, Encoding::luminance_cd_m2, [=](int x, int) -> std::array<float, 3> {
      const float side = x / 4 % 2 == 0 ? 1.0F : -1.0F;
      const float value = mean + (amplitude + extra) * side;
      return {value, value, value};
    });
  };
  const auto value = [&](float amplitude, const std::string& metric) {
    return score_of(metric, stripes(60.0F, amplitude, 0.0F), stripes(60.0F, amplitude, 1.5F)).value;
  };
  EXPECT_GT(value(0.0F, "visible-difference"), 0.5);
  EXPECT_LT(value(30.0F, "visible-difference"), 0.05);
  EXPECT_GT(value(30.0F, "visible-difference,masking=off"), 0.5);
}

TEST(VisibleDifference, StagesAreThoseOfTheirNames) {
  const Image reference = wavy_picture(96, 64, Encoding::display);
  const Image test = with_noise(reference, 0.1F);
  const auto full = score_of("visible-difference", reference, test);
  const auto off = score_of("visible-difference,masking=off", reference, test);
  EXPECT_EQ(detail(full, "tvi_csf"), off.value);
  EXPECT_LE(full.value, off.value);
  for (const char* masking : {"joint", "separate"}) {
    const auto score =
        score_of(std::string("visible-difference,masking=") + masking, reference, test);
    EXPECT_EQ(detail(score, "tvi_scale"), 1.0);
    EXPECT_LE(detail(score, "tvi_csf"), detail(score, "tvi")) << masking;
    EXPECT_LE(score.value, detail(score, "tvi_csf")) << masking;
  }
}

TEST(VisibleDifference, FromFartherAwayFineNoiseIsUnseen) {
  const Image reference = gray_picture(128, 96, Encoding::luminance_cd_m2, 60.0F);
  const Image test = with_noise(reference, 6.0F);
  const auto choice = metrics::parse_metric_choice("visible-difference", {});
  double last = 1.1;
  double first = 0.0;
  for (const double ppd : {20.0, 40.0, 80.0, 160.0}) {
    perception::ViewingConditions viewing;
    viewing.pixels_per_degree = ppd;
    const double value = metrics::score(choice, {reference, test}, viewing).value;
    EXPECT_LT(value, last) << ppd;
    if (ppd == 20.0) first = value;
    last = value;
  }
  EXPECT_LT(last, 0.25 * first);
}

TEST(VisibleDifference, PDetectIsTheMeanOfTheMap) {
  const Image reference = wavy_picture(96, 64, Encoding::display);
  const auto score = score_of("visible-difference", reference, with_noise(reference, 0.05F));
  double sum = 0.0;
  for (const float jnd : score.map->pixels) {
    sum += 1.0 - std::exp(-std::log(2.0) * std::pow(static_cast<double>(jnd), 3.5));
  }
  EXPECT_NEAR(detail(score, "p_detect"), sum / (96.0 * 64.0), 1e-5);
}

TEST(VisibleDifference, RefusesUnknownModels) {
  EXPECT_EQ(
      input_error_of([] { metrics::parse_metric_choice("visible-difference,masking=none", {}); }),
      "parameter \"masking\" of metric \"visible-difference\" cannot be \"none\"; accepted: "
      "one of band_matched, joint, separate, off");
}

}  // namespace
