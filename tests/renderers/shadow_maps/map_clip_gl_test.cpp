// Clip heights of maps (MapOrigins): surfaces less high above the centre are not seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

#include "renderers/shadow_maps/hemisphere_projection.h"
#include "tests/renderers/scene_builder.h"
#include "tests/renderers/shadow_maps/map_bench.h"

namespace renderers::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kSize_px = 48;
constexpr double kHalfWidth_m = 6.0;

/// A square over |x|, |y| <= kHalfWidth_m: z = height + slope x.
struct Plane {
  double height_m = 0.0;
  double slope = 0.0;
  bool faces_center = false;  ///< else it turns its back to it
};

scene::Scene scene_of(const std::vector<Plane>& planes) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  constexpr auto kHalf = static_cast<float>(kHalfWidth_m);
  for (const Plane& plane : planes) {
    const auto rise = static_cast<float>(plane.slope) * kHalf;
    const glm::vec3 corner(-kHalf, -kHalf, static_cast<float>(plane.height_m) - rise);
    const glm::vec3 along(2.0F * kHalf, 0, 2.0F * rise);
    const glm::vec3 across(0, 2.0F * kHalf, 0);
    builder.add_quad(corner, plane.faces_center ? across : along,
                     plane.faces_center ? along : across, white);
  }
  return builder.scene;
}

/// Distance along a unit direction to the nearest plane that is not clipped; NaN where rounding
/// may decide. @param height_m  as origins have it: below 0 only backs are clipped
double expected_distance(const std::vector<Plane>& planes, double center_m, double height_m,
                         const glm::dvec3& direction) {
  constexpr double kMargin_m = 1e-4;
  double nearest_m = kInfinity;
  for (const Plane& plane : planes) {
    const double clip_m = height_m < 0.0 && plane.faces_center ? 0.0 : std::fabs(height_m);
    const double facing = direction.z - plane.slope * direction.x;
    const double distance_m = (plane.height_m - center_m) / facing;
    if (!(distance_m > 0.0)) continue;
    const glm::dvec3 hit = distance_m * direction;
    const double outside_m = std::max(std::fabs(hit.x), std::fabs(hit.y)) - kHalfWidth_m;
    if (outside_m > kMargin_m || hit.z < clip_m - kMargin_m) continue;
    if (std::fabs(outside_m) <= kMargin_m || std::fabs(hit.z - clip_m) <= kMargin_m) return NAN;
    nearest_m = std::fmin(nearest_m, distance_m);
  }
  return nearest_m;
}

/// Origins at the scene's origin, looking along z, of these clip heights.
std::vector<Origin> origins_of(const std::vector<float>& clips_m) {
  std::vector<Origin> origins;
  for (const float clip_m : clips_m) {
    origins.push_back(origin_at(glm::vec3(0.0F), {0, 0, 1}));
    origins.back().axis.w = clip_m;
  }
  return origins;
}

/// Texels that differ from the closed form for another clip height than the map's, as a share.
double wrong_share(const std::vector<Plane>& planes, const shadow_maps::HemisphereMaps& maps,
                   int layer, double clip_m) {
  const auto distances = distances_of(maps, layer);
  int wrong = 0;
  int decided = 0;
  for (int y = 0; y < kSize_px; ++y) {
    for (int x = 0; x < kSize_px; ++x) {
      if (!shadow_maps::hemisphere_texel_is_used({x, y}, kSize_px)) continue;
      const glm::dvec3 direction = shadow_maps::hemisphere_direction(
          shadow_maps::hemisphere_texel_position({x, y}, kSize_px));
      const double expected =
          expected_distance(planes, static_cast<double>(maps.near_m()), clip_m, direction);
      if (std::isnan(expected)) continue;
      const double found =
          static_cast<double>(distances[static_cast<std::size_t>(y * kSize_px + x)]);
      ++decided;
      const bool is_same =
          std::isinf(expected) ? found == expected : std::fabs(found - expected) <= 1e-4 * expected;
      if (!is_same) ++wrong;
    }
  }
  EXPECT_GT(decided, kSize_px * kSize_px / 2);
  return static_cast<double>(wrong) / decided;
}

TEST(MapClip, APlaneIsDroppedIfAndOnlyIfItIsLower) {
  const std::vector<Plane> planes{{1.0}, {3.0}};
  const std::vector<float> clips_m{0.0F, 0.5F, 0.997F, 1.001F, 2.997F, 3.001F};
  const MapBench bench(scene_of(planes));
  const auto origins = origins_of(clips_m);
  const auto maps = bench.hard_maps(kSize_px, origins);
  for (std::size_t i = 0; i < clips_m.size(); ++i) {
    EXPECT_EQ(wrong_share(planes, maps, static_cast<int>(i), static_cast<double>(clips_m[i])), 0.0)
        << "clip height " << clips_m[i];
  }
  // The test can fail: the other side of either plane's height shows.
  EXPECT_GT(wrong_share(planes, maps, 2, 1.001), 0.3);
  EXPECT_GT(wrong_share(planes, maps, 3, 0.997), 0.3);
  EXPECT_GT(wrong_share(planes, maps, 5, 2.997), 0.3);
}

