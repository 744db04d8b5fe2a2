#include "renderers/ray_tracing/ray_scene.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::ray_tracing {
namespace {

TEST(RayScene, HitHoldsWhatTheTriangleSays) {
  test::SceneBuilder builder;
  const int grey = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_quad({10, 0, 0}, {1, 0, 0}, {0, 1, 0}, grey);
  builder.add_quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, grey);
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  EXPECT_EQ(rays.triangle_count(), 4U);
  EXPECT_EQ(rays.box_max(), glm::vec3(11, 2, 0));
  Hit hit;
  ASSERT_TRUE(rays.intersect({{1.5F, 0.5F, 3}, {0, 0, -2}}, hit));
  EXPECT_FLOAT_EQ(hit.t, 1.5F);
  EXPECT_EQ(hit.object, 1U);
  EXPECT_EQ(hit.triangle, 0U);
  EXPECT_EQ(hit.geometric_normal, glm::vec3(0, 0, 1));
  EXPECT_NEAR(glm::distance(hit.position, glm::vec3(1.5F, 0.5F, 0)), 0.0F, 1e-6F);
  EXPECT_NEAR(glm::distance(hit.uv, glm::vec2(0.75F, 0.25F)), 0.0F, 1e-6F);
  EXPECT_FLOAT_EQ(rays.triangle_area_m2(1, 0), 2.0F);
  EXPECT_FALSE(rays.intersect({{5, 5, 3}, {0, 0, -1}}, hit));
  EXPECT_TRUE(rays.is_occluded({{1, 0.5F, 3}, {0, 0, -1}}));
  EXPECT_FALSE(rays.is_occluded({{1, 0.5F, 3}, {0, 0, -1}, 2.9F}));
}

TEST(RayScene, TransformsMoveTheFrontSideAlong) {
  for (const glm::vec3& scale : {glm::vec3(2, 1, 1), glm::vec3(-2, 1, 1), glm::vec3(1, 1, 3)}) {
    test::SceneBuilder builder;
    builder.add_sphere({0, 0, 0}, 1.0F, 32, builder.add_material(test::lambert(glm::vec3(0.5F))));
    glm::mat4 transform = glm::translate(glm::mat4(1.0F), glm::vec3(5, 0, 0));
    builder.scene.objects[0].to_world = glm::scale(transform, scale);
    StageTimer timer;
    const RayScene rays(builder.scene, timer);
    Hit hit;
    ASSERT_TRUE(rays.intersect({{5, 3, 0.3F}, {0, -1, 0}}, hit));
    EXPECT_GT(hit.geometric_normal.y, 0.8F) << "the outside stays the front";
    EXPECT_GT(glm::dot(hit.geometric_normal, hit.shading_normal), 0.9F);
    // Ellipsoid: the normal is the gradient (x/a2, y/b2, z/c2).
    const glm::vec3 local = hit.position - glm::vec3(5, 0, 0);
    const glm::vec3 gradient = glm::normalize(local / (scale * scale));
    EXPECT_NEAR(glm::dot(hit.shading_normal, gradient), 1.0F, 1e-3F);
  }
}

TEST(RayScene, EmptySceneIsEmptySpace) {
  const scene::Scene scene;
  StageTimer timer;
  const RayScene rays(scene, timer);
  Hit hit;
  EXPECT_FALSE(rays.intersect({{0, 0, 0}, {0, 0, 1}}, hit));
  EXPECT_FALSE(rays.is_occluded({{0, 0, 0}, {0, 0, 1}}));
}

TEST(RayScene, TimesItsStages) {
  test::SceneBuilder builder;
  builder.add_sphere({0, 0, 0}, 1.0F, 64, builder.add_material(test::lambert(glm::vec3(0.5F))));
  StageTimer timer;
  {
    const auto stage = timer.stage("build");
    const RayScene rays(builder.scene, timer);
    EXPECT_GT(rays.memory_bytes(), 100000);
  }
  EXPECT_GT(timer.wall_of("build/bvh"), 0.0);
  EXPECT_GT(timer.wall_of("build/triangles"), 0.0);
}

/// Rays from random points of a sphere's outside, into the open: none may meet the sphere. From the
/// inside all must.
void check_no_self_intersection(float scale, const glm::vec3& center) {
  test::SceneBuilder builder;
  builder.add_sphere(center, scale, 24, builder.add_material(test::lambert(glm::vec3(0.5F))));
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  int meetings = 0;
  int leaks = 0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    SampleSequence numbers(SequenceKind::sobol, 11, i);
    const glm::vec4 u = numbers.next();
    const auto triangle =
        static_cast<std::uint32_t>(u.z * static_cast<float>(rays.triangle_count()));
    const SurfacePoint point = rays.point_on_triangle(0, triangle, uniform_triangle({u.x, u.y}));
    const glm::vec4 v = numbers.next();
    const Frame3 frame = frame_around(point.geometric_normal);
    const glm::vec3 out = frame.to_world(cosine_hemisphere({v.x, v.y}));
    meetings += rays.is_occluded(ray_from(point, out)) ? 1 : 0;
    leaks += rays.is_occluded(ray_from(point, -out)) ? 0 : 1;
  }
  EXPECT_EQ(meetings, 0) << "scale " << scale;
  EXPECT_EQ(leaks, 0) << "scale " << scale;
}

