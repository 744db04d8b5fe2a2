// The share of an area light that receivers see, against the oracle in double precision and against
// the penumbra of a straight edge.
#include "renderers/clustered_visibility/area_visibility.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tests/renderers/clustered_visibility/area_bench.h"
#include "tests/renderers/clustered_visibility/closer_oracle.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::clustered_visibility {
namespace {

using test_clustered_visibility::AreaBench;
using test_clustered_visibility::AreaVisibilityOracle;
using test_clustered_visibility::CloserOracle;
using test_clustered_visibility::DepthMap;
using test_clustered_visibility::light_above;

constexpr int kReceivers = 96;
constexpr int kMap_px = 64;
constexpr float kLightHeight_m = 2.0F;
constexpr float kEdgeHeight_m = 1.0F;
constexpr float kLightSize_m = 0.4F;
const glm::vec3 kUp{0.0F, 1.0F, 0.0F};
constexpr double kTolerance = 0.004;  ///< of what the device answers, to the oracle

/// A floor, and above it a plate that covers x < 0.
scene::Scene floor_and_plate() {
  test::SceneBuilder builder;
  const int white = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_quad({-3.0F, 0.0F, -3.0F}, {0.0F, 0.0F, 6.0F}, {6.0F, 0.0F, 0.0F}, white);
  builder.add_quad({-3.0F, kEdgeHeight_m, -3.0F}, {0.0F, 0.0F, 6.0F}, {3.0F, 0.0F, 0.0F}, white);
  return builder.scene;
}

/// Receivers on the floor along x.
glm::vec3 receiver_at(int index) {
  return {-1.5F + 3.0F * (static_cast<float>(index) + 0.5F) / kReceivers, 0.0F, 0.1F};
}

class AreaVisibility : public test::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    bench_.emplace(context(), floor_and_plate(),
                   light_above({0.0F, kLightHeight_m, 0.0F}, kLightSize_m, std::sqrt(22.0F)),
                   kMap_px);
    surfaces_ = test::empty_surfaces(kReceivers, 1);
    for (int i = 0; i < kReceivers; ++i) {
      test::put_flat(surfaces_, static_cast<std::size_t>(i), receiver_at(i), kUp);
    }
  }
  void TearDown() override {
    bench_.reset();
    GlTest::TearDown();
  }

  std::vector<double> visibility(const AreaVisibilitySettings& settings,
                                 const ConvolutionSettings& convolution) {
    return bench_->visibility(surfaces_, settings, convolution);
  }

  /// The device's answers are the oracle's at three quarters of the receivers or more.
  void expect_oracle(const AreaVisibilitySettings& settings,
                     const ConvolutionSettings& convolution) {
    SCOPED_TRACE(testing::Message()
                 << "test " << static_cast<int>(settings.test) << " fix "
                 << static_cast<int>(settings.fix) << " kernel "
                 << static_cast<int>(settings.kernel) << " terms " << convolution.terms
                 << " prefilter " << static_cast<int>(convolution.prefilter));
    const std::vector<double> values = visibility(settings, convolution);
    const AreaVisibilityOracle oracle(settings, convolution, bench_->depth_map());
    int compared = 0;
    for (int i = 0; i < kReceivers; ++i) {
      const auto expected = bench_->oracle_visibility(oracle, receiver_at(i), kUp);
      if (!expected) continue;
      EXPECT_NEAR(values[static_cast<std::size_t>(i)], *expected, kTolerance) << i;
      ++compared;
    }
    EXPECT_GT(compared, kReceivers * 3 / 4);
  }

  std::optional<AreaBench> bench_;
  many_lights::SurfaceImage surfaces_;
};

TEST_F(AreaVisibility, OfEveryConventionIsTheOracles) {
  for (const LitFix fix : {LitFix::scale, LitFix::offset}) {
    for (const BlockerDepth blocker : {BlockerDepth::raw, BlockerDepth::corrected}) {
      AreaVisibilitySettings settings;
      settings.fix = fix;
      settings.blocker = blocker;
      for (const KernelWidth kernel : {KernelWidth::paper, KernelWidth::conformal}) {
        settings.kernel = kernel;
        expect_oracle(settings, {4, Prefilter::sat, BasisFormat::bits_16});
        expect_oracle(settings, {4, Prefilter::mip, BasisFormat::bits_16});
      }
    }
  }
}

