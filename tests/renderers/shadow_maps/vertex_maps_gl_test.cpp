#include "renderers/shadow_maps/vertex_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "renderers/contract/devices.h"
#include "renderers/shadow_maps/hemisphere_projection.h"
#include "tests/renderers/scene_builder.h"
#include "tests/renderers/shadow_maps/map_agreement.h"
#include "tests/renderers/shadow_maps/visibility_truth.h"

namespace renderers::test {
namespace {

using shadow_maps::hemisphere_texel_center;
using shadow_maps::LayerChoice;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// 1 - cos(phi / 2): the chord's error over the map's radius, and that of distances.
double chord_error(double angle_rad) { return 1.0 - std::cos(0.5 * angle_rad); }

/// Greatest angle of an edge that is nowhere nearer than a distance.
double angle_of(double edge_m, double distance_m) {
  return 2.0 * std::asin(0.5 * edge_m / distance_m);
}

/// Relative errors of a layer's distances along rays, where both hit something and the texel does
/// not touch the rim, sorted.
std::vector<double> errors_of(const MapBench& bench, const Origin& origin,
                              const shadow_maps::HemisphereMaps& maps, int layer) {
  const auto distances = distances_of(maps, layer);
  std::vector<double> errors;
  for (int y = 0; y < maps.size_px(); ++y) {
    for (int x = 0; x < maps.size_px(); ++x) {
      const glm::dvec2 center = hemisphere_texel_center({x, y}, maps.size_px());
      if (glm::length(center) > 1.0 - std::numbers::sqrt2 / maps.size_px()) continue;
      const float truth = ray_distance(bench, origin, maps.near_m(), center);
      const float distance = distances[static_cast<std::size_t>(y * maps.size_px() + x)];
      if (!std::isfinite(truth) || !std::isfinite(distance)) continue;
      errors.push_back(std::fabs(static_cast<double>(distance) / truth - 1.0));
    }
  }
  std::ranges::sort(errors);
  return errors;
}

/// From the middle of a box no wall is nearer than 1, and there are no silhouettes.
TEST(VertexMaps, DistancesKeepTheBoundOfTheChord) {
  const MapBench bench(empty_box());
  const Origin origin = origin_at(glm::vec3(0.0F), {0.36F, 0.48F, 0.8F});
  const auto errors_at = [&](float edge_share) {
    return errors_of(bench, origin, bench.vertex_maps(64, {origin}, {.edge_share = edge_share}), 0);
  };
  for (const float edge_share : {0.2F, 0.1F, 0.05F}) {
    const double phi = angle_of(static_cast<double>(edge_share * bench.diagonal_m()), 1.0);
    const auto errors = errors_at(edge_share);
    EXPECT_GT(errors.size(), 3000U);
    EXPECT_LT(errors.back(), chord_error(phi)) << edge_share;
    // The bound is no idle one: half the angle breaks it.
    EXPECT_GT(errors.back(), chord_error(0.5 * phi)) << edge_share;
  }
  const auto uncut = errors_at(0.0F);
  EXPECT_GT(uncut[uncut.size() / 2], 0.2) << "walls of two triangles";
}

/// A parallelogram in front of nothing, nowhere nearer than 0.8 to the origin.
struct Tile {
  glm::dvec3 corner{0.8, -1.0, 0.05};
  glm::dvec3 a{0.0, 2.0, 0.0};
  glm::dvec3 b{0.3, 0.0, 0.7};
};

bool meets(const Tile& tile, const glm::dvec3& center, const glm::dvec2& position) {
  const glm::dmat3 columns(tile.a, tile.b, -shadow_maps::hemisphere_direction(position));
  const glm::dvec3 solved = glm::inverse(columns) * (center - tile.corner);
  return solved.x >= 0.0 && solved.x <= 1.0 && solved.y >= 0.0 && solved.y <= 1.0 && solved.z > 0.0;
}

/// Some direction within a reach, of the map's radius, is on the other side of the outline.
bool is_near_outline(const Tile& tile, const glm::dvec3& center, const glm::dvec2& position,
                     double reach) {
  constexpr int kSteps = 8;
  const bool is_inside = meets(tile, center, position);
  for (int dy = -kSteps; dy <= kSteps; ++dy) {
    for (int dx = -kSteps; dx <= kSteps; ++dx) {
      const glm::dvec2 step = reach / kSteps * glm::dvec2(dx, dy);
      if (meets(tile, center, position + step) != is_inside) return true;
    }
  }
  return false;
}

/// Texels on the wrong side of the outline, farther from it than a reach in texels.
int texels_beyond(const Tile& tile, const shadow_maps::HemisphereMaps& maps, double reach_px) {
  const auto distances = distances_of(maps, 0);
  const int size_px = maps.size_px();
  const glm::dvec3 center(0.0, 0.0, static_cast<double>(maps.near_m()));
  int beyond = 0;
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) {
      const glm::dvec2 position = hemisphere_texel_center({x, y}, size_px);
      if (glm::length(position) > 1.0) continue;
      const float distance = distances[static_cast<std::size_t>(y * size_px + x)];
      if (std::isfinite(distance) == meets(tile, center, position)) continue;
      if (!is_near_outline(tile, center, position, 2.0 / size_px * reach_px)) ++beyond;
    }
  }
  return beyond;
}

