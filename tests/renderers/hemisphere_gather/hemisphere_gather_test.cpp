#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "renderers/indirect_view/hemisphere_rays.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"
#include "tests/renderers/scene_builder.h"

/// Gathers by hemisphere rays: closed forms, then the renderer against the path tracer and against
/// the gather of links.
namespace renderers::test {
namespace {

using indirect_view::HemisphereRays;
using indirect_view::HemisphereSequence;
using indirect_view::ViewedPoint;

constexpr HemisphereSequence kSequences[]{HemisphereSequence::random, HemisphereSequence::strata,
                                          HemisphereSequence::sobol};

ViewedPoint point_on_floor(const ray_tracing::RayScene& rays) {
  return indirect_view::viewed_point(rays.point_on_triangle(0, 0, {0.5F, 0.0F}), {0, 1, 0}, 5, 0);
}

/// A square above the middle of a floor: four times the form factor of a differential element to a
/// rectangle whose corner is above it (Siegel and Howell 1992, configuration 11; recalled).
TEST(HemisphereRays, SeeASquareUnderItsFormFactor) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, white);
  builder.add_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);
  StageTimer timer;
  const ray_tracing::RayScene rays(builder.scene, timer);
  ViewedPoint point = point_on_floor(rays);
  point.surface.position = {0, 0, 0};
  const double root = std::sqrt(2.0);
  const double factor = 4.0 / 3.14159265358979 * (1.0 / root) * std::atan(1.0 / root);
  for (const HemisphereSequence sequence : kSequences) {
    std::uint64_t cast = 0;
    const glm::vec3 light = gather_irradiance(
        rays, point, {4096, sequence}, [](const ViewedPoint&, float) { return glm::vec3(1.0F); },
        cast);
    const double tolerance = sequence == HemisphereSequence::random ? 0.03 : 0.01;
    EXPECT_NEAR(static_cast<double>(light.x), 3.14159265358979 * factor, tolerance * 3.0);
    EXPECT_EQ(cast, 4096U);
  }
}

/// Every cell of the grid has one point, and the points of later samples go on with the sequence.
TEST(HemisphereRays, AreSpreadOverTheSquare) {
  ViewedPoint point;
  for (const HemisphereSequence sequence :
       {HemisphereSequence::strata, HemisphereSequence::sobol}) {
    std::vector<int> counts(64, 0);
    for (int i = 0; i < 64; ++i) {
      const glm::vec2 u = hemisphere_sample({64, sequence}, point, i);
      ++counts[static_cast<std::size_t>(static_cast<int>(u.x * 8.0F) * 8 +
                                        static_cast<int>(u.y * 8.0F))];
    }
    for (const int count : counts) EXPECT_EQ(count, 1);
  }
  point.index = 1;
  const glm::vec2 next = hemisphere_sample({32, HemisphereSequence::sobol}, point, 0);
  point.index = 0;
  EXPECT_EQ(next, hemisphere_sample({64, HemisphereSequence::sobol}, point, 32));
}

/// 65,536 rays at sample 65,536 of a pixel are point 2^32 of the sequence, not its first again.
TEST(HemisphereRays, DoNotRepeatAfterFourThousandMillion) {
  ViewedPoint first;
  ViewedPoint late;
  late.index = 1U << 16;
  for (const HemisphereSequence sequence : kSequences) {
    const HemisphereRays rays{1 << 16, sequence};
    EXPECT_NE(hemisphere_sample(rays, first, 7), hemisphere_sample(rays, late, 7));
  }
}

Frame gather_of(const scene::Scene& scene, const std::vector<std::string>& settings,
                std::int64_t samples, int threads = 0) {
  return render(scene, {.renderer = "hemisphere-gather",
                        .settings = settings,
                        .width_px = 16,
                        .height_px = 16,
                        .samples = samples,
                        .threads = threads});
}

TEST(HemisphereGather, AgreesWithThePathTracer) {
  const SceneBuilder builder = lit_room();
  const Frame truth =
      render(builder.scene,
             {.settings = {"transport=diffuse"}, .width_px = 16, .height_px = 16, .samples = 256});
  const double indirect = mean_of(aov(truth, "indirect"));
  const Frame frame = gather_of(builder.scene, {"link_budget=5000", "gather_rays=16"}, 16);
  EXPECT_NEAR(mean_of(frame.radiance), mean_of(truth.radiance), 0.02 * mean_of(truth.radiance));
  EXPECT_NEAR(mean_of(aov(frame, "indirect")), indirect, 0.03 * indirect);
}

/// The same solution, gathered along its links: the same picture.
TEST(HemisphereGather, AgreesWithTheGatherOfLinks) {
  const SceneBuilder builder = lit_room();
  const Frame links = render(builder.scene, {.renderer = "final-gather",
                                             .settings = {"link_budget=2000", "gather_samples=64",
                                                          "border_rays=4", "camera_rays=4"},
                                             .width_px = 16,
                                             .height_px = 16,
                                             .samples = 0});
  const Frame frame = gather_of(builder.scene, {"link_budget=2000", "gather_rays=16"}, 16);
  EXPECT_EQ(counter(frame, "links"), counter(links, "links"));
  EXPECT_NEAR(mean_of(frame.radiance), mean_of(links.radiance), 0.04 * mean_of(links.radiance));
}

TEST(HemisphereGather, SameBytesForEveryNumberOfThreads) {
  const SceneBuilder builder = lit_room();
  const std::vector<std::string> settings{"link_budget=500", "gather_rays=4"};
  EXPECT_EQ(gather_of(builder.scene, settings, 2, 1).radiance.pixels,
            gather_of(builder.scene, settings, 2, 2).radiance.pixels);
}

TEST(HemisphereGather, ItsIndirectPartIsPartOfAll) {
  const SceneBuilder builder = lit_room();
  const Frame all = gather_of(builder.scene, {"link_budget=500", "gather_rays=4"}, 2);
  const Frame part =
      gather_of(builder.scene, {"link_budget=500", "gather_rays=4", "part=indirect"}, 2);
  EXPECT_EQ(part.radiance.pixels, aov(all, "indirect").pixels);
}

}  // namespace
}  // namespace renderers::test