TEST(MapClip, TheHeightOfTheSurfaceCountsNotThatOfItsTriangle) {
  const std::vector<Plane> planes{{1.0, 0.3}, {4.0, -0.2}};
  const std::vector<float> clips_m{0.0F, 0.4F, 1.0F, 2.0F, 3.5F};
  const MapBench bench(scene_of(planes));
  const auto maps = bench.hard_maps(kSize_px, origins_of(clips_m));
  for (std::size_t i = 0; i < clips_m.size(); ++i) {
    EXPECT_EQ(wrong_share(planes, maps, static_cast<int>(i), static_cast<double>(clips_m[i])), 0.0)
        << "clip height " << clips_m[i];
  }
  EXPECT_GT(wrong_share(planes, maps, 2, 0.0), 0.1);
  // The same however the work is split.
  const auto direct = bench.hard_maps(kSize_px, origins_of(clips_m), {.direct_texels = 1 << 20});
  EXPECT_TRUE(direct.distances().read_words() == maps.distances().read_words());
}

/// A low plane that faces the centre, another that does not, a high one of each.
const std::vector<Plane> kBothWays{
    {1.0, 0.0, true}, {1.4, 0.1, false}, {3.0, 0.1, true}, {3.6, 0.0, false}};

TEST(MapClip, BelowZeroItSparesWhatFacesTheCentre) {
  for (const std::size_t first : {0U, 1U}) {
    const std::vector<Plane> planes(kBothWays.begin() + static_cast<std::ptrdiff_t>(first),
                                    kBothWays.end());
    const std::vector<float> clips_m{-0.5F, -1.3F, -2.2F, -3.3F, -4.0F};
    const MapBench bench(scene_of(planes));
    const auto exact = bench.hard_maps(kSize_px, origins_of(clips_m));
    const auto hemicubes = bench.hemicube_maps(kSize_px, origins_of(clips_m));
    for (std::size_t i = 0; i < clips_m.size(); ++i) {
      const auto layer = static_cast<int>(i);
      const auto height_m = static_cast<double>(clips_m[i]);
      EXPECT_EQ(wrong_share(planes, exact, layer, height_m), 0.0) << first << " " << height_m;
      EXPECT_LT(wrong_share(planes, hemicubes, layer, height_m), 0.03) << first << " " << height_m;
    }
    // All that is so low, as a height above 0 would clip.
    EXPECT_GT(wrong_share(planes, exact, 4, 4.0), 0.3) << first;
  }
}

TEST(MapClip, HoldsInHemicubes) {
  const std::vector<std::vector<Plane>> scenes{{{1.0}, {3.0}}, {{1.0, 0.3}, {4.0, -0.2}}};
  const std::vector<float> clips_m{0.0F, 0.5F, 0.997F, 1.001F, 2.997F, 3.001F};
  for (const std::vector<Plane>& planes : scenes) {
    const MapBench bench(scene_of(planes));
    const auto maps = bench.hemicube_maps(kSize_px, origins_of(clips_m));
    for (std::size_t i = 0; i < clips_m.size(); ++i) {
      // Where a plane ends or is cut, the nearest pixel of the face decides.
      EXPECT_LT(wrong_share(planes, maps, static_cast<int>(i), static_cast<double>(clips_m[i])),
                0.03)
          << "clip height " << clips_m[i];
    }
    EXPECT_GT(wrong_share(planes, maps, 3, 0.5), 0.1);
  }
}

TEST(MapClip, HoldsInMapsDrawnByTheirVertices) {
  const std::vector<Plane> planes{{1.0}, {3.0}};
  const std::vector<float> clips_m{0.0F, 0.5F, 0.99F, 1.01F, 2.99F, 3.01F};
  const MapBench bench(scene_of(planes));
  const auto maps = bench.vertex_maps(kSize_px, origins_of(clips_m));
  for (std::size_t i = 0; i < clips_m.size(); ++i) {
    const auto layer = static_cast<int>(i);
    const float nearest_m = std::ranges::min(distances_of(maps, layer));
    const double expected = clips_m[i] < 1.0F ? 1.0 : clips_m[i] < 3.0F ? 3.0 : kInfinity;
    if (expected < kInfinity) {
      EXPECT_NEAR(nearest_m, expected, 0.02) << "clip height " << clips_m[i];
    } else {
      EXPECT_EQ(static_cast<double>(nearest_m), kInfinity);
    }
  }
}

TEST(MapClip, DropsSplattedPointsThatAreLower) {
  const MapBench bench(scene_of({{1.0}, {3.0}}));
  const auto maps = bench.imperfect_maps(kSize_px, origins_of({0.0F, 0.99F, 1.01F, 3.01F}));
  const auto nearest = [&](int layer) { return std::ranges::min(distances_of(maps, layer)); };
  EXPECT_NEAR(nearest(0), 1.0F, 0.05F);
  EXPECT_EQ(nearest(1), nearest(0));
  EXPECT_NEAR(nearest(2), 3.0F, 0.05F);
  EXPECT_EQ(static_cast<double>(nearest(3)), kInfinity);
}

}  // namespace
}  // namespace renderers::test
