#include <algorithm>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/expect_error.h"
#include "tests/renderers/gpu_tracing/random_triangles.h"
#include "tests/renderers/gpu_tracing/walk_bench.h"
#include "tests/renderers/opengl/platform_test.h"

/// Walks on the device against every triangle by itself, and against Embree.
namespace renderers::test {
namespace {

using gpu_tracing::build_bvh;
using gpu_tracing::BvhTriangle;
using gpu_tracing::TriangleBvh;
using ray_tracing::Ray;

/// Rays that may graze an edge of 20,000: one, as a share of 1e-5 is less than that.
constexpr std::size_t kMostDiffering = 1;
constexpr float kEndless = std::numeric_limits<float>::infinity();

class BvhWalkGlTest : public opengl::PlatformTest {};
INSTANTIATE_TEST_SUITE_P(Platforms, BvhWalkGlTest, opengl::all_platforms(), opengl::platform_label);

/// The hierarchy changes nothing, to the bit; any is the same as more than none.
/// @return rays that meet something
std::size_t expect_same_as_all(const std::shared_ptr<opengl::Context>& context,
                               const std::vector<BvhTriangle>& triangles,
                               const std::vector<Ray>& rays) {
  WalkBench bench(context, build_bvh(triangles));
  const auto walked = bench.walk(rays);
  const auto truth = bench.try_all(rays);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(walked[i].hits, truth[i].hits) << i;
    if (truth[i].hits <= 64) {
      EXPECT_EQ(walked[i].triangles, truth[i].triangles) << i;
    }
    EXPECT_EQ(walked[i].is_occluded, truth[i].hits > 0) << i;
    if (truth[i].hits > 0) ++hits;
  }
  return hits;
}

TEST_P(BvhWalkGlTest, MeetsWhatRaysMeetAmongRandomTriangles) {
  for (const std::size_t count : {1U, 7U, 300U}) {
    for (const float size : {0.05F, 0.7F}) {
      const auto rays = random_rays(1000, 11);
      const std::size_t hits = expect_same_as_all(context_, random_triangles(count, size, 2), rays);
      if (count == 300) {
        EXPECT_GT(hits, 10U);
        EXPECT_LT(hits, 1000U);
      }
    }
  }
}

/// Along axes, from planes of boxes, in planes of triangles, through edges and corners.
TEST_P(BvhWalkGlTest, MeetsWhatRaysMeetAlongAxesAndPlanes) {
  std::vector<BvhTriangle> triangles;
  for (int x = -3; x < 3; ++x) {
    for (int y = -3; y < 3; ++y) {
      const glm::vec3 corner(x, y, 0.25F * static_cast<float>((x + 3) % 3));
      const auto index = static_cast<std::uint32_t>(triangles.size());
      triangles.push_back(
          {corner, 0, corner + glm::vec3(1, 0, 0), index, corner + glm::vec3(1, 1, 0), 0});
      triangles.push_back(
          {corner, 0, corner + glm::vec3(1, 1, 0), index + 1, corner + glm::vec3(0, 1, 0), 0});
    }
  }
  std::vector<Ray> rays;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) {
      for (int i = -7; i <= 7; ++i) {
        for (int j = -7; j <= 7; ++j) {
          glm::vec3 origin(0.0F);
          origin[axis] = -5.0F * sign;
          origin[(axis + 1) % 3] = 0.5F * static_cast<float>(i);
          origin[(axis + 2) % 3] = 0.25F * static_cast<float>(j);
          glm::vec3 direction(0.0F);
          direction[axis] = sign;
          rays.push_back({origin, direction, kEndless});
          direction[(axis + 1) % 3] = -0.0F;
          origin[axis] = 0.0F;
          rays.push_back({origin, direction, 1.0F});
        }
      }
    }
  }
  const std::size_t hits = expect_same_as_all(context_, triangles, rays);
  // A lattice across z, seen along z: a closed surface of 6 x 6 squares, borders included.
  EXPECT_GE(hits, 2U * 13U * 13U / 2U);
}