TEST_F(AreaVisibility, OfEveryRefinementIsTheOracles) {
  AreaVisibilitySettings best;
  best.fix = LitFix::offset;
  best.blocker = BlockerDepth::corrected;
  best.kernel = KernelWidth::conformal;
  best.finer_levels = 1.0F;
  best.slope_bias = 0.25F;
  const ConvolutionSettings levels{8, Prefilter::mip, BasisFormat::bits_16};
  expect_oracle(best, levels);
  for (const int terms : {2, 4, 16}) {
    expect_oracle(best, {terms, Prefilter::mip, BasisFormat::bits_16});
  }
  expect_oracle(best, {6, Prefilter::sat, BasisFormat::bits_16});
  for (const float damping : {0.0F, 1.0F}) {
    AreaVisibilitySettings settings = best;
    settings.damping = damping;
    expect_oracle(settings, levels);
  }
  AreaVisibilitySettings settings = best;
  settings.is_foreshortened = true;
  settings.search_scale = 1.5F;
  expect_oracle(settings, levels);
  settings.contact_strength = 2.0F;
  settings.contact_range = 5.0F;
  expect_oracle(settings, levels);
}

TEST_F(AreaVisibility, OfMomentsIsTheOracles) {
  AreaVisibilitySettings settings;
  settings.test = AreaTest::msm;
  for (const KernelWidth kernel : {KernelWidth::paper, KernelWidth::conformal}) {
    settings.kernel = kernel;
    for (const float finer_levels : {0.0F, 1.5F}) {
      settings.moments.finer_levels = finer_levels;
      expect_oracle(settings, {});
    }
  }
  settings.moments.slope = 0.3F;
  settings.moments.blocked_bias = 0.2F;
  settings.moments.bias = 1e-4F;
  settings.is_foreshortened = true;
  expect_oracle(settings, {});
  settings.moments.taps = 2;
  expect_oracle(settings, {});
  settings.moments = {.taps = 3, .finer_levels = 0.8F};
  expect_oracle(settings, {});
}

TEST_F(AreaVisibility, OracleTellsSettingsApart) {
  AreaVisibilitySettings settings;
  settings.test = AreaTest::msm;
  const std::vector<double> values = visibility(settings, {});
  AreaVisibilitySettings other = settings;
  other.moments.finer_levels = 1.0F;
  const AreaVisibilityOracle oracle(other, {}, bench_->depth_map());
  double greatest = 0.0;
  for (int i = 0; i < kReceivers; ++i) {
    const auto expected = bench_->oracle_visibility(oracle, receiver_at(i), kUp);
    greatest = std::max(greatest, std::abs(*expected - values[static_cast<std::size_t>(i)]));
  }
  EXPECT_GT(greatest, 5.0 * kTolerance);
}

/// How many of the device's answers are the oracle's, of how many it has one for.
struct Agreement {
  int same = 0;
  int compared = 0;
};
Agreement agreement(const std::vector<double>& values, const CloserOracle& oracle) {
  constexpr double kSame = 1e-5;
  Agreement found;
  for (int i = 0; i < kReceivers; ++i) {
    const auto expected = oracle.visibility(receiver_at(i), kUp);
    if (!expected) continue;
    ++found.compared;
    if (std::abs(values[static_cast<std::size_t>(i)] - *expected) < kSame) ++found.same;
  }
  return found;
}

