#include "perception/cortex_transform.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/perception/luminance_patterns.h"

namespace perception {
namespace {

double energy(const Image& image) {
  double sum = 0.0;
  for (const float value : image.pixels) {
    sum += static_cast<double>(value) * static_cast<double>(value);
  }
  return sum / static_cast<double>(image.pixels.size());
}

TEST(CortexFilters, DomsAndBaseSumToOneWithinTheSpectrum) {
  for (double rho = 0.0; rho < 0.66; rho += 0.0013) {
    double sum = CortexTransform::base(rho);
    for (int level = 1; level <= CortexTransform::kLevels; ++level) {
      sum += CortexTransform::dom(level, rho);
    }
    EXPECT_NEAR(sum, 1.0, 1e-12) << rho;
  }
}

TEST(CortexFilters, EachLevelHasUnitResponseAtItsCentre) {
  for (int level = 2; level <= CortexTransform::kLevels; ++level) {
    const double centre = CortexTransform::centre_cycles_px(level);
    EXPECT_NEAR(CortexTransform::dom(level, centre), 1.0, 1e-12);
    EXPECT_LT(CortexTransform::dom(level, 0.9 * centre), 1.0);
    EXPECT_LT(CortexTransform::dom(level, 1.1 * centre), 1.0);
    EXPECT_NEAR(CortexTransform::dom(level, 2.1 * centre), 0.0, 1e-12);
  }
  // Half amplitude at the mesas' corners.
  EXPECT_NEAR(CortexTransform::dom(2, 0.5), 0.5, 1e-12);
  EXPECT_NEAR(CortexTransform::dom(2, 0.25), 0.5, 1e-12);
  EXPECT_NEAR(CortexTransform::base(1.0 / 32.0 * 4.0 / 9.0), std::exp(-0.5), 1e-12);
}

TEST(CortexFilters, FansSumToOneAndPointWhereTheySay) {
  for (double angle = -180.0; angle <= 180.0; angle += 7.3) {
    double sum = 0.0;
    for (int o = 0; o < CortexTransform::kOrientations; ++o) sum += CortexTransform::fan(o, angle);
    EXPECT_NEAR(sum, 1.0, 1e-12) << angle;
  }
  EXPECT_EQ(CortexTransform::centre_deg(3), 0.0);
  EXPECT_NEAR(CortexTransform::fan(3, 180.0), 1.0, 1e-12);
  EXPECT_NEAR(CortexTransform::fan(3, 15.0), 0.5, 1e-12);
  EXPECT_EQ(orientation_difference_deg(-85.0, 85.0), 10.0);
}

/// The gains of one frequency at the columns fx, or 0 where a column is left out.
double gain_at(const FrequencyResponse& response, float fx, float fy) {
  float gain = 0.0F;
  const std::array<float, 1> fys{fy};
  return response(fx, fys, {&gain, 1}) ? double{gain} : 0.0;
}

TEST(CortexFilters, ResponsesAreTheProductsOfDomAndFan) {
  for (float fx = 0.0F; fx <= 0.5F; fx += 0.013F) {
    for (float fy = -0.5F; fy <= 0.5F; fy += 0.011F) {
      const double rho = std::hypot(fx, fy);
      const double angle_deg = std::atan2(fy, fx) * 180.0 / std::numbers::pi;
      for (int level = 1; level <= CortexTransform::kLevels; ++level) {
        for (int o = 0; o < CortexTransform::kOrientations; ++o) {
          EXPECT_NEAR(gain_at(CortexTransform::channel_response(level, o), fx, fy),
                      CortexTransform::dom(level, rho) * CortexTransform::fan(o, angle_deg), 5e-6)
              << level << " " << o << " at " << fx << ", " << fy;
        }
        EXPECT_NEAR(gain_at(CortexTransform::mesa_response(level), fx, fy),
                    CortexTransform::mesa(level, rho), 1e-6);
      }
      EXPECT_NEAR(gain_at(CortexTransform::base_response(), fx, fy), CortexTransform::base(rho),
                  1e-6);
    }
  }
}

TEST(CortexFilters, MesasFallOverTheirTransition) {
  EXPECT_NEAR(CortexTransform::mesa(0, 1.0), 0.5, 1e-12);
  EXPECT_NEAR(CortexTransform::mesa(2, 0.25), 0.5, 1e-12);
  EXPECT_EQ(CortexTransform::mesa(2, 0.25 * 2.0 / 3.0), 1.0);
  EXPECT_EQ(CortexTransform::mesa(2, 0.25 * 4.0 / 3.0), 0.0);
  // As far as the corners of the spectrum go, mesa 0 lets everything pass.
  EXPECT_GT(CortexTransform::mesa(0, std::sqrt(0.5)), 0.99);
}

TEST(CortexTransform, ChannelsSumToTheImage) {
  // Oversampled, so that it has nothing in the corners of the spectrum.
  const Image picture = tests::light_image(75, 50, [](int x, int y) {
    return 10.0 + std::sin(0.7 * x) + 2.0 * std::cos(0.4 * y + 0.1 * x) + 0.1 * x;
  });
  const CortexTransform cortex(picture);
  Image sum = cortex.baseband();
  for (int level = 1; level <= CortexTransform::kLevels; ++level) {
    for (int o = 0; o < CortexTransform::kOrientations; ++o) {
      const Image channel = cortex.channel(level, o);
      for (std::size_t p = 0; p < sum.pixels.size(); ++p) sum.pixels[p] += channel.pixels[p];
    }
  }
  for (std::size_t p = 0; p < sum.pixels.size(); ++p) {
    EXPECT_NEAR(sum.pixels[p], picture.pixels[p], 5e-3F);
  }
}

TEST(CortexTransform, AGratingIsInItsOwnChannel) {
  for (const int orientation : {3, 4, 0}) {  // 0, 30 and -90 degrees
    const CortexTransform cortex(tests::grating(128, 1.0, 1.0, CortexTransform::centre_cycles_px(3),
                                                CortexTransform::centre_deg(orientation)));
    const double own = energy(cortex.channel(3, orientation));
    EXPECT_NEAR(own, 0.5, 0.06) << orientation;
    EXPECT_LT(energy(cortex.channel(3, (orientation + 3) % 6)), 0.02 * own);
    EXPECT_LT(energy(cortex.channel(5, orientation)), 0.02 * own);
  }
}

TEST(CortexTransform, WorksOnOnePixel) {
  const CortexTransform cortex(tests::light_image(1, 1, [](int, int) { return 4.0; }));
  EXPECT_NEAR(cortex.baseband().at(0, 0), 4.0F, 1e-5F);
  EXPECT_NEAR(cortex.channel(2, 1).at(0, 0), 0.0F, 1e-5F);
}

}  // namespace
}  // namespace perception
