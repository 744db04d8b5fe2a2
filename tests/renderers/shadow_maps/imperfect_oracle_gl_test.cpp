// Imperfect shadow maps texel by texel against the same rules in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

#include "renderers/shadow_maps/hemisphere_projection.h"
#include "renderers/shadow_maps/imperfect_maps.h"
#include "renderers/shadow_maps/scene_points.h"
#include "tests/renderers/scene_builder.h"
#include "tests/renderers/shadow_maps/map_bench.h"

namespace renderers::test {
namespace {

using shadow_maps::ImperfectMapSettings;
using shadow_maps::ScenePoint;
using shadow_maps::SplatShape;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kSize_px = 32;

/// One layer, row-major; infinity where it is empty.
struct Layer {
  int size_px = 0;
  std::vector<double> distances_m;
  double& at(int x, int y) {
    return distances_m[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_px) +
                       static_cast<std::size_t>(x)];
  }
};

Layer empty_layer(int size_px) {
  const auto side = static_cast<std::size_t>(size_px);
  return {size_px, std::vector<double>(side * side, kInfinity)};
}

/// Distance at which a point covers a texel, or infinity.
double splat_at(const glm::dvec3& position, const glm::dvec3& normal, double radius_m,
                const glm::ivec2& texel, bool is_own) {
  const glm::dvec3 ray =
      shadow_maps::hemisphere_direction(shadow_maps::hemisphere_texel_position(texel, kSize_px));
  const double facing = glm::dot(ray, normal);
  const double met_m = facing != 0.0 ? glm::dot(position, normal) / facing : -1.0;
  const bool is_met = met_m > 0.0 && glm::distance(met_m * ray, position) <= radius_m;
  if (!is_own && !is_met) return kInfinity;
  const double distance_m = glm::length(position);
  if (met_m <= 0.0) return distance_m;
  return std::clamp(met_m, std::max(distance_m - radius_m, 0.0), distance_m + radius_m);
}

void splat(const ScenePoint& point, const Origin& origin, double near_m,
           const ImperfectMapSettings& settings, Layer& layer) {
  const glm::dvec3 axis(origin.axis);
  const glm::dmat3 frame = shadow_maps::hemisphere_frame(axis);
  const glm::dvec3 center = glm::dvec3(origin.position) + near_m * axis;
  const glm::dvec3 position = (glm::dvec3(point.position) - center) * frame;
  if (position.z <= 0.0) return;
  const glm::dvec3 normal = glm::dvec3(point.normal) * frame;
  const double radius_m = static_cast<double>(settings.splat_scale * point.position.w);
  const double distance_m = glm::length(position);
  const double texel_rad =
      shadow_maps::hemisphere_texel_angle(position.z / distance_m, layer.size_px);
  const double half_px =
      std::min(std::atan2(radius_m, distance_m) / texel_rad, 0.5 * settings.max_splat_px);
  const glm::dvec2 at_px =
      (0.5 * shadow_maps::hemisphere_position(position) + 0.5) * static_cast<double>(kSize_px);
  const glm::ivec2 own =
      shadow_maps::hemisphere_texel(shadow_maps::hemisphere_position(position), layer.size_px);
  for (int y = 0; y < layer.size_px; ++y) {
    for (int x = 0; x < layer.size_px; ++x) {
      const bool is_own = own == glm::ivec2(x, y);
      const bool is_covered =
          std::fabs(x + 0.5 - at_px.x) <= half_px && std::fabs(y + 0.5 - at_px.y) <= half_px;
      if (!is_own && !is_covered) continue;
      const double splat_m = settings.splat_shape == SplatShape::square
                                 ? distance_m
                                 : splat_at(position, normal, radius_m, {x, y}, is_own);
      layer.at(x, y) = std::min(layer.at(x, y), splat_m);
    }
  }
}

/// Mean of those of four distances that are within a tenth of the nearest.
Layer pulled(Layer& finer) {
  Layer coarser = empty_layer(finer.size_px / 2);
  for (int y = 0; y < coarser.size_px; ++y) {
    for (int x = 0; x < coarser.size_px; ++x) {
      const double four[]{finer.at(2 * x, 2 * y), finer.at(2 * x + 1, 2 * y),
                          finer.at(2 * x, 2 * y + 1), finer.at(2 * x + 1, 2 * y + 1)};
      const double nearest_m = *std::ranges::min_element(four);
      if (nearest_m == kInfinity) continue;
      double sum_m = 0.0;
      int count = 0;
      for (const double distance_m : four) {
        if (distance_m > 1.1 * nearest_m) continue;
        sum_m += distance_m;
        ++count;
      }
      coarser.at(x, y) = sum_m / count;
    }
  }
  return coarser;
}

void fill_holes(Layer& layer, int levels) {
  if (levels == 0) return;
  Layer coarser = pulled(layer);
  fill_holes(coarser, levels - 1);
  for (int y = 0; y < layer.size_px; ++y) {
    for (int x = 0; x < layer.size_px; ++x) {
      double& distance_m = layer.at(x, y);
      if (distance_m == kInfinity) distance_m = coarser.at(x / 2, y / 2);
    }
  }
}

Layer oracle(const MapBench& bench, const Origin& origin, int layer_index,
             const ImperfectMapSettings& settings) {
  const std::vector<ScenePoint> points =
      shadow_maps::scene_points(bench.scene(), settings.point_sets, settings.points_per_map);
  const double near_m = static_cast<double>(settings.near_share * bench.diagonal_m());
  Layer layer = empty_layer(kSize_px);
  const int first = layer_index % settings.point_sets * settings.points_per_map;
  for (int i = first; i < first + settings.points_per_map; ++i) {
    splat(points[static_cast<std::size_t>(i)], origin, near_m, settings, layer);
  }
  fill_holes(layer, settings.pull_push_levels);
  return layer;
}

scene::Scene box_with_a_ball() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_box({-1, 0, -1}, {1, 2, 1}, white, true);
  builder.add_sphere({0.2F, 0.8F, 0.1F}, 0.4F, 12, white);
  return builder.scene;
}

