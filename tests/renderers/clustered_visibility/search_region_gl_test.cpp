// Blockers that the search region misses, counted against brute force: receivers that do not see
// all of the light, and are told that nothing stands before it.
//
// The region is `search_scale` times the angle D / d under which the receiver sees the light; the
// penumbra's is D (d - z) / (d z) (Dong et al. 2009, Sec. 4.2). Of the receivers on the lit side of
// an edge that see it within the penumbra's half, those beyond the region's half are missed:
// 1 - search_scale z / (d - z) of them, none where that is less (derived, small angles).
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "tests/renderers/clustered_visibility/area_bench.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/scene_builder.h"

namespace test_clustered_visibility {
namespace {

constexpr int kReceivers = 512;
constexpr int kMap_px = 512;
constexpr float kLightHeight_m = 2.0F;
constexpr float kLightSize_m = 0.2F;
const glm::vec3 kUp{0.0F, 1.0F, 0.0F};

/// A floor and a plate over x < 0.
renderers::scene::Scene floor_and_plate(float height_m) {
  renderers::test::SceneBuilder builder;
  const int white = builder.add_material(renderers::test::lambert(glm::vec3(0.5F)));
  builder.add_quad({-3.0F, 0.0F, -3.0F}, {0.0F, 0.0F, 6.0F}, {6.0F, 0.0F, 0.0F}, white);
  builder.add_quad({-3.0F, height_m, -3.0F}, {0.0F, 0.0F, 6.0F}, {3.0F, 0.0F, 0.0F}, white);
  return builder.scene;
}

class SearchRegion : public renderers::test::GlTest {
 protected:
  /// What receivers in the lit half of the penumbra see of the light.
  /// @param depth_share  of the blocker, of the receivers' depth
  std::vector<double> lit_shares(float depth_share,
                                 const cv::AreaVisibilitySettings& settings) const {
    const float height_m = kLightHeight_m * (1.0F - depth_share);
    const AreaBench bench(context(), floor_and_plate(height_m),
                          light_above({0.0F, kLightHeight_m, 0.0F}, kLightSize_m, 3.5F), kMap_px);
    // Half of the penumbra on the floor, by similar triangles.
    const float half_m = 0.5F * kLightSize_m * (1.0F - depth_share) / depth_share;
    renderers::many_lights::SurfaceImage surfaces = renderers::test::empty_surfaces(kReceivers, 1);
    for (int i = 0; i < kReceivers; ++i) {
      const float x_m = half_m * (static_cast<float>(i) + 0.5F) / kReceivers;
      renderers::test::put_flat(surfaces, static_cast<std::size_t>(i), {x_m, 0.0F, 0.02F}, kUp);
    }
    return bench.visibility(surfaces, settings, {.terms = 8, .format = cv::BasisFormat::bits_16});
  }
  /// Of the receivers that do not see all of the light when the whole penumbra is searched, the
  /// share that does at this scale.
  double missed_share(float depth_share, cv::AreaVisibilitySettings settings,
                      float search_scale) const {
    settings.search_scale = search_scale;
    const std::vector<double> values = lit_shares(depth_share, settings);
    settings.search_scale = 1.2F * (1.0F - depth_share) / depth_share;
    const std::vector<double> all = lit_shares(depth_share, settings);
    int shadowed = 0;
    int missed = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i] >= 1.0) continue;
      ++shadowed;
      if (values[i] >= 1.0) ++missed;
    }
    return static_cast<double>(missed) / shadowed;
  }
};

cv::AreaVisibilitySettings settings_of(cv::AreaTest test) {
  cv::AreaVisibilitySettings settings;
  settings.test = test;
  settings.kernel = cv::KernelWidth::conformal;
  settings.fix = cv::LitFix::offset;
  settings.blocker = cv::BlockerDepth::corrected;
  return settings;
}

double derived_share(float depth_share, float search_scale) {
  const double z = double{depth_share};
  return std::max(1.0 - double{search_scale} * z / (1.0 - z), 0.0);
}

TEST_F(SearchRegion, MissesTheDerivedShareOfReceivers) {
  // Greatest difference measured: 0.04 of texels one by one, 0.09 of levels of the series.
  for (const auto& [test, tolerance] :
       {std::pair{cv::AreaTest::pcf, 0.06}, std::pair{cv::AreaTest::cssm, 0.11}}) {
    for (const float depth_share : {0.125F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F}) {
      for (const float search_scale : {1.0F, 2.0F}) {
        EXPECT_NEAR(missed_share(depth_share, settings_of(test), search_scale),
                    derived_share(depth_share, search_scale), tolerance)
            << static_cast<int>(test) << " " << depth_share << " " << search_scale;
      }
    }
  }
}

TEST_F(SearchRegion, MissesNothingBeyondHalfwayAndTwiceTheRegionNothingBeyondAThird) {
  for (const cv::AreaTest test : {cv::AreaTest::pcf, cv::AreaTest::cssm, cv::AreaTest::msm}) {
    const cv::AreaVisibilitySettings settings = settings_of(test);
    EXPECT_LT(missed_share(0.6F, settings, 1.0F), 0.02) << static_cast<int>(test);
    EXPECT_LT(missed_share(0.4F, settings, 2.0F), 0.02) << static_cast<int>(test);
    // Less is too little: what is asked of the default would fail there.
    EXPECT_GT(missed_share(0.6F, settings, 0.3F), 0.3) << static_cast<int>(test);
    EXPECT_GT(missed_share(0.2F, settings, 2.0F), 0.3) << static_cast<int>(test);
  }
}

TEST_F(SearchRegion, TwiceAsWideMissesFewer) {
  for (const cv::AreaTest test : {cv::AreaTest::pcf, cv::AreaTest::cssm, cv::AreaTest::msm}) {
    for (const float depth_share : {0.125F, 0.2F, 0.3F, 0.4F}) {
      EXPECT_LT(missed_share(depth_share, settings_of(test), 2.0F),
                missed_share(depth_share, settings_of(test), 1.0F) - 0.05)
          << static_cast<int>(test) << " " << depth_share;
    }
  }
}

}  // namespace
}  // namespace test_clustered_visibility
