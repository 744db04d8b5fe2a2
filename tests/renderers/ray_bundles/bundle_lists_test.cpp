#include "renderers/ray_bundles/bundle_lists.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "renderers/ray_bundles/bundle_raster.h"
#include "renderers/texel_atlas/world_triangles.h"
#include "tests/renderers/ray_bundles/bundle_fixture.h"

namespace renderers::ray_bundles {
namespace {

using test::BundleScene;
using test::SceneBuilder;

SceneBuilder closed_scene() {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_box(glm::vec3(-1.0F), {1.0F, 1.2F, 1.0F}, wall, true);
  builder.add_box({-0.6F, -0.9F, -0.5F}, {0.1F, -0.2F, 0.3F}, wall, false);
  builder.add_sphere({0.4F, 0.3F, 0.2F}, 0.45F, 12, wall);
  return builder;
}

/// What roundings of the frame's axes make of the depth on surfaces nearly along the direction.
constexpr double kDepth_m = 1e-4;

/// A crossing found by double-precision arithmetic.
struct TrueCrossing {
  double depth_m = 0.0;
  std::size_t triangle = 0;
  bool looks_back = false;
  double margin = 0.0;  ///< least barycentric weight: how far from an edge
};

/// Moeller and Trumbore 1997, "Fast, Minimum Storage Ray-Triangle Intersection",
/// doi:10.1080/10867651.1997.10487468, in double precision.
std::vector<TrueCrossing> true_crossings(const texel_atlas::WorldTriangles& world,
                                         const ray_tracing::Ray& ray, double& least_margin) {
  std::vector<TrueCrossing> found;
  const glm::dvec3 origin(ray.origin);
  const glm::dvec3 direction(ray.direction);
  for (std::size_t i = 0; i < world.triangles.size(); ++i) {
    const auto& c = world.triangles[i].corners;
    const glm::dvec3 e1 = c[1] - c[0];
    const glm::dvec3 e2 = c[2] - c[0];
    const glm::dvec3 p = glm::cross(direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0.0) continue;
    const glm::dvec3 s = (origin - c[0]) / determinant;
    const double u = glm::dot(s, p);
    const double v = glm::dot(glm::cross(s, e1), direction);
    const double margin = std::min({u, v, 1.0 - u - v});
    if (std::fabs(margin) < std::fabs(least_margin)) least_margin = margin;
    if (margin < 0.0) continue;
    found.push_back({glm::dot(glm::cross(s, e1), e2), i,
                     glm::dot(world.triangles[i].scaled_normal(), direction) < 0.0, margin});
  }
  std::sort(found.begin(), found.end(),
            [](const TrueCrossing& a, const TrueCrossing& b) { return a.depth_m < b.depth_m; });
  return found;
}

struct Comparison {
  std::size_t lines = 0;
  std::size_t different = 0;
  std::size_t odd = 0;  ///< lines with an odd number of crossings: none in a closed scene
};

Comparison compare(BundleScene& built, const BundleFrame& frame, const BundleLists& lists) {
  const texel_atlas::WorldTriangles world = texel_atlas::world_triangles(built.rays.scene());
  Comparison result;
  for (int y = 0; y < frame.height_px; ++y) {
    for (int x = 0; x < frame.width_px; ++x) {
      double margin = 1.0;
      const auto truth = true_crossings(world, frame.line(x, y), margin);
      const auto line = lists.line(x, y);
      ++result.lines;
      result.odd += line.size() % 2;
      bool is_same = line.size() == truth.size();
      for (std::size_t i = 0; is_same && i < line.size(); ++i) {
        const auto& triangle = world.triangles[truth[i].triangle];
        const auto& texel = built.atlas.texels()[texel_of(line[i])];
        is_same = std::fabs(static_cast<double>(line[i].depth_m) - truth[i].depth_m) < kDepth_m &&
                  ((line[i].near_side & 1U) == 0) == truth[i].looks_back &&
                  texel.point.object == triangle.object &&
                  texel.chart == built.atlas.chart_of(triangle.object, triangle.triangle);
      }
      result.different += is_same ? 0 : 1;
    }
  }
  return result;
}

constexpr SlotSettings kFewSlots{3, true};

/// Lists of a frame, by any builder.
BundleLists lists_of(BundleScene& built, const BundleFrame& frame, ListKind kind) {
  BundleLists lists;
  if (kind == ListKind::trace) {
    trace_lists(built.rays, built.atlas, frame, lists);
    return lists;
  }
  BundleRaster raster(texel_atlas::world_triangles(built.rays.scene()), built.atlas);
  if (kind == ListKind::raster) {
    raster.fill(frame, lists);
  } else {
    raster.fill_slots(frame, kFewSlots, lists);
  }
  return lists;
}

constexpr ListKind kBuilders[] = {ListKind::raster, ListKind::trace};

class BundleListsOf : public testing::TestWithParam<ListKind> {};
INSTANTIATE_TEST_SUITE_P(Builders, BundleListsOf, testing::ValuesIn(kBuilders));

TEST_P(BundleListsOf, AreThoseOfBruteForce) {
  const SceneBuilder builder = closed_scene();
  BundleScene built(builder.scene);
  DirectionSet set(DirectionKind::halton, 3, 8);
  Comparison sum;
  for (std::int64_t i = 0; i < 8; ++i) {
    const BundleFrame frame(built.box, set.at(i), 96);
    const BundleLists lists = lists_of(built, frame, GetParam());
    const Comparison one = compare(built, frame, lists);
    sum.lines += one.lines;
    sum.different += one.different;
    sum.odd += one.odd;
  }
  EXPECT_GT(sum.lines, 20'000U);
  EXPECT_LE(sum.different, sum.lines / 10'000);
  EXPECT_LE(sum.odd, sum.lines / 10'000);
}

/// Eight sheets, one behind the other and drawn from the nearest on, each over all lines.
SceneBuilder eight_sheets() {
  SceneBuilder builder;
  const int white = builder.add_material(test::lambert(glm::vec3(0.5F)));
  for (int i = 0; i < 8; ++i) {
    const float z = 0.1F * static_cast<float>(i);
    builder.add_quad({-1.0F, -1.0F, z}, {2.0F, 0.0F, 0.0F}, {0.0F, 2.0F, 0.0F}, white);
  }
  return builder;
}

/// Hermes et al. 2010, Sec. 4.2: as many passes as it takes k slots to hold the deepest line; the
/// fragments drawn last are those that a single pass drops, not the farthest ones.
TEST(BundleSlots, HoldWhatIsDrawnFirst) {
  const SceneBuilder builder = eight_sheets();
  BundleScene built(builder.scene);
  const BundleDirection along{{0.0F, 0.0F, 1.0F}, 0.0F, glm::vec2(0.5F)};
  const BundleDirection against{{0.0F, 0.0F, -1.0F}, 0.0F, glm::vec2(0.5F)};
  BundleRaster raster(texel_atlas::world_triangles(built.rays.scene()), built.atlas);
  BundleLists lists;
  for (const BundleDirection& direction : {along, against}) {
    const BundleFrame frame(built.box, direction, 32);
    raster.fill(frame, lists);
    const std::size_t all = lists.node_count();
    ASSERT_GT(all, 0U);
    for (const int k : {1, 3, 4, 8, 9}) {
      const SlotCounts complete = raster.fill_slots(frame, {k, true}, lists);
      EXPECT_EQ(complete.passes, static_cast<std::uint64_t>((8 + k - 1) / k)) << k;
      EXPECT_EQ(complete.dropped, 0U);
      EXPECT_EQ(lists.node_count(), all);

      const SlotCounts one = raster.fill_slots(frame, {k, false}, lists);
      EXPECT_EQ(one.passes, 1U);
      EXPECT_EQ(one.dropped + lists.node_count(), all) << k;
      EXPECT_EQ(one.dropped, all / 8 * static_cast<std::size_t>(std::max(0, 8 - k))) << k;
      // The sheets drawn first stay: the nearest ones along the direction, the farthest against it.
      const auto line = lists.line(frame.width_px / 2, frame.height_px / 2);
      ASSERT_EQ(line.size(), static_cast<std::size_t>(std::min(k, 8)));
      const auto& first = built.atlas.texels()[texel_of(line.front())].point.position;
      const auto& last = built.atlas.texels()[texel_of(line.back())].point.position;
      EXPECT_NEAR(std::min(first.z, last.z), 0.0F, 1e-6F);
      EXPECT_NEAR(std::max(first.z, last.z), 0.1F * static_cast<float>(std::min(k, 8) - 1), 1e-6F);
    }
  }
}

TEST(BundleSlots, GiveTheSameListsToTheBit) {
  const SceneBuilder builder = closed_scene();
  BundleScene built(builder.scene);
  DirectionSet set(DirectionKind::iid, 7, 0);
  for (std::int64_t i = 0; i < 3; ++i) {
    const BundleFrame frame(built.box, set.at(i), 64);
    const BundleLists counted = lists_of(built, frame, ListKind::raster);
    const BundleLists slots = lists_of(built, frame, ListKind::fixed_k);
    for (int y = 0; y < frame.height_px; ++y) {
      for (int x = 0; x < frame.width_px; ++x) {
        const auto a = counted.line(x, y);
        const auto b = slots.line(x, y);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t n = 0; n < a.size(); ++n) {
          ASSERT_EQ(a[n].depth_m, b[n].depth_m);
          ASSERT_EQ(a[n].near_side, b[n].near_side);
        }
      }
    }
  }
}

/// Many triangles smaller than a pixel, some mirrored: each builder against the other.
TEST(BundleLists, BuildersAgreeOnFineMeshes) {
  SceneBuilder builder = closed_scene();
  const int ball = builder.add_sphere({0.3F, 0.2F, -0.3F}, 0.5F, 120, 0);
  builder.scene.objects[static_cast<std::size_t>(ball)].to_world[0][0] = -0.8F;
  BundleScene built(builder.scene, 512);
  DirectionSet set(DirectionKind::iid, 4, 0);
  std::size_t lines = 0;
  std::size_t different = 0;
  for (std::int64_t i = 0; i < 4; ++i) {
    const BundleFrame frame(built.box, set.at(i), 200);
    const BundleLists drawn = lists_of(built, frame, ListKind::raster);
    const BundleLists traced = lists_of(built, frame, ListKind::trace);
    for (int y = 0; y < frame.height_px; ++y) {
      for (int x = 0; x < frame.width_px; ++x) {
        const auto a = drawn.line(x, y);
        const auto b = traced.line(x, y);
        bool is_same = a.size() == b.size();
        for (std::size_t n = 0; is_same && n < a.size(); ++n) {
          is_same = std::fabs(a[n].depth_m - b[n].depth_m) < 1e-4F &&
                    ((a[n].near_side ^ b[n].near_side) & 1U) == 0;
        }
        different += is_same ? 0 : 1;
        ++lines;
      }
    }
  }
  EXPECT_LE(different, lines / 2000);
}

/// Lists never cross tiles: those of a raster cut into tiles are the whole one's, whoever makes
/// them.
TEST(BundleLists, TilesHaveTheListsOfTheWhole) {
  const SceneBuilder builder = closed_scene();
  BundleScene built(builder.scene);
  // Upright, its pixels powers of two, so that no place is rounded.
  BundleFrame whole(built.box, {{0.0F, 0.0F, 1.0F}, 0.0F, glm::vec2(0.0F)}, 64);
  whole.axis_x = {1.0F, 0.0F, 0.0F};
  whole.axis_y = {0.0F, 1.0F, 0.0F};
  whole.direction = {0.0F, 0.0F, 1.0F};
  whole.corner = {-2.0F, -2.0F, -4.0F};
  whole.pixel_m = 1.0F / 32.0F;
  whole.sphere_radius_m = 4.0F;
  whole.width_px = whole.height_px = 128;
  constexpr int kTile_px = 41;
  for (const ListKind kind : {ListKind::raster, ListKind::fixed_k, ListKind::trace}) {
    const BundleLists lists = lists_of(built, whole, kind);
    EXPECT_GT(lists.node_count(), 1000U);
    for (int top = 0; top < whole.height_px; top += kTile_px) {
      for (int left = 0; left < whole.width_px; left += kTile_px) {
        BundleFrame tile = whole;
        tile.corner += whole.pixel_m * glm::vec3(left, top, 0);
        tile.width_px = std::min(kTile_px, whole.width_px - left);
        tile.height_px = std::min(kTile_px, whole.height_px - top);
        const BundleLists part = lists_of(built, tile, kind);
        for (int y = 0; y < tile.height_px; ++y) {
          for (int x = 0; x < tile.width_px; ++x) {
            const auto expected = lists.line(left + x, top + y);
            const auto found = part.line(x, y);
            ASSERT_EQ(found.size(), expected.size()) << static_cast<int>(kind);
            for (std::size_t n = 0; n < found.size(); ++n) {
              ASSERT_EQ(found[n].near_side, expected[n].near_side);
              ASSERT_NEAR(found[n].depth_m, expected[n].depth_m, 1e-5F);
            }
          }
        }
      }
    }
  }
}

TEST(BundleLists, TheOracleNoticesAWrongSideAndAMissingCrossing) {
  const SceneBuilder builder = closed_scene();
  BundleScene built(builder.scene);
  const BundleFrame frame(built.box, DirectionSet(DirectionKind::halton, 3, 8).at(1), 48);
  BundleLists lists;
  trace_lists(built.rays, built.atlas, frame, lists);
  for (std::size_t band = 0; band < lists.band_count(); ++band) {
    for (ListNode& node : lists.band(band).nodes) node.near_side ^= 1U;
  }
  EXPECT_GT(compare(built, frame, lists).different, 500U);
}

TEST(BundleLists, FramesCoverTheScene) {
  const SceneBuilder builder = closed_scene();
  BundleScene built(builder.scene);
  DirectionSet set(DirectionKind::iid, 3, 0);
  BundleLists lists;
  for (std::int64_t i = 0; i < 20; ++i) {
    const BundleFrame frame(built.box, set.at(i), 64);
    EXPECT_NEAR(glm::dot(glm::cross(frame.axis_x, frame.axis_y), frame.direction), 1.0F, 1e-5F);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 point((corner & 1) ? built.box.least.x : built.box.greatest.x,
                            (corner & 2) ? built.box.least.y : built.box.greatest.y,
                            (corner & 4) ? built.box.least.z : built.box.greatest.z);
      const BundlePoint place = frame.project(point);
      EXPECT_GE(place.place_px.x, -1e-3F);
      EXPECT_GE(place.place_px.y, -1e-3F);
      EXPECT_LE(place.place_px.x, static_cast<float>(frame.width_px));
      EXPECT_LE(place.place_px.y, static_cast<float>(frame.height_px));
      EXPECT_GT(place.depth_m, 0.0F);
      EXPECT_LT(place.depth_m, 2.0F * frame.sphere_radius_m);
    }
    // Closed walls: the area of the lines that meet something is the projected area.
    trace_lists(built.rays, built.atlas, frame, lists);
    double hit_m2 = 0.0;
    for (int y = 0; y < frame.height_px; ++y) {
      for (int x = 0; x < frame.width_px; ++x) {
        if (!lists.line(x, y).empty()) hit_m2 += static_cast<double>(frame.pixel_area_m2());
      }
    }
    const glm::vec3 d = glm::abs(frame.direction);
    const double area_m2 = static_cast<double>(d.x * 2.0F * 2.2F + d.y * 4.0F + d.z * 2.0F * 2.2F);
    EXPECT_NEAR(hit_m2, area_m2, 0.02 * area_m2);
  }
}

/// Texels 0 and 1 back to back, of objects 0 and 1; 2 and 3 of object 2, at an angle.
std::vector<texel_atlas::Texel> some_texels() {
  std::vector<texel_atlas::Texel> texels(300);
  texels[0].point.geometric_normal = {0, 1, 0};
  texels[1].point.geometric_normal = {0, -1, 0};
  texels[1].point.object = 1;
  texels[2].point.geometric_normal = {1, 0, 0};
  texels[2].point.object = 2;
  texels[3].point.geometric_normal = {0, 1, 0};
  texels[3].point.object = 2;
  return texels;
}

constexpr float kTie_m = 1e-5F;

std::vector<std::uint32_t> ordered(std::vector<ListNode> nodes) {
  nodes.resize(order_nodes(nodes, kTie_m, some_texels()));
  std::vector<std::uint32_t> sides;
  for (const ListNode& node : nodes) sides.push_back(node.near_side);
  return sides;
}

using Sides = std::vector<std::uint32_t>;

TEST(OrderNodes, SortsShortAndLongLists) {
  for (const std::size_t count : {0U, 1U, 7U, 300U}) {
    std::vector<ListNode> nodes;
    for (std::size_t i = 0; i < count; ++i) {
      const float depth_m = static_cast<float>((i * 7919) % count) + 1.0F;
      nodes.push_back({depth_m, static_cast<std::uint32_t>(2 * i)});
    }
    ASSERT_EQ(order_nodes(nodes, kTie_m, some_texels()), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(nodes[i].depth_m, static_cast<float>(i) + 1.0F);
    }
  }
}

TEST(OrderNodes, PutsTheSideOfASheetThatLooksBackFirst) {
  // Rounding has put the one that looks on in front.
  EXPECT_EQ(ordered({{1.0F, 1}, {1.0000001F, 2}}), (Sides{2, 1}));
  EXPECT_EQ(ordered({{1.0000001F, 1}, {1.0F, 2}}), (Sides{2, 1}));
  EXPECT_EQ(ordered({{1.0F, 1}, {1.1F, 2}}), (Sides{1, 2})) << "apart, depth decides";
  EXPECT_EQ(ordered({{1.0F, 5}, {1.0000001F, 6}}), (Sides{5, 6})) << "a corner is no sheet";
}

TEST(OrderNodes, MergesTheTwoTrianglesOfAnEdge) {
  EXPECT_EQ(ordered({{1.0F, 4}, {1.0000001F, 6}, {2.0F, 5}}), (Sides{4, 5}));
  EXPECT_EQ(ordered({{1.0F, 0}, {1.0000001F, 6}}), (Sides{0, 6})) << "two objects, two surfaces";
  EXPECT_EQ(ordered({{1.0F, 4}, {1.1F, 6}}), (Sides{4, 6}));
}

}  // namespace
}  // namespace renderers::ray_bundles
