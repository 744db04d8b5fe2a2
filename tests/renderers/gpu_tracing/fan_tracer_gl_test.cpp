#include "renderers/gpu_tracing/fan_tracer.h"

#include <array>
#include <bit>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/renderers/gpu_tracing/random_triangles.h"
#include "tests/renderers/opengl/platform_test.h"

/// Lists of shadow rays.
namespace renderers::gpu_tracing {
namespace {

using ray_tracing::kSegmentEnd;

/// Rays that may graze an edge of 3,600: one, as a share of 1e-5 is less than that.
constexpr int kMostDiffering = 1;

class FanTracerGlTest : public opengl::PlatformTest {};
INSTANTIATE_TEST_SUITE_P(Platforms, FanTracerGlTest, opengl::all_platforms(),
                         opengl::platform_label);

/// Points in a cube and directions as targets; every fourth target is not asked for.
struct Setting {
  explicit Setting(std::size_t fan_count) {
    const auto rays = test::random_rays(fan_count + 3 * kFanTargets, 5);
    for (std::size_t i = 0; i < 3 * kFanTargets; ++i) {
      const bool is_direction = i >= 2 * kFanTargets;
      targets.emplace_back(rays[fan_count + i].origin,
                           is_direction ? std::numeric_limits<float>::infinity() : kSegmentEnd);
    }
    for (std::size_t i = 0; i < fan_count; ++i) {
      const glm::vec3& o = rays[i].origin;
      fans.push_back({{o.x, o.y, o.z}, static_cast<std::uint32_t>(i % 3 * kFanTargets), 0x7777U});
    }
  }

  std::uint32_t expected(const ray_tracing::RayScene& rays, const Fan& fan) const {
    std::uint32_t bits = 0;
    for (std::uint32_t k = 0; k < kFanTargets; ++k) {
      const glm::vec4& target = targets[fan.first_target + k];
      const glm::vec3 origin(fan.origin[0], fan.origin[1], fan.origin[2]);
      const bool is_direction = target.w > 1.0F;
      const glm::vec3 direction = is_direction ? glm::vec3(target) : glm::vec3(target) - origin;
      const bool is_asked = (fan.asked >> k & 1U) != 0;
      if (is_asked && rays.is_occluded({origin, direction, target.w})) bits |= 1U << k;
    }
    return bits;
  }

  std::vector<glm::vec4> targets;
  std::vector<Fan> fans;
};

TEST_P(FanTracerGlTest, FindsWhatEmbreeFindsHoweverFewBoxesATurnHas) {
  const scene::Scene scene = test::scene_of(test::random_triangles(500, 0.3F, 3));
  StageTimer timer;
  const ray_tracing::RayScene rays(scene, timer);
  GpuBvh bvh(context_);
  bvh.load(build_bvh(rays), timer);
  const Setting setting(300);
  FanTracer tracer(context_);
  tracer.set_targets(setting.targets);
  const auto bits = tracer.occluded(bvh, setting.fans, timer);
  ASSERT_EQ(bits.size(), setting.fans.size());
  int differing = 0;
  std::string list;
  for (std::size_t i = 0; i < bits.size(); ++i) {
    const std::uint32_t unlike = bits[i] ^ setting.expected(rays, setting.fans[i]);
    differing += std::popcount(unlike);
    if (unlike != 0) list += " fan " + std::to_string(i) + ": " + std::to_string(unlike);
  }
  EXPECT_LE(differing, kMostDiffering) << list;
  for (const std::uint32_t most_boxes : {1U, 7U, 100U}) {
    tracer.limit_boxes(most_boxes);
    EXPECT_EQ(tracer.occluded(bvh, setting.fans, timer), bits) << most_boxes;
  }
  EXPECT_GT(timer.wall_of("upload"), 0.0);
  EXPECT_GT(timer.wall_of("rays"), 0.0);
  EXPECT_GT(timer.wall_of("download"), 0.0);
}

/// Needles whose boxes all lie on every ray, and a sheet behind them: more turns of a loop than the
/// software driver allows.
TEST_P(FanTracerGlTest, LongWaysComeToTheirEnd) {
  std::vector<BvhTriangle> triangles;
  constexpr std::uint32_t kNeedles = 90'000;
  for (std::uint32_t i = 0; i < kNeedles; ++i) {
    const float x = 1e-5F * static_cast<float>(i % 300);
    const float y = 1e-5F * static_cast<float>(i / 300);
    const glm::vec3 a(-1.0F + x, -1.0F + y, 0.4F);
    const glm::vec3 b(1.0F + x, 1.0F + y, 0.6F);
    triangles.push_back({a, 0, b, i, a + glm::vec3(1e-3F, 0, 0), 0});
  }
  StageTimer timer;
  const std::vector<glm::vec4> targets(kFanTargets, glm::vec4(0.5F, -0.5F, 2.0F, 1.0F));
  const std::vector<Fan> fans(3, Fan{{0.5F, -0.5F, -1.0F}, 0, 0xFFFFU});
  FanTracer tracer(context_);
  tracer.set_targets(targets);
  GpuBvh bvh(context_);
  bvh.load(build_bvh(triangles), timer);
  EXPECT_EQ(tracer.occluded(bvh, fans, timer), std::vector<std::uint32_t>(3, 0U));
  triangles.push_back({{0, -1, 1.5F}, 0, {1, -1, 1.5F}, kNeedles, {0.5F, 1, 1.5F}, 0});
  bvh.load(build_bvh(triangles), timer);
  EXPECT_EQ(tracer.occluded(bvh, fans, timer), std::vector<std::uint32_t>(3, 0xFFFFU));
}

TEST_P(FanTracerGlTest, AsksNothingOfAnEmptySceneOrAnEmptyList) {
  StageTimer timer;
  GpuBvh bvh(context_);
  bvh.load(TriangleBvh{}, timer);
  const Setting setting(4);
  FanTracer tracer(context_);
  tracer.set_targets(setting.targets);
  EXPECT_EQ(tracer.occluded(bvh, setting.fans, timer), std::vector<std::uint32_t>(4, 0U));
  EXPECT_TRUE(tracer.occluded(bvh, {}, timer).empty());
}

}  // namespace
}  // namespace renderers::gpu_tracing