TEST(RayOffset, SpheresOfEveryScaleNeitherMeetThemselvesNorLeak) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    check_no_self_intersection(scale, glm::vec3(0.0F));
    check_no_self_intersection(scale, scale * glm::vec3(10.0F, -20.0F, 30.0F));
  }
}

TEST(RayOffset, StaysSmallAgainstTheTriangle) {
  const glm::vec3 error = triangle_point_error({1, 2, 3}, {-4, 1, 0}, {0, 0, 0});
  const glm::vec3 moved = offset_from_surface({1, 1, 1}, error, {0, 1, 0}, {0, 1, 0});
  EXPECT_GT(moved.y, 1.0F);
  EXPECT_LT(moved.y, 1.0F + 4e-6F);
  EXPECT_LT(offset_from_surface({1, 1, 1}, error, {0, 1, 0}, {0, -1, 0}).y, 1.0F);
}

TEST(RayOffset, PlaneThroughTheOriginIsLeft) {
  // All coordinates across the plane are exactly 0: a bound of their own error alone would be 0.
  test::SceneBuilder builder;
  builder.add_quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0},
                   builder.add_material(test::lambert(glm::vec3(0.5F))));
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  Hit hit;
  ASSERT_TRUE(rays.intersect({{3, 1, 2}, {-3, -1, -2}}, hit));
  EXPECT_FALSE(rays.is_occluded(segment_to(hit, glm::vec3(1, 2, -1))));
  EXPECT_FALSE(rays.is_occluded(segment_to(hit, glm::vec3(1, -2, -1))))
      << "a ray to below starts below";
}

TEST(RayScene, BvhBuiltByAnyNumberOfThreadsFindsTheSameTriangles) {
  test::SceneBuilder builder;
  const int segments = 128;
  builder.add_sphere({0, 0, 0}, 1.0F, segments,
                     builder.add_material(test::lambert(glm::vec3(0.5F))));
  std::vector<std::vector<std::uint32_t>> found;
  for (const int threads : {1, 2}) {
    const base::ThreadLimit limit(threads);
    StageTimer timer;
    const RayScene rays(builder.scene, timer);
    std::vector<std::uint32_t> triangles;
    // Straight at the vertices, where several triangles tie.
    for (const glm::vec3& target : builder.scene.objects[0].mesh->positions) {
      Hit hit;
      const bool is_hit = rays.intersect({4.0F * target, -target}, hit);
      triangles.push_back(is_hit ? hit.triangle : ~0U);
    }
    found.push_back(triangles);
  }
  EXPECT_EQ(found[0], found[1]);
}

TEST(CameraRays, AreThoseOfTheScene) {
  const scene::Camera camera{{1, 2, 3}, {-4, 0, 1}, {0.1F, 1, 0}, 50.0F};
  const CameraRays rays(camera, 40, 30);
  for (const auto& [x, y] :
       std::vector<std::pair<float, float>>{{0, 0}, {40, 30}, {13.5F, 7.25F}}) {
    const glm::vec3 expected = scene::camera_ray_direction(camera, 40, 30, x, y);
    EXPECT_NEAR(glm::distance(rays.through(x, y).direction, expected), 0.0F, 1e-6F);
  }
}

TEST(RayScene, PacketsAgreeWithSingleRays) {
  test::SceneBuilder builder;
  const int material = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_sphere({0, 0, 0}, 1.0F, 24, material);
  builder.add_quad({-3, -2, -3}, {0, 0, 6}, {6, 0, 0}, material);
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  std::size_t occluded = 0;
  std::size_t total = 0;
  for (std::uint32_t packet = 0; packet < 200; ++packet) {
    std::array<Ray, kPacketRays> bundle;
    const std::size_t size = 1 + packet % kPacketRays;
    for (std::uint32_t i = 0; i < size; ++i) {
      const glm::vec4 u = SampleSequence(SequenceKind::sobol, packet, i).next();
      bundle[i].origin = {0.2F * u.w, 2, -1};
      bundle[i].direction = {4 * u.x - 2, -2.5F * u.y, 4 * u.z - 2};
      if (i % 3 == 0) bundle[i].t_max = 0.5F;
    }
    const std::uint32_t mask = rays.occluded_mask({bundle.data(), size});
    std::array<LineHit, kPacketRays> nearest;
    EXPECT_EQ(rays.nearest({bundle.data(), size}, nearest), mask);
    for (std::size_t i = 0; i < size; ++i) {
      const bool is_occluded = rays.is_occluded(bundle[i]);
      EXPECT_EQ(((mask >> i) & 1U) != 0, is_occluded);
      LineHit alone;
      EXPECT_EQ(rays.nearest(bundle[i], alone), is_occluded);
      if (is_occluded) {
        EXPECT_EQ(nearest[i].ray, i);
        EXPECT_NEAR(nearest[i].t, alone.t, 1e-5F);
        EXPECT_EQ(nearest[i].looks_back, alone.looks_back);
        const Hit hit = rays.hit_at(nearest[i]);
        EXPECT_NEAR(glm::distance(hit.position, bundle[i].origin + alone.t * bundle[i].direction),
                    0.0F, 1e-5F);
      }
      occluded += is_occluded ? 1 : 0;
      total += 1;
    }
    EXPECT_EQ(mask >> size, 0U);
  }
  EXPECT_GT(occluded, total / 10);
  EXPECT_LT(occluded, total - total / 10);
  EXPECT_EQ(rays.occluded_mask({}), 0U);
}

}  // namespace
}  // namespace renderers::ray_tracing