/// No ray along a normal slips between the triangles of a closed surface, edges and corners hit
/// exactly; the control leaves one triangle out.
TEST_P(BvhWalkGlTest, NoRaySlipsThroughEdges) {
  auto lattice = [](bool has_hole) {
    std::vector<BvhTriangle> triangles;
    for (int x = 0; x < 8; ++x) {
      for (int y = 0; y < 8; ++y) {
        const auto at = [&](int dx, int dy) {
          const auto u = static_cast<float>(x + dx) * 0.1F;
          const auto v = static_cast<float>(y + dy) * 0.1F;
          return glm::vec3(u, v, 0.3F * u * v);
        };
        const auto index = static_cast<std::uint32_t>(triangles.size());
        triangles.push_back({at(0, 0), 0, at(1, 0), index, at(1, 1), 0});
        if (has_hole && x == 4 && y == 4) continue;
        triangles.push_back({at(0, 0), 0, at(1, 1), index + 1, at(0, 1), 0});
      }
    }
    return triangles;
  };
  std::vector<Ray> rays;
  for (int i = 1; i < 64; ++i) {
    for (int j = 1; j < 64; ++j) {
      const glm::vec3 at(0.0125F * static_cast<float>(i), 0.0125F * static_cast<float>(j), 0.0F);
      const glm::vec3 from(0.37F, 0.41F, 2.0F);
      rays.push_back({from, glm::vec3(at.x, at.y, 0.3F * at.x * at.y) - from, kEndless});
    }
  }
  const std::size_t hits = expect_same_as_all(context_, lattice(false), rays);
  EXPECT_EQ(hits, rays.size());
  EXPECT_LT(expect_same_as_all(context_, lattice(true), rays), rays.size());
}

/// Points, lines, needles: nothing is met twice or lost beside them, nor is anything not a number.
TEST_P(BvhWalkGlTest, DegenerateTrianglesHideNothing) {
  auto triangles = random_triangles(60, 0.5F, 9);
  for (std::size_t i = 0; i < triangles.size(); i += 2) {
    triangles[i].c = i % 4 == 0 ? triangles[i].b : 0.5F * (triangles[i].a + triangles[i].b);
  }
  std::vector<Ray> rays = random_rays(600, 4);
  for (const BvhTriangle& triangle : triangles) {  // right at them
    const glm::vec3 from(0.3F, -2.0F, 0.2F);
    rays.push_back({from, triangle.b - from, kEndless});
  }
  expect_same_as_all(context_, triangles, rays);
  WalkBench bench(context_, build_bvh({triangles[0], triangles[4]}));  // two points, as it were
  for (const Walked& walked : bench.walk(rays)) EXPECT_FALSE(walked.is_occluded);
}

TEST_P(BvhWalkGlTest, NothingIsMetInAnEmptyScene) {
  WalkBench bench(context_, TriangleBvh{});
  for (const Walked& walked : bench.walk(random_rays(100, 1))) {
    EXPECT_FALSE(walked.is_occluded);
    EXPECT_EQ(walked.hits, 0U);
  }
}

/// Any hits and all hits as Embree finds them; differences are roundings at edges.
TEST_P(BvhWalkGlTest, AgreesWithEmbree) {
  const auto triangles = random_triangles(4000, 0.15F, 21);
  const scene::Scene scene = scene_of(triangles);
  StageTimer timer;
  const ray_tracing::RayScene embree(scene, timer, ray_tracing::RayQueries::all_hits);
  WalkBench bench(context_, build_bvh(embree));
  const auto rays = random_rays(20'000, 8);
  const auto walked = bench.walk(rays);
  std::size_t occluded = 0;
  std::size_t differing = 0;
  std::size_t differing_any = 0;
  std::string list;  // of the latter
  for (std::size_t i = 0; i < rays.size(); ++i) {
    std::vector<ray_tracing::LineHit> hits;
    embree.all_hits(std::span(rays).subspan(i, 1), hits);
    std::vector<std::uint32_t> expected;
    for (const auto& hit : hits) expected.push_back(hit.triangle);
    std::ranges::sort(expected);
    const auto rest = std::ranges::unique(expected);
    expected.erase(rest.begin(), rest.end());
    if (expected != walked[i].triangles) ++differing;
    if (walked[i].is_occluded != embree.is_occluded(rays[i])) {
      ++differing_any;
      list += " " + std::to_string(i);
    }
    if (walked[i].is_occluded) ++occluded;
  }
  EXPECT_LE(differing, 2U);
  EXPECT_LE(differing_any, kMostDiffering) << list;
  EXPECT_GT(occluded, rays.size() / 10);
  EXPECT_LT(occluded, rays.size());
}

TEST_P(BvhWalkGlTest, RefusesWhatNoStorageBlockHolds) {
  TriangleBvh bvh;
  const auto limit = static_cast<std::size_t>(context_->limits().storage_block_bytes);
  if (limit > (std::size_t{1} << 28)) GTEST_SKIP() << "this device's blocks are large";
  bvh.nodes.resize(limit / sizeof(gpu_tracing::BvhNode) + 1);
  bvh.triangles.resize(3);
  StageTimer timer;
  gpu_tracing::GpuBvh gpu(context_);
  tests::expect_error<UnsupportedError>([&] { gpu.load(bvh, timer); },
                                        "tracing 3 triangles takes a buffer of " +
                                            std::to_string(limit + 32) + " bytes; " +
                                            context_->facts().renderer + " allows " +
                                            std::to_string(limit) + "; Embree has no such limit");
}

}  // namespace
}  // namespace renderers::test
