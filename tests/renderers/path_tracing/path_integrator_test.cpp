#include "renderers/path_tracing/path_integrator.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "renderers/contract/stage_timer.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "tests/renderers/scene_builder.h"

/// Paths side by side find what each of them finds alone.
namespace renderers::path_tracing {
namespace {

using ray_tracing::Ray;
using ray_tracing::SampleSequence;

/// A ball with a lobe on a floor before a wall, open to a sky: paths end at different surfaces, and
/// light comes from a lamp, from a panel and from the sky.
test::SceneBuilder ball_under_lights() {
  test::SceneBuilder builder;
  const int grey = builder.add_material(test::lambert(glm::vec3(0.7F, 0.5F, 0.3F)));
  builder.add_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, grey);
  builder.add_quad({-3, 0, -3}, {6, 0, 0}, {0, 3, 0}, grey);
  builder.add_sphere({0, 1, 0}, 1.0F, 24,
                     builder.add_material(test::phong(glm::vec3(0.2F), glm::vec3(0.6F), 30.0F)));
  builder.add_quad({-2, 4, -1}, {2, 0, 0}, {0, 0, 2},
                   builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(8.0F))));
  builder.add_point_light({2, 3, 2}, glm::vec3(5.0F));
  builder.set_environment(glm::vec3(0.3F));
  builder.look({0, 2, 6}, {0, 1, 0}, 45.0F);
  return builder;
}

struct Found {
  std::vector<PathSample> samples;
  RayCounts counts;
};

constexpr int kSide_px = 16;

/// Paths of all pixels of a small picture, `at_once` side by side.
Found trace_all(const scene::Scene& scene, std::size_t at_once, bool light_rays) {
  StageTimer timer;
  const ray_tracing::RayScene rays(scene, timer);
  const ray_tracing::LightSampler lights(rays);
  PathSettings settings;
  settings.light_rays = light_rays;
  const PathIntegrator integrator(rays, lights, settings);
  const ray_tracing::CameraRays camera(scene.camera, kSide_px, kSide_px);
  std::vector<Ray> camera_rays;
  std::vector<SampleSequence> numbers;
  for (int pixel = 0; pixel < kSide_px * kSide_px; ++pixel) {
    camera_rays.push_back(camera.through(static_cast<float>(pixel % kSide_px) + 0.4F,
                                         static_cast<float>(pixel / kSide_px) + 0.6F));
    numbers.emplace_back(ray_tracing::SequenceKind::sobol, static_cast<std::uint64_t>(pixel), 3);
  }
  Found found;
  found.samples.resize(camera_rays.size());
  for (std::size_t first = 0; first < camera_rays.size(); first += at_once) {
    const std::size_t count = std::min(at_once, camera_rays.size() - first);
    integrator.trace(std::span(camera_rays).subspan(first, count),
                     std::span(numbers).subspan(first, count),
                     std::span(found.samples).subspan(first, count), found.counts);
  }
  return found;
}

/// A packet may name the other triangle of an edge, no more.
void expect_same(const Found& together, const Found& alone) {
  EXPECT_EQ(together.counts.camera, alone.counts.camera);
  EXPECT_EQ(together.counts.light, alone.counts.light);
  int different = 0;
  for (std::size_t i = 0; i < alone.samples.size(); ++i) {
    const PathSample& a = alone.samples[i];
    const PathSample& b = together.samples[i];
    const bool is_same = a.direct == b.direct && a.indirect == b.indirect && a.albedo == b.albedo &&
                         a.normal == b.normal && a.has_surface == b.has_surface;
    different += is_same ? 0 : 1;
  }
  EXPECT_LE(different, 1);
  if (different > 0) return;
  EXPECT_EQ(together.counts.bounce, alone.counts.bounce);
  EXPECT_EQ(together.counts.shadow, alone.counts.shadow);
}

TEST(PathIntegrator, PathsSideBySideFindWhatEachFindsAlone) {
  const test::SceneBuilder builder = ball_under_lights();
  for (const bool light_rays : {false, true}) {
    const Found alone = trace_all(builder.scene, 1, light_rays);
    EXPECT_EQ(alone.counts.light, light_rays ? alone.counts.camera : 0U);
    int with_light = 0;
    int without_surface = 0;
    for (const PathSample& sample : alone.samples) {
      with_light += sample.indirect != glm::vec3(0.0F) ? 1 : 0;
      without_surface += sample.has_surface ? 0 : 1;
    }
    EXPECT_GT(with_light, 40);
    EXPECT_GT(without_surface, 20);
    for (const std::size_t at_once : {std::size_t{3}, std::size_t{7}, std::size_t{16}}) {
      SCOPED_TRACE(std::to_string(at_once) + " at once");
      expect_same(trace_all(builder.scene, at_once, light_rays), alone);
    }
  }
}

TEST(PathIntegrator, NumbersOfAnotherPathFindOtherLight) {
  const test::SceneBuilder builder = ball_under_lights();
  const Found all = trace_all(builder.scene, 16, false);
  int same = 0;
  for (std::size_t i = 1; i < all.samples.size(); ++i) {
    const glm::vec3& light = all.samples[i].indirect;
    if (light != glm::vec3(0.0F) && light == all.samples[i - 1].indirect) ++same;
  }
  EXPECT_LE(same, 1) << "samples of neighbours were mixed up";
}

}  // namespace
}  // namespace renderers::path_tracing
