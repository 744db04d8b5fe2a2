#include "metrics/cvvdp_pyramid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace {

using metrics::cvvdp_band_frequencies_cpd;
using metrics::Plane;

template <typename Function>
Plane<float> plane_of(int width_px, int height_px, const Function& function) {
  Plane<float> plane(width_px, height_px);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) plane.row(y)[x] = function(x, y);
  }
  return plane;
}

TEST(CvvdpPyramid, BandsGoDownToAFifthOfACycle) {
  const auto bands = cvvdp_band_frequencies_cpd(1920, 1080, 60.0);
  // 30, 9.684, 4.842, ..., 0.1513 (the first that is not above 0.2), base.
  ASSERT_EQ(bands.size(), 9U);
  EXPECT_DOUBLE_EQ(bands[0], 30.0);
  EXPECT_NEAR(bands[1], 9.684, 1e-12);
  EXPECT_NEAR(bands[2], 4.842, 1e-12);
  EXPECT_NEAR(bands[7], 0.1513125, 1e-9);
  EXPECT_EQ(bands[8], 0.1);
}

TEST(CvvdpPyramid, SmallPicturesHaveFewerBands) {
  EXPECT_EQ(cvvdp_band_frequencies_cpd(64, 48, 60.0).size(), 5U);
  EXPECT_EQ(cvvdp_band_frequencies_cpd(4, 400, 60.0).size(), 2U);
  EXPECT_EQ(cvvdp_band_frequencies_cpd(3, 400, 60.0), std::vector<double>{0.1});
  EXPECT_EQ(cvvdp_band_frequencies_cpd(1, 1, 60.0), std::vector<double>{0.1});
}

TEST(CvvdpPyramid, ReducingIsTheKernelAtEverySecondPixel) {
  const Plane<float> impulse =
      plane_of(16, 14, [](int x, int y) { return x == 7 && y == 6 ? 1.0F : 0.0F; });
  const Plane<float> coarse = metrics::cvvdp_reduced(impulse);
  EXPECT_EQ(coarse.width_px, 8);
  EXPECT_EQ(coarse.height_px, 7);
  EXPECT_FLOAT_EQ(coarse.row(3)[3], 0.4F * 0.25F);  // centre row, one column off
  EXPECT_FLOAT_EQ(coarse.row(3)[4], 0.4F * 0.25F);
  EXPECT_FLOAT_EQ(coarse.row(2)[3], 0.05F * 0.25F);  // two rows off
  EXPECT_EQ(coarse.row(3)[1], 0.0F);
}

TEST(CvvdpPyramid, UniformPlanesStayUniformWhereSidesAgreeInParity) {
  for (const auto& [width, height] : {std::pair{16, 14}, {15, 13}, {5, 5}, {4, 4}}) {
    const Plane<float> uniform = plane_of(width, height, [](int, int) { return 3.0F; });
    const Plane<float> coarse = metrics::cvvdp_reduced(uniform);
    for (const float value : coarse.values) EXPECT_NEAR(value, 3.0F, 1e-6F) << width;
    std::vector<float> row(static_cast<std::size_t>(width));
    for (int y = 0; y < height; ++y) {
      metrics::cvvdp_expand_row(coarse, y, width, row.data());
      for (const float value : row) EXPECT_NEAR(value, 3.0F, 2e-6F) << width << " row " << y;
    }
  }
}

TEST(CvvdpPyramid, TheLastColumnFollowsTheRowsAsInTheProgram) {
  const auto last_column = [](int width, int height) {
    const Plane<float> coarse =
        metrics::cvvdp_reduced(plane_of(width, height, [](int, int) { return 1.0F; }));
    return coarse.row(1)[coarse.width_px - 1];
  };
  // Odd rows, even columns: 0.95 of the kernel and 0.3; the other way round: 0.7 and 0.05.
  EXPECT_FLOAT_EQ(last_column(8, 7), 1.25F);
  EXPECT_FLOAT_EQ(last_column(7, 8), 0.75F);
  EXPECT_FLOAT_EQ(last_column(8, 8), 1.0F);
  EXPECT_FLOAT_EQ(last_column(7, 7), 1.0F);
}

TEST(CvvdpPyramid, ExpandingPutsWeightsOnBothKindsOfPlaces) {
  const Plane<float> coarse = plane_of(3, 1, [](int x, int) { return x == 1 ? 1.0F : 0.0F; });
  std::vector<float> row(6);
  metrics::cvvdp_expand_row(coarse, 0, 6, row.data());
  const std::vector<float> expected{0.1F, 0.5F, 0.8F, 0.5F, 0.1F, 0.0F};
  for (std::size_t i = 0; i < row.size(); ++i) EXPECT_FLOAT_EQ(row[i], expected[i]) << i;
}

}  // namespace
