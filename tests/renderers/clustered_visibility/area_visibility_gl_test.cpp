// The share of an area light that receivers see, against the oracle in double precision and against
// the penumbra of a straight edge.
#include "renderers/clustered_visibility/area_visibility.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "renderers/clustered_visibility/light_clusters.h"
#include "renderers/shadow_maps/hard_maps.h"
#include "renderers/shadow_maps/hemisphere_projection.h"
#include "tests/renderers/clustered_visibility/convolution_oracle.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::clustered_visibility {
namespace {

using test_clustered_visibility::BasisMeans;
using test_clustered_visibility::ConvolutionSeries;
using test_clustered_visibility::DepthMap;
using test_clustered_visibility::StepFix;

constexpr int kReceivers = 96;
constexpr int kMap_px = 64;
constexpr float kLightHeight_m = 2.0F;
constexpr float kEdgeHeight_m = 1.0F;
constexpr float kLightSize_m = 0.4F;

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
    scene_ = floor_and_plate();
    gpu_scene_.emplace(context());
    StageTimer timer;
    gpu_scene_->load(scene_, timer);
    area_.position = {0.0F, kLightHeight_m, 0.0F, 1.0F};
    area_.axis = {0.0F, -1.0F, 0.0F, 0.0F};
    area_.shape = {kLightSize_m, kFarDepth / std::sqrt(22.0F), kLightSize_m * kLightSize_m, 1.0F};
    lights_ = opengl::Buffer::of<AreaLight>(context(), std::array{area_});
    maps_.emplace(context(), kMap_px, 1);
    shadow_maps::HardMaps(context()).fill(*maps_, *gpu_scene_, {&lights_, kAreaLightStride}, 0, 1);
    surfaces_ = test::empty_surfaces(kReceivers, 1);
    for (int i = 0; i < kReceivers; ++i) {
      test::put_flat(surfaces_, static_cast<std::size_t>(i), receiver_at(i), {0.0F, 1.0F, 0.0F});
    }
  }

  std::vector<double> visibility(const AreaVisibilitySettings& settings,
                                 const ConvolutionSettings& convolution) {
    std::optional<ConvolutionMaps> filtered;
    if (settings.test == AreaTest::cssm) {
      filtered.emplace(context(), kMap_px, 1, convolution);
      filtered->make(*maps_, lights_);
    }
    const auto geometry = test::geometry_of(context(), surfaces_);
    const opengl::Texture shown(context(), {.width_px = kReceivers, .height_px = 1});
    show_visibility(*geometry, 0, settings, {lights_, *maps_, filtered ? &*filtered : nullptr},
                    shown);
    std::vector<double> values;
    for (const glm::vec3& each : test::read_rgb(shown)) values.push_back(double{each.x});
    return values;
  }

  DepthMap depth_map() const {
    DepthMap map{kMap_px, {}};
    for (const std::uint32_t word : maps_->distances().read_words()) {
      const double distance_m = double{std::bit_cast<float>(word)};
      map.z.push_back(std::min(distance_m * double{area_.shape.y}, double{kFarDepth}));
    }
    return map;
  }

  scene::Scene scene_;
  std::optional<opengl::GpuScene> gpu_scene_;
  AreaLight area_;
  opengl::Buffer lights_;
  std::optional<shadow_maps::HemisphereMaps> maps_;
  many_lights::SurfaceImage surfaces_;
};

/// A receiver as the map sees it.
struct Seen {
  glm::dvec2 uv{0.0};
  double radius = 0.0;
  double distance_m = 0.0;
  double cosine = 0.0;
};

Seen seen_from(const AreaLight& area, float near_m, const glm::vec3& receiver) {
  const glm::dvec3 axis(area.axis);
  const glm::dvec3 center = glm::dvec3(area.position) + double{near_m} * axis;
  const glm::dvec3 local = (glm::dvec3(receiver) - center) * shadow_maps::hemisphere_frame(axis);
  const glm::dvec2 place = shadow_maps::hemisphere_position(local);
  return {0.5 * place + 0.5, glm::length(place), glm::length(local), local.z / glm::length(local)};
}

/// The oracle's answer; nothing near the step at which blockers are taken for none.
class Oracle {
 public:
  Oracle(const AreaVisibilitySettings& settings, int terms, DepthMap map)
      : settings_(settings), series_{terms, double{settings.damping}}, map_(std::move(map)) {}

