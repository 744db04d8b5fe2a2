// The penumbra of a half-plane on the device, all of Dong et al. 2009, Sec. 4: blockers are looked
// for, their mean depth gives the kernel, the kernel the lit share. In every case against the
// oracle in double precision, and both against the linear ramp that a strip light parallel to the
// edge gives.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/renderers/clustered_visibility/area_bench.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/scene_builder.h"

namespace test_clustered_visibility {
namespace {

constexpr int kReceivers = 96;
constexpr int kMap_px = 64;
constexpr float kLightHeight_m = 2.0F;
constexpr float kEdgeHeight_m = 1.0F;
constexpr float kLightSize_m = 0.5F;
constexpr float kReach_m = 0.6F;      ///< of the receivers, on both sides of the edge
constexpr float kFarthest_m = 3.2F;   ///< the gap is then 0.28 of the depths or more
constexpr float kFarFloor_m = -1.0F;  ///< height
constexpr double kTolerance = 0.004;  ///< of what the device answers, to the oracle
const glm::vec3 kUp{0.0F, 1.0F, 0.0F};

enum class Background { floor, far };

/// A plate over x < 0, and a floor at the receivers' height or far below them.
renderers::scene::Scene plate_over(Background background) {
  renderers::test::SceneBuilder builder;
  const int white = builder.add_material(renderers::test::lambert(glm::vec3(0.5F)));
  const float height_m = background == Background::floor ? 0.0F : kFarFloor_m;
  builder.add_quad({-3.0F, height_m, -3.0F}, {0.0F, 0.0F, 6.0F}, {6.0F, 0.0F, 0.0F}, white);
  builder.add_quad({-3.0F, kEdgeHeight_m, -3.0F}, {0.0F, 0.0F, 6.0F}, {3.0F, 0.0F, 0.0F}, white);
  return builder.scene;
}

glm::vec3 receiver_at(int index) {
  return {kReach_m * (2.0F * (static_cast<float>(index) + 0.5F) / kReceivers - 1.0F), 0.0F, 0.1F};
}

/// Share of the light before the line from a receiver through the edge, which is halfway.
double ramp(double x_m) { return std::clamp(0.5 + x_m / double{kLightSize_m}, 0.0, 1.0); }

struct Errors {
  double greatest = 0.0;
  double mean = 0.0;
};

Errors errors_of(const std::vector<double>& values) {
  Errors errors;
  for (int i = 0; i < kReceivers; ++i) {
    const double error =
        std::abs(values[static_cast<std::size_t>(i)] - ramp(double{receiver_at(i).x}));
    errors.greatest = std::max(errors.greatest, error);
    errors.mean += error / kReceivers;
  }
  return errors;
}

class HalfPlane : public renderers::test::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    surfaces_ = renderers::test::empty_surfaces(kReceivers, 1);
    for (int i = 0; i < kReceivers; ++i) {
      renderers::test::put_flat(surfaces_, static_cast<std::size_t>(i), receiver_at(i), kUp);
    }
  }
  AreaBench bench(Background background) const {
    return {context(), plate_over(background),
            light_above({0.0F, kLightHeight_m, 0.0F}, kLightSize_m, kFarthest_m), kMap_px};
  }

  renderers::many_lights::SurfaceImage surfaces_;
};

/// A case, and what was measured of it: greatest and mean difference to the ramp.
///
/// With a box of the true width and depths that are even within it the series alone has 0.13, 0.05,
/// 0.03 (half_plane_oracle_test.cpp). Here the width is found, and a flat receiver's distance
/// varies within a kernel, which the finer step of more terms takes for blockers and for none.
struct Row {
  Background background;
  cv::LitFix fix;
  cv::Prefilter prefilter;
  int terms;
  double greatest, mean;
};
constexpr auto kFloor = Background::floor;
constexpr auto kFar = Background::far;
constexpr auto kScale = cv::LitFix::scale;
constexpr auto kOffset = cv::LitFix::offset;
constexpr auto kMip = cv::Prefilter::mip;
constexpr auto kSat = cv::Prefilter::sat;
constexpr Row kRows[] = {
    {kFloor, kScale, kMip, 4, 0.288, 0.0829},   {kFloor, kScale, kMip, 8, 0.438, 0.0850},
    {kFloor, kScale, kMip, 16, 0.538, 0.1054},  {kFloor, kScale, kSat, 4, 0.088, 0.0383},
    {kFloor, kScale, kSat, 8, 0.188, 0.0243},   {kFloor, kScale, kSat, 16, 0.338, 0.0486},
    {kFloor, kOffset, kMip, 4, 0.162, 0.0095},  {kFloor, kOffset, kMip, 8, 0.232, 0.0117},
    {kFloor, kOffset, kMip, 16, 0.214, 0.0111}, {kFloor, kOffset, kSat, 4, 0.177, 0.0104},
    {kFloor, kOffset, kSat, 8, 0.196, 0.0124},  {kFloor, kOffset, kSat, 16, 0.214, 0.0150},
    {kFar, kScale, kMip, 4, 0.688, 0.1714},     {kFar, kScale, kMip, 8, 0.688, 0.1471},
    {kFar, kScale, kMip, 16, 0.688, 0.1405},    {kFar, kScale, kSat, 4, 0.639, 0.1679},
    {kFar, kScale, kSat, 8, 0.621, 0.1435},     {kFar, kScale, kSat, 16, 0.614, 0.1394},
    {kFar, kOffset, kMip, 4, 0.038, 0.0071},    {kFar, kOffset, kMip, 8, 0.050, 0.0099},
    {kFar, kOffset, kMip, 16, 0.038, 0.0062},   {kFar, kOffset, kSat, 4, 0.066, 0.0084},
    {kFar, kOffset, kSat, 8, 0.083, 0.0088},    {kFar, kOffset, kSat, 16, 0.082, 0.0083},
};