TEST(VertexMaps, OutlinesKeepTheBoundOfTheChord) {
  const Tile tile;
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad(glm::vec3(tile.corner), glm::vec3(tile.a), glm::vec3(tile.b), white);
  const MapBench bench(builder.scene);
  const Origin origin = origin_at(glm::vec3(0.0F), {0, 0, 1});
  constexpr int kSize_px = 256;
  constexpr double kRounding_px = 0.1;  // of corners, and the steps of the search
  for (const float edge_share : {0.25F, 0.1F, 0.05F}) {
    const double phi = angle_of(static_cast<double>(edge_share * bench.diagonal_m()), 0.8);
    const double bound_px = 0.5 * kSize_px * chord_error(phi);
    const auto maps = bench.vertex_maps(kSize_px, {origin}, {.edge_share = edge_share});
    EXPECT_EQ(texels_beyond(tile, maps, bound_px + kRounding_px), 0) << edge_share;
  }
  const auto uncut = bench.vertex_maps(kSize_px, {origin}, {.edge_share = 0.0F});
  EXPECT_GT(texels_beyond(tile, uncut, 0.5 * kSize_px * chord_error(0.35)), 100) << "20 degrees";
}

/// The paper's room of few faces: near a centre pieces subtend large angles whatever their size, so
/// it is the median that is bounded, by that of 10 degrees.
TEST(VertexMaps, ARoomOfFewFacesMustBeCut) {
  const MapBench bench(catalog_scene("cornell-box"));
  const auto origins = origins_on_surfaces(bench.scene(), 12);
  const auto median = [&](float edge_share) {
    const auto maps = bench.vertex_maps(32, origins, {.edge_share = edge_share});
    std::vector<double> errors;
    for (std::size_t i = 0; i < origins.size(); ++i) {
      const auto some = errors_of(bench, origins[i], maps, static_cast<int>(i));
      errors.insert(errors.end(), some.begin(), some.end());
    }
    std::ranges::sort(errors);
    return errors[errors.size() / 2];
  };
  const double bound = chord_error(10.0 / 57.29578);
  EXPECT_LT(median(0.04F), bound);
  EXPECT_LT(median(0.02F), 0.5 * bound);
  EXPECT_GT(median(0.0F), 20.0 * bound);
}

/// llvmpipe rounds positions otherwise behind a geometry shader: the same texels, last bits differ.
TEST(VertexMaps, EveryChoiceOfLayersGivesTheSameDistances) {
  const MapBench bench(catalog_scene("cornell-box"));
  auto origins = origins_on_surfaces(bench.scene(), 5);
  origins[3].position.w = 0.0F;
  const auto maps_of = [&](LayerChoice choice) {
    return bench.vertex_maps(48, origins, {.layer_choice = choice});
  };
  const auto expected = maps_of(LayerChoice::per_layer);
  const auto by_geometry = maps_of(LayerChoice::gs_layer);
  for (int layer = 0; layer < 5; ++layer) {
    const auto a = distances_of(by_geometry, layer);
    const auto b = distances_of(expected, layer);
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_TRUE(a[i] == b[i] || std::fabs(a[i] - b[i]) < 5e-6F * bench.diagonal_m()) << layer;
    }
  }
  if (bench.context()->limits().has_vertex_layers) {
    const auto words = expected.distances().read_words();
    EXPECT_TRUE(maps_of(LayerChoice::vs_layer).distances().read_words() == words);
    EXPECT_TRUE(maps_of(LayerChoice::automatic).distances().read_words() == words);
  } else {
    EXPECT_THROW(maps_of(LayerChoice::vs_layer), UnsupportedError);
  }
  EXPECT_EQ(bench.context()->take_messages(), std::vector<std::string>{});
}