  std::optional<double> visibility(const AreaLight& area, const Seen& seen) const {
    namespace oracle = test_clustered_visibility;
    const double depth = seen.distance_m * double{area.shape.y};
    const double search = width(
        oracle::search_angle_rad(1.0, double{area.shape.z}, seen.cosine, seen.distance_m), seen);
    const std::optional<double> blocker = blocker_depth(means_at(seen, search), depth);
    if (!blocker) return std::nullopt;
    if (*blocker >= depth) return 1.0;
    const double penumbra_m =
        oracle::penumbra_width(depth, std::max(*blocker, 1e-4), double{area.shape.x});
    const double kernel = width(std::atan2(penumbra_m, seen.distance_m), seen);
    return oracle::filtered_visibility(series_, means_at(seen, kernel), depth, fix());
  }

 private:
  StepFix fix() const { return settings_.fix == LitFix::scale ? StepFix::scale : StepFix::offset; }
  double width(double angle_rad, const Seen& seen) const {
    namespace oracle = test_clustered_visibility;
    const double uv = settings_.kernel == KernelWidth::paper
                          ? oracle::paper_kernel_width_uv(angle_rad)
                          : oracle::conformal_kernel_width_uv(angle_rad, seen.radius);
    return std::clamp(uv, 1.0 / kMap_px, 1.0);
  }
  BasisMeans means_at(const Seen& seen, double kernel_width) const {
    return test_clustered_visibility::basis_means(
        series_, test_clustered_visibility::box_kernel(map_, seen.uv, kernel_width));
  }
  std::optional<double> blocker_depth(const BasisMeans& means, double depth) const {
    namespace oracle = test_clustered_visibility;
    constexpr double kNear = 0.01;
    const bool is_corrected = settings_.blocker == BlockerDepth::corrected;
    const bool is_offset = is_corrected && fix() == StepFix::offset;
    const double compared = is_offset ? depth - oracle::series_offset(series_) : depth;
    const oracle::BlockerSums sums = oracle::blocker_sums(series_, means, compared);
    const double share =
        is_corrected && !is_offset ? 2.0 * sums.denominator - 1.0 : sums.denominator;
    const double least = is_corrected ? oracle::kLeastBlockedFraction : 0.0;
    if (std::abs(share - least) < kNear) return std::nullopt;
    if (share <= least) return depth;
    const double z = is_corrected ? *oracle::corrected_blocker_depth(series_, means, depth, fix())
                                  : oracle::raw_blocker_depth(sums);
    return std::clamp(z, 0.0, depth);
  }

  AreaVisibilitySettings settings_;
  ConvolutionSeries series_;
  DepthMap map_;
};

TEST_F(AreaVisibility, FromTablesIsTheOraclesForEveryConvention) {
  const DepthMap map = depth_map();
  for (const LitFix fix : {LitFix::scale, LitFix::offset}) {
    for (const BlockerDepth blocker : {BlockerDepth::raw, BlockerDepth::corrected}) {
      for (const KernelWidth kernel : {KernelWidth::paper, KernelWidth::conformal}) {
        AreaVisibilitySettings settings;
        settings.fix = fix;
        settings.blocker = blocker;
        settings.kernel = kernel;
        const Oracle oracle(settings, 4, map);
        const std::vector<double> values =
            visibility(settings, {.terms = 4, .prefilter = Prefilter::sat});
        int compared = 0;
        for (int i = 0; i < kReceivers; ++i) {
          const auto expected =
              oracle.visibility(area_, seen_from(area_, maps_->near_m(), receiver_at(i)));
          if (!expected) continue;
          EXPECT_NEAR(values[static_cast<std::size_t>(i)], *expected, 0.004) << i;
          ++compared;
        }
        EXPECT_GT(compared, kReceivers * 3 / 4);
      }
    }
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
  for (const AreaTest test : {AreaTest::pcf, AreaTest::cssm}) {
    settings.test = test;
    const std::vector<double> values =
        visibility(settings, {.terms = 8, .format = BasisFormat::bits_16});
    const Rise rise = rise_of(values);
    EXPECT_NEAR(rise.center_m, 0.0, 0.1) << static_cast<int>(test);
    EXPECT_NEAR(rise.width_m, analytic_m, 0.25 * analytic_m) << static_cast<int>(test);
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
  for (const AreaTest test : {AreaTest::hard, AreaTest::pcf, AreaTest::cssm}) {
    for (const double value : visibility({.test = test}, {})) EXPECT_EQ(value, 1.0);
  }
}

}  // namespace
}  // namespace renderers::clustered_visibility