/// Share of the texels whose distance differs: a point on the border of a texel or of another's
/// disc may fall to either side by float rounding, and pull-push spreads what it decides.
double share_that_differs(const MapBench& bench, const std::vector<Origin>& origins,
                          const ImperfectMapSettings& settings,
                          const ImperfectMapSettings& believed) {
  const auto maps = bench.imperfect_maps(kSize_px, origins, settings);
  double different = 0.0;
  double used = 0.0;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    Layer expected = oracle(bench, origins[i], static_cast<int>(i), believed);
    const std::vector<float> found = distances_of(maps, static_cast<int>(i));
    for (std::size_t texel = 0; texel < found.size(); ++texel) {
      const double a = expected.distances_m[texel];
      const double b = static_cast<double>(found[texel]);
      if (a == kInfinity && b == kInfinity) continue;
      used += 1.0;
      const bool is_same = std::isfinite(a) && std::fabs(a - b) <= 1e-4 * a;
      different += is_same ? 0.0 : 1.0;
    }
  }
  EXPECT_GT(used, 100.0);
  return different / used;
}

TEST(ImperfectMapsOracle, EveryTexelIsThatOfTheRules) {
  const MapBench bench(box_with_a_ball());
  const std::vector<Origin> origins{origin_at({0, 0, 0}, {0, 1, 0}),
                                    origin_at({-1, 1, 0.3F}, {1, 0, 0}),
                                    origin_at({0.5F, 2, -0.5F}, {0, -1, 0})};
  for (const SplatShape shape : {SplatShape::square, SplatShape::disc}) {
    for (const int levels : {0, 1, 3}) {
      const ImperfectMapSettings settings{
          .point_sets = 2, .points_per_map = 300, .splat_shape = shape, .pull_push_levels = levels};
      EXPECT_LT(share_that_differs(bench, origins, settings, settings), 0.01)
          << "disc " << (shape == SplatShape::disc) << ", levels " << levels;
    }
  }
}

/// The test can fail: another set of points, another size of splats or a level more shows.
TEST(ImperfectMapsOracle, OtherRulesShow) {
  const MapBench bench(box_with_a_ball());
  const std::vector<Origin> origins{origin_at({0, 0, 0}, {0, 1, 0})};
  const ImperfectMapSettings settings{
      .point_sets = 2, .points_per_map = 300, .splat_scale = 0.5F, .pull_push_levels = 1};
  ImperfectMapSettings wider = settings;
  wider.splat_scale *= 1.2F;
  ImperfectMapSettings deeper = settings;
  deeper.pull_push_levels = 0;
  ImperfectMapSettings square = settings;
  square.splat_shape = SplatShape::square;
  EXPECT_GT(share_that_differs(bench, origins, settings, wider), 0.02) << "wider splats";
  EXPECT_GT(share_that_differs(bench, origins, settings, deeper), 0.02) << "no holes filled";
  EXPECT_GT(share_that_differs(bench, origins, settings, square), 0.02) << "square splats";
}

}  // namespace
}  // namespace renderers::test
