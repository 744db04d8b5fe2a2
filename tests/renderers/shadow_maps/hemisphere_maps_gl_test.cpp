#include "renderers/shadow_maps/hemisphere_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

#include "renderers/shadow_maps/hemisphere_projection.h"
#include "tests/renderers/scene_builder.h"
#include "tests/renderers/shadow_maps/map_bench.h"
#include "tests/renderers/shadow_maps/visibility_truth.h"

namespace renderers::test {
namespace {

TEST(HemisphereMaps, ClearedMapsLightEverything) {
  shadow_maps::HemisphereMaps maps(shared_context(), 16, 2);
  maps.clear();
  EXPECT_EQ(distances_of(maps, 1),
            std::vector<float>(16 * 16, std::numeric_limits<float>::infinity()));
  const Origin origin = origin_at(glm::vec3(0.0F), {0, 1, 0});
  const auto lit =
      visibilities(maps, {origin, origin},
                   {{{0.3F, 5, 2, 0}, {0, 1, 0, 0}}, {{-3, 1e-3F, 0, 1}, {1, 0, 0, 0}}}, {});
  EXPECT_EQ(lit, (std::vector<float>{1.0F, 1.0F}));
}

/// A floor light under a half-plane x < 0 at height 1, receivers on a ceiling at height 2.
TEST(HemisphereMaps, ShadowOfAHalfPlaneEndsWhereItMust) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({-40, 1, -40}, {40, 0, 0}, {0, 0, 80}, white);
  builder.add_quad({-40, 2, -40}, {80, 0, 0}, {0, 0, 80}, white);
  const MapBench bench(builder.scene);
  const std::vector<Origin> origins{origin_at({0.5F, 0, 0}, {0, 1, 0})};
  const auto maps = bench.hard_maps(128, origins);
  std::vector<Lookup> lookups;
  std::vector<float> expected;
  // Light at x = 0.5, edge at x = 0, half-way up: the shadow ends at x = -0.5.
  const double margin = 2.0 * shadow_maps::hemisphere_texel_angle(1.0, 128) * std::sqrt(5.0);
  for (int i = 0; i < 400; ++i) {
    const float x = -4.0F + 8.0F * (static_cast<float>(i) + 0.5F) / 400.0F;
    if (std::fabs(static_cast<double>(x) + 0.5) < margin) continue;
    lookups.push_back({{x, 2, 0.01F * static_cast<float>(i % 7), 0}, {0, 1, 0, 0}});
    expected.push_back(x > -0.5F ? 1.0F : 0.0F);
  }
  EXPECT_GT(lookups.size(), 350U);
  EXPECT_EQ(visibilities(maps, origins, lookups, {}), expected);
  // Either side of the normal is the same.
  for (Lookup& lookup : lookups) lookup.normal = -lookup.normal;
  EXPECT_EQ(visibilities(maps, origins, lookups, {.normal_offset = 0.2F}), expected);
}

TEST(HemisphereMaps, AnEmptyBoxIsLit) {
  const MapBench bench(empty_box());
  const auto origins = origins_on_surfaces(bench.scene(), 64);
  const auto truth = visibility_truth(bench, origins, 600);
  EXPECT_EQ(truth.shadowed, 0);
  for (const int size_px : {64, 128}) {
    const auto error = visibility_error(truth, bench.hard_maps(size_px, origins), origins, {});
    // Along the edges, where a texel's ray meets the other wall.
    EXPECT_LT(error.false_shadow, 64.0 / size_px * 0.01) << size_px;
  }
}

/// Flat receivers need no bias: the error of the texel's slope is gone, all that is left are the
/// edges.
TEST(HemisphereMaps, TheReceiverPlaneReplacesTheBias) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({-5, -5, 2}, {10, 0, 0}, {0, 10, 0}, white);
  const MapBench bench(builder.scene);
  // Oblique and grazing views of one plane.
  const std::vector<Origin> origins{origin_at(glm::vec3(0.0F), {0, 0, 1}),
                                    origin_at({1, 2, 0}, {1, 0, 1}),
                                    origin_at({-4, 3, 1.9F}, {1, 0.2F, 0.1F})};
  const auto truth = visibility_truth(bench, origins, 2000);
  const auto error =
      visibility_error(truth, bench.hard_maps(32, origins), origins, {.depth = 0.0F});
  EXPECT_EQ(error.false_shadow, 0.0);
  EXPECT_GT(truth.lit, 3000);
}

TEST(HemisphereMaps, DifferFromRaysAtSilhouettesOnly) {
  const MapBench bench(catalog_scene("cornell-box"));
  const auto origins = origins_on_surfaces(bench.scene(), 24);
  const auto truth = visibility_truth(bench, origins, 700);
  EXPECT_GT(truth.lit, 3000);
  EXPECT_GT(truth.shadowed, 1500);
  constexpr int kSize_px = 128;
  const auto maps = bench.hard_maps(kSize_px, origins);
  const auto visibility = visibilities(maps, origins, truth.lookups, {});
  int unexplained = 0;
  for (std::size_t i = 0; i < visibility.size(); ++i) {
    if ((visibility[i] > 0.5F) == truth.is_lit[i]) continue;
    if (!is_near_silhouette(bench, maps, origins, truth.lookups[i])) ++unexplained;
  }
  EXPECT_EQ(unexplained, 0);
  const auto error = visibility_error(truth, maps, origins, {});
  EXPECT_LT(error.false_shadow, 0.013);
  EXPECT_LT(error.leak, 0.035);
  // Smaller texels, fewer errors.
  const auto coarse = visibility_error(truth, bench.hard_maps(32, origins), origins, {});
  EXPECT_GT(coarse.false_shadow, 1.5 * error.false_shadow);
  EXPECT_GT(coarse.leak, 1.5 * error.leak);
}

/// The negative control: distances of another light's map fail the comparison.
TEST(HemisphereMaps, MapsOfOtherLightsWouldBeFound) {
  const MapBench bench(catalog_scene("cornell-box"));
  const auto origins = origins_on_surfaces(bench.scene(), 24);
  auto shifted = origins;
  std::ranges::rotate(shifted, shifted.begin() + 12);
  const auto truth = visibility_truth(bench, origins, 300);
  const auto error = visibility_error(truth, bench.hard_maps(64, shifted), origins, {});
  EXPECT_GT(error.false_shadow + error.leak, 0.3);
}

TEST(HemisphereMaps, LookupsDoNotDependOnTheSceneScale) {
  for (const float factor : {1000.0F, 0.001F}) {
    const MapBench bench(scaled(catalog_scene("cornell-box"), factor));
    const auto origins = origins_on_surfaces(bench.scene(), 24);
    const auto truth = visibility_truth(bench, origins, 700);
    const auto error = visibility_error(truth, bench.hard_maps(128, origins), origins, {});
    EXPECT_LT(error.false_shadow, 0.013) << factor;
    EXPECT_LT(error.leak, 0.035) << factor;
  }
}

}  // namespace
}  // namespace renderers::test
