// The penumbra of a half-plane in double precision, before each background and by each convention.
//
// A strip light parallel to the blocker's edge is seen as far as the edge's shadow line lies across
// it: a linear ramp, which is the blocked share of a box as wide as the penumbra (intercept
// theorem). Here the box has the true width, so what differs is the series (Annen et al. 2007) and
// the filter ahead of it alone.
#include "tests/renderers/clustered_visibility/convolution_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tests/renderers/clustered_visibility/area_visibility_oracle.h"

namespace test_clustered_visibility {
namespace {

constexpr int kMap_px = 64;
constexpr int kKernel_px = 16;
constexpr double kReceiver = 0.6;  ///< depth
constexpr double kFar = 0.9;       ///< of a background behind the receiver

enum class Background { floor, far };  ///< the receiver's own plane goes on, or something far does
enum class Filter { mip, sat };

struct Case {
  Background background = Background::floor;
  StepFix fix = StepFix::scale;
  Filter filter = Filter::sat;
  ConvolutionSeries series{};
  double gap = 0.3;       ///< depth of the receiver less that of the blocker
  int edge_px = 32;       ///< blockers in columns before this one
  bool is_ideal = false;  ///< the comparison itself in place of the series
};

DepthMap map_of(const Case& own) {
  DepthMap map{kMap_px, {}};
  for (int i = 0; i < kMap_px * kMap_px; ++i) {
    const double free = own.background == Background::floor ? kReceiver : kFar;
    map.z.push_back(i % kMap_px < own.edge_px ? kReceiver - own.gap : free);
  }
  return map;
}

/// Lit share of a receiver whose kernel's centre lies this far on the lit side of the edge.
double ramp(double offset_px) { return std::clamp(0.5 + offset_px / kKernel_px, 0.0, 1.0); }

double lit_share(const Case& own, const DepthMap& map, double offset_px) {
  const glm::dvec2 center((own.edge_px + offset_px) / kMap_px, 0.5);
  const Kernel kernel = own.filter == Filter::sat
                            ? box_kernel(map, center, 1.0 * kKernel_px / kMap_px)
                            : level_kernel(map, center, std::log2(kKernel_px));
  if (own.is_ideal) return exact_visibility(kernel, kReceiver);
  return filtered_visibility(own.series, basis_means(own.series, kernel), kReceiver, own.fix);
}

/// Greatest difference to the ramp, over receivers across the penumbra and as far again on both
/// sides.
double greatest_error(const Case& own) {
  const DepthMap map = map_of(own);
  double greatest = 0.0;
  for (double offset_px = -kKernel_px; offset_px <= kKernel_px; offset_px += 1.0) {
    greatest = std::max(greatest, std::abs(lit_share(own, map, offset_px) - ramp(offset_px)));
  }
  return greatest;
}

/// Bound of the error that the series makes.
///
/// scale before the receiver's own plane: what is left of a blocker's light, 2 f S(-gap), and the
/// undershoot: 0.13, 0.05, 0.03 for 4, 8, 16 terms. Without damping the series itself has 0.0632
/// and 0.0365 with 8 and 16 (measured over all gaps in steps of 0.01): bounds on these.
/// offset: the step's overshoot, 0.09, before either background. But half of the series' rise,
/// which is 1 / K wide, lies before the receiver: nearer blockers leave light, with 4 terms and a
/// gap of 0.15 a third of it (0.304 without damping, 0.342 with the default).
/// scale before a far background: see `ScaleBeforeAFarBackgroundIsWrongByAHalf`.
double series_bound(const Case& own) {
  constexpr double kRounding = 1e-9;
  const int terms = own.series.terms;
  if (own.fix == StepFix::offset) return own.gap < 1.0 / terms - kRounding ? 0.35 : 0.09;
  if (own.series.damping > 0.0) return terms == 4 ? 0.13 : terms == 8 ? 0.05 : 0.03;
  return terms == 4 ? 0.13 : terms == 8 ? 0.065 : 0.037;
}

/// A level's texels stand on a grid and are interpolated: the ramp where the edge lies between two
/// of them, p (1 - p) off where it leaves the share p of one blocked (derived; up to 1/4, as the
/// rise is then twice as wide).
double filter_bound(const Case& own) {
  constexpr double kRounding = 1e-12;
  if (own.filter == Filter::sat) return kRounding;
  const double cut = static_cast<double>(own.edge_px % kKernel_px) / kKernel_px;
  return cut * (1.0 - cut) + kRounding;
}

template <typename Test>
void for_each_case(const Test& test) {
  for (const Background background : {Background::floor, Background::far}) {
    for (const StepFix fix : {StepFix::scale, StepFix::offset}) {
      for (const Filter filter : {Filter::mip, Filter::sat}) {
        for (const int terms : {4, 8, 16}) {
          for (const double damping : {0.0, 0.5}) {
            for (const double gap : {0.15, 0.25, 0.4}) {
              for (const int edge_px : {32, 36, 40}) {
                test(Case{background, fix, filter, {terms, damping}, gap, edge_px});
              }
            }
          }
        }
      }
    }
  }
}

testing::Message text_of(const Case& own) {
  return testing::Message() << (own.background == Background::floor ? "floor" : "far") << " "
                            << (own.fix == StepFix::scale ? "scale" : "offset") << " "
                            << (own.filter == Filter::sat ? "sat" : "mip") << " K "
                            << own.series.terms << " a " << own.series.damping << " gap " << own.gap
                            << " edge " << own.edge_px;
}

TEST(HalfPlaneOracle, ComparisonsAloneGiveTheRampWithinTheFiltersBound) {
  for_each_case([](Case own) {
    own.is_ideal = true;
    EXPECT_LE(greatest_error(own), filter_bound(own)) << text_of(own);
  });
}

TEST(HalfPlaneOracle, ALevelIsOffByWhatItsBoundSaysWhereItsTexelIsCut) {
  Case own;
  own.is_ideal = true;
  own.filter = Filter::mip;
  for (const int edge_px : {36, 40, 44}) {
    own.edge_px = edge_px;
    EXPECT_NEAR(greatest_error(own), filter_bound(own), 1e-9) << edge_px;
  }
}

TEST(HalfPlaneOracle, EveryCaseKeepsTheBoundsOfSeriesAndFilter) {
  for_each_case([](const Case& own) {
    if (own.fix == StepFix::scale && own.background == Background::far) return;
    EXPECT_LE(greatest_error(own), series_bound(own) + filter_bound(own)) << text_of(own);
  });
}

TEST(HalfPlaneOracle, ScaleBeforeAFarBackgroundIsWrongByAHalf) {
  // S is the lit share itself there, not half of it: doubled and clamped it is 1 up to f = 1/2,
  // where half of the light should be gone, whatever the number of terms.
  for_each_case([](const Case& own) {
    if (own.fix != StepFix::scale || own.background != Background::far) return;
    // Ripples move the half by as much as 0.067 (4 terms, no damping, a gap of 0.15).
    EXPECT_NEAR(greatest_error(own), 0.5, 0.07 + filter_bound(own)) << text_of(own);
  });
}

TEST(HalfPlaneOracle, BoundsAreNearToWhatTheSeriesHas) {
  // The greatest error over all gaps from 0.15 on, of boxes: no bound is more than three times it.
  for (const StepFix fix : {StepFix::scale, StepFix::offset}) {
    for (const int terms : {4, 8, 16}) {
      for (const double damping : {0.0, 0.5}) {
        double greatest = 0.0;
        Case own{Background::floor, fix, Filter::sat, {terms, damping}};
        const double first = fix == StepFix::offset ? std::max(0.15, 1.0 / terms) : 0.15;
        for (double gap = first; gap < 0.51; gap += 0.01) {
          own.gap = gap;
          greatest = std::max(greatest, greatest_error(own));
        }
        EXPECT_LE(greatest, series_bound(own)) << text_of(own);
        EXPECT_GT(greatest, series_bound(own) / 3.0) << text_of(own);
      }
    }
  }
}

}  // namespace
}  // namespace test_clustered_visibility