TEST_F(AreaVisibility, OfComparisonsOneByOneIsTheOraclesToTheTexel) {
  const DepthMap map = bench_->depth_map();
  const auto oracle_of = [&](const AreaVisibilitySettings& settings) {
    return CloserOracle(settings, bench_->area_light(), bench_->near_m(), map);
  };
  std::vector<AreaVisibilitySettings> all{{.test = AreaTest::hard}};
  for (const KernelWidth kernel : {KernelWidth::paper, KernelWidth::conformal}) {
    for (const float search_scale : {1.0F, 2.0F}) {
      for (const bool is_foreshortened : {false, true}) {
        all.push_back({.test = AreaTest::pcf,
                       .kernel = kernel,
                       .search_scale = search_scale,
                       .is_foreshortened = is_foreshortened});
      }
    }
  }
  for (const AreaVisibilitySettings& settings : all) {
    const Agreement found = agreement(visibility(settings, {}), oracle_of(settings));
    EXPECT_GT(found.compared, kReceivers * 3 / 4) << &settings - all.data();
    EXPECT_EQ(found.same, found.compared) << &settings - all.data();
  }
  // One test, another kernel: either would be noticed.
  const std::vector<double> values = visibility(all[1], {});
  for (const std::size_t other : {0U, 5U}) {
    const Agreement found = agreement(values, oracle_of(all[other]));
    EXPECT_LT(found.same, found.compared - 2) << other;
  }
}

/// Centre and width of the rise from 10 % to 90 % along the receivers, m.
struct Rise {
  double center_m = 0.0;
  double width_m = 0.0;
};
Rise rise_of(const std::vector<double>& values) {
  const auto crossing = [&](double level) {
    for (std::size_t i = 1; i < values.size(); ++i) {
      if (values[i - 1] < level && values[i] >= level) {
        const double part = (level - values[i - 1]) / (values[i] - values[i - 1]);
        const double step_m = 3.0 / kReceivers;
        return double{receiver_at(static_cast<int>(i - 1)).x} + part * step_m;
      }
    }
    return std::nan("");
  };
  return {crossing(0.5), crossing(0.9) - crossing(0.1)};
}

TEST_F(AreaVisibility, AStraightEdgeHasThePenumbraOfTheLightsSize) {
  // By similar triangles D (h_edge) / (h_light - h_edge) wide, around x = 0: 10 to 90 % of 0.4 m.
  const double analytic_m = 0.8 * double{kLightSize_m};
  AreaVisibilitySettings settings;
  settings.fix = LitFix::offset;
  settings.blocker = BlockerDepth::corrected;
  settings.kernel = KernelWidth::conformal;
  settings.finer_levels = 0.5F;
  settings.moments.finer_levels = 0.5F;
  settings.moments.blocked_bias = 0.0F;
  // Moments bound shadows from below, which cuts the penumbra's dark end.
  // Several boxes side by side leave less of it out.
  struct Case {
    AreaTest test;
    double tolerance;
    int taps = 1;
  };
  for (const auto& [test, tolerance, taps] :
       {Case{AreaTest::pcf, 0.25}, Case{AreaTest::cssm, 0.25}, Case{AreaTest::msm, 0.35},
        Case{AreaTest::msm, 0.2, 2}, Case{AreaTest::msm, 0.15, 3}}) {
    settings.test = test;
    settings.moments.taps = taps;
    const std::vector<double> values =
        visibility(settings, {.terms = 8, .format = BasisFormat::bits_16});
    const Rise rise = rise_of(values);
    EXPECT_NEAR(rise.center_m, 0.0, 0.1) << static_cast<int>(test);
    EXPECT_NEAR(rise.width_m, analytic_m, tolerance * analytic_m) << static_cast<int>(test);
    EXPECT_NEAR(values.front(), 0.0, 0.05);
    EXPECT_NEAR(values.back(), 1.0, 0.05);
  }
}

TEST_F(AreaVisibility, OneTestHasNoPenumbra) {
  const Rise rise = rise_of(visibility({.test = AreaTest::hard}, {}));
  EXPECT_NEAR(rise.center_m, 0.0, 0.1);
  EXPECT_LT(rise.width_m, 3.1 / kReceivers);
}

TEST_F(AreaVisibility, BehindTheLightsPlaneEverythingIsSeen) {
  for (int i = 0; i < kReceivers; ++i) {
    surfaces_.position[static_cast<std::size_t>(i)].y = kLightHeight_m + 0.1F;
  }
  for (const AreaTest test : {AreaTest::hard, AreaTest::pcf, AreaTest::cssm, AreaTest::msm}) {
    for (const double value : visibility({.test = test}, {})) EXPECT_EQ(value, 1.0);
  }
}

}  // namespace
}  // namespace renderers::clustered_visibility