cv::AreaVisibilitySettings settings_of(const Row& row) {
  cv::AreaVisibilitySettings settings;
  settings.fix = row.fix;
  settings.blocker = cv::BlockerDepth::corrected;
  settings.kernel = cv::KernelWidth::conformal;
  return settings;
}

cv::ConvolutionSettings convolution_of(const Row& row) {
  return {row.terms, row.prefilter, cv::BasisFormat::bits_16};
}

TEST_F(HalfPlane, EveryCaseIsTheOraclesAndAsFarFromTheRampAsMeasured) {
  constexpr double kMargin = 1.1;
  for (const Background background : {kFloor, kFar}) {
    const AreaBench bench = this->bench(background);
    const DepthMap map = bench.depth_map();
    for (const Row& row : kRows) {
      if (row.background != background) continue;
      SCOPED_TRACE(testing::Message() << "row " << &row - kRows);
      const std::vector<double> values =
          bench.visibility(surfaces_, settings_of(row), convolution_of(row));
      const AreaVisibilityOracle oracle(settings_of(row), convolution_of(row), map);
      int compared = 0;
      for (int i = 0; i < kReceivers; ++i) {
        const auto expected = bench.oracle_visibility(oracle, receiver_at(i), kUp);
        if (!expected) continue;
        EXPECT_NEAR(values[static_cast<std::size_t>(i)], *expected, kTolerance) << i;
        ++compared;
      }
      EXPECT_GE(compared, kReceivers - 6) << "or too many stand at the step of `visibility`";
      const Errors errors = errors_of(values);
      EXPECT_LT(errors.greatest, kMargin * row.greatest);
      EXPECT_LT(errors.mean, kMargin * row.mean);
    }
  }
}

TEST_F(HalfPlane, OnlyTheOffsetFindsThePenumbraBeforeAFarBackground) {
  const AreaBench bench = this->bench(kFar);
  for (const Row& row : kRows) {
    if (row.background != kFar) continue;
    const Errors errors =
        errors_of(bench.visibility(surfaces_, settings_of(row), convolution_of(row)));
    EXPECT_EQ(errors.greatest > 0.5, row.fix == kScale) << &row - kRows;
    EXPECT_EQ(errors.mean > 0.05, row.fix == kScale) << &row - kRows;
  }
}

TEST_F(HalfPlane, OtherSettingsWouldNotPassForTheOracles) {
  const AreaBench bench = this->bench(kFloor);
  const DepthMap map = bench.depth_map();
  const Row& row = kRows[4];
  const std::vector<double> values =
      bench.visibility(surfaces_, settings_of(row), convolution_of(row));
  const auto greatest = [&](const Row& other) {
    const AreaVisibilityOracle oracle(settings_of(other), convolution_of(other), map);
    double difference = 0.0;
    for (int i = 0; i < kReceivers; ++i) {
      const auto expected = bench.oracle_visibility(oracle, receiver_at(i), kUp);
      if (!expected) continue;
      difference = std::max(difference, std::abs(values[static_cast<std::size_t>(i)] - *expected));
    }
    return difference;
  };
  EXPECT_LT(greatest(row), kTolerance);
  for (const int other : {1, 3, 5, 10}) {
    EXPECT_GT(greatest(kRows[other]), 5.0 * kTolerance) << "filter, terms, fix: row " << other;
  }
}

}  // namespace
}  // namespace test_clustered_visibility
