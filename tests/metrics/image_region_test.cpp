#include "metrics/image_region.h"

#include <gtest/gtest.h>

#include "metrics/score_pooling.h"
#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;
using metrics::ImageRegion;
using metrics::region_mask;

Image sized(int width_px, int height_px) {
  return perception::make_gray_image(width_px, height_px, "Y", Encoding::scene_linear);
}

std::size_t pixels_in(const ImageRegion& region, int width_px, int height_px) {
  const Image mask = region_mask(region, sized(width_px, height_px), nullptr, "leak");
  return metrics::pooled_pixel_count(mask, &mask);
}

TEST(ImageRegion, HoldsThePixelsWithTheirCentreInside) {
  const Image mask = region_mask({0.25, 0.5, 0.5, 0.25}, sized(8, 12), nullptr, "leak");
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 8; ++x) {
      EXPECT_EQ(mask.at(x, y), x >= 2 && x < 6 && y >= 6 && y < 9 ? 1.0F : 0.0F) << x << " " << y;
    }
  }
}

TEST(ImageRegion, IsTheSamePlaceAtEverySize) {
  for (const int scale : {1, 2, 5}) {
    EXPECT_EQ(pixels_in({0.1, 0.2, 0.3, 0.7}, 10 * scale, 10 * scale),
              static_cast<std::size_t>(21 * scale * scale));
  }
}

TEST(ImageRegion, RegionsThatTileTheImageTileItsPixels) {
  for (const int width : {1, 2, 3, 7, 10, 15, 33, 35}) {
    // 0.1 + 0.2 is more than 0.3 in binary; the border must not move.
    std::size_t sum = 0;
    for (const auto& [x, share] : {std::pair{0.0, 0.1}, {0.1, 0.2}, {0.3, 0.6}, {0.9, 0.1}}) {
      if (width >= 10) sum += pixels_in({x, 0.0, share, 1.0}, width, 4);
    }
    EXPECT_EQ(sum, width >= 10 ? static_cast<std::size_t>(4 * width) : 0U) << width;
    EXPECT_EQ(pixels_in({}, width, 4), static_cast<std::size_t>(4 * width));
  }
}

TEST(ImageRegion, TakesPartInTheMask) {
  const Image left = mask_where(8, 8, [](int x, int) { return x < 3; });
  const Image mask = region_mask({0.25, 0.0, 0.75, 1.0}, sized(8, 8), &left, "leak");
  for (int x = 0; x < 8; ++x) EXPECT_EQ(mask.at(x, 4), x == 2 ? 1.0F : 0.0F) << x;
}

TEST(ImageRegion, RefusesWhatIsNotInTheImage) {
  const auto parse_error = [](const char* text) {
    return input_error_of([&] { metrics::parse_metric_choice(text, {"suite.yaml", 3, 7}); });
  };
  EXPECT_EQ(parse_error("leak,x=0.6,width=0.5"),
            "metric \"leak\": x + width of the region is 1.1; accepted: at most 1");
  EXPECT_EQ(parse_error("holes,y=0.5"),
            "metric \"holes\": y + height of the region is 1.5; accepted: at most 1");
  EXPECT_EQ(parse_error("edge-excess,x=-0.1"),
            "suite.yaml:3:7: parameter \"x\" of metric \"edge-excess\" cannot be \"-0.1\"; "
            "accepted: a number from 0 to 1 (image widths)");
  EXPECT_EQ(parse_error("contrast-kept,width=0"),
            "suite.yaml:3:7: parameter \"width\" of metric \"contrast-kept\" cannot be \"0\"; "
            "accepted: a number from 0.0001 to 1 (image widths)");
  EXPECT_EQ(parse_error("leak,x=0.7,width=0.3"), "no error");
}

TEST(ImageRegion, RefusesRegionsWithoutPixels) {
  EXPECT_EQ(input_error_of([] {
              pixels_in({0.4, 0.0, 0.2, 1.0}, 4, 3);
            }),
            "metric \"leak\": the region x=0.4 y=0 width=0.2 height=1 holds no centre of the 4x3 "
            "pixels; accepted: a region with at least one");
  const Image left = mask_where(8, 8, [](int x, int) { return x < 3; });
  EXPECT_EQ(input_error_of([&] {
              region_mask({0.5, 0.0, 0.5, 1.0}, sized(8, 8), &left, "holes");
            }),
            "metric \"holes\": no pixel of the region takes part; accepted: a mask with at least "
            "one 1 in it, finite in both images");
}

}  // namespace