TEST(VertexMaps, CutSmallPiecesAtTheHorizon) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({1, -5, -3}, {0, 10, 0}, {0, 0, 6}, white);       // across the horizon
  builder.add_quad({-0.2F, -4, -9}, {0, 8, 0}, {-3, 0, 12}, white);  // through the lower pole's ray
  const MapBench bench(builder.scene);
  const std::vector<Origin> origins{origin_at(glm::vec3(0.0F), {0, 0, 1}),
                                    origin_at({0.5F, 0, 0}, {-0.6F, 0, 0.8F})};
  const auto maps = bench.vertex_maps(64, origins, {.edge_share = 0.01F});
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const SeenFrom seen{bench, origins[i], maps.near_m()};
    const auto agreement = agreement_of(seen, 64, distances_of(maps, static_cast<int>(i)),
                                        silhouette_excuse(seen, 4.0 / 64), 0.03F);
    // Few are cut at the wrong place: the height is not linear over a piece's image.
    EXPECT_LT(agreement.unexplained, agreement.texels / 200) << "layer " << i;
    EXPECT_LT(agreement.differing, agreement.texels / 20) << "layer " << i;
  }
}

TEST(VertexMaps, FillTheTexelsOfTheRim) {
  const MapBench bench(empty_box());
  const auto maps = bench.vertex_maps(50, {origin_at({0.1F, -0.2F, 0}, {0.36F, 0.48F, 0.8F})});
  const auto distances = distances_of(maps, 0);
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 50; ++x) {
      EXPECT_EQ(std::isfinite(distances[static_cast<std::size_t>(y * 50 + x)]),
                shadow_maps::hemisphere_texel_is_used({x, y}, 50))
          << x << " " << y;
    }
  }
}

TEST(VertexMaps, LeaveEmptyMapsAndTheRestClear) {
  const MapBench bench(catalog_scene("cornell-box"));
  auto origins = origins_on_surfaces(bench.scene(), 6);
  origins[4].position.w = 0.0F;
  origins[4].axis = glm::vec4(std::numeric_limits<float>::quiet_NaN());
  const auto all = bench.vertex_maps(32, origins);
  EXPECT_EQ(distances_of(all, 4), std::vector<float>(32 * 32, kInfinity));
  std::vector<glm::vec4> padded;
  for (const Origin& origin : origins) {
    padded.insert(padded.end(), {origin.position, origin.axis, glm::vec4(7.0F), glm::vec4(8.0F)});
  }
  const auto buffer = opengl::Buffer::of(bench.context(), std::span<const glm::vec4>(padded));
  shadow_maps::HemisphereMaps maps(bench.context(), 32, 4);
  shadow_maps::VertexMaps filler(bench.context());
  filler.fill(maps, bench.gpu(), {&buffer, 4}, 3, 3);
  EXPECT_EQ(distances_of(maps, 0), std::vector<float>(32 * 32, kInfinity)) << "nothing loaded";
  StageTimer timer;
  filler.load(bench.scene(), timer);
  filler.fill(maps, bench.gpu(), {&buffer, 4}, 3, 3);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(distances_of(maps, i), distances_of(all, 3 + i)) << i;
  EXPECT_EQ(distances_of(maps, 3), std::vector<float>(32 * 32, kInfinity));
  filler.fill(maps, bench.gpu(), {&buffer, 4}, 0, 0);
  EXPECT_EQ(distances_of(maps, 0), std::vector<float>(32 * 32, kInfinity)) << "no layer is drawn";
}

TEST(VertexMaps, SayHowManyPiecesFit) {
  const MapBench bench(empty_box());
  shadow_maps::VertexMaps filler(bench.context(), {.edge_share = 1e-5F});
  StageTimer timer;
  const auto& context = *bench.context();
  std::string message;
  try {
    filler.load(bench.scene(), timer);
  } catch (const UnsupportedError& error) {
    message = error.what();
  }
  EXPECT_EQ(message,
            fmt::format("shadow maps of triangles cut to 1e-05 of the scene's diagonal: {} has "
                        "room for {} pieces",
                        context.facts().renderer, context.limits().storage_block_bytes / 12));
}

}  // namespace
}  // namespace renderers::test
