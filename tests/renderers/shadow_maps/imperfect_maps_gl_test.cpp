#include "renderers/shadow_maps/imperfect_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "renderers/shadow_maps/scene_points.h"
#include "tests/renderers/scene_builder.h"
#include "tests/renderers/shadow_maps/map_bench.h"
#include "tests/renderers/shadow_maps/visibility_truth.h"

namespace renderers::test {
namespace {

using shadow_maps::ImperfectMapSettings;
using shadow_maps::kImperfectBias;
using shadow_maps::SplatShape;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A floor light below a screen below a ceiling.
scene::Scene screen_scene() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({-2, 1, -2}, {4, 0, 0}, {0, 0, 4}, white);
  builder.add_quad({-6, 2, -6}, {12, 0, 0}, {0, 0, 12}, white);
  return builder.scene;
}

TEST(ImperfectMaps, AScreenThrowsAShadow) {
  const MapBench bench(screen_scene());
  const std::vector<Origin> origins{origin_at(glm::vec3(0.0F), {0, 1, 0})};
  // The shadow on the ceiling is |x|, |z| < 4: well inside and well outside.
  std::vector<Lookup> shadowed;
  std::vector<Lookup> lit;
  for (int i = 0; i < 400; ++i) {
    const float a = -1.0F + 2.0F * static_cast<float>(i % 20) / 19.0F;
    const float b = -1.0F + 2.0F * static_cast<float>(i / 20) / 19.0F;
    shadowed.push_back({{3.0F * a, 2, 3.0F * b, 0}, {0, 1, 0, 0}});
    lit.push_back({{5.4F, 2, 5.9F * b, 0}, {0, 1, 0, 0}});
  }
  // The screen's splats reach beyond its edge, square ones further.
  for (const auto& [shape, least_lit] :
       {std::pair{SplatShape::square, 0.6}, std::pair{SplatShape::disc, 0.95}}) {
    const auto maps = bench.imperfect_maps(64, origins, {.splat_shape = shape});
    double lit_in_shadow = 0.0;
    for (const float value : visibilities(maps, origins, shadowed, kImperfectBias)) {
      lit_in_shadow += value / 400.0;
    }
    EXPECT_LT(lit_in_shadow, 0.02);
    double lit_outside = 0.0;
    for (const float value : visibilities(maps, origins, lit, kImperfectBias)) {
      lit_outside += value / 400.0;
    }
    EXPECT_GT(lit_outside, least_lit);
  }
}

TEST(ImperfectMaps, AnEmptyBoxIsMostlyLit) {
  const MapBench bench(empty_box());
  const auto origins = origins_on_surfaces(bench.scene(), 32);
  const auto truth = visibility_truth(bench, origins, 400);
  const auto disc =
      visibility_error(truth, bench.imperfect_maps(64, origins), origins, kImperfectBias);
  EXPECT_LT(disc.false_shadow, 0.01);
  // Squares at their centre's distance stand out of slanted surfaces.
  const auto square = visibility_error(
      truth, bench.imperfect_maps(64, origins, {.splat_shape = SplatShape::square}), origins,
      kImperfectBias);
  EXPECT_LT(square.false_shadow, 0.25);
  EXPECT_GT(square.false_shadow, 2.0 * disc.false_shadow);
}

TEST(ImperfectMaps, MorePointsComeCloserToTheTruth) {
  const MapBench bench(catalog_scene("cornell-box"));
  const auto origins = origins_on_surfaces(bench.scene(), 32);
  const auto truth = visibility_truth(bench, origins, 600);
  const double share_lit = static_cast<double>(truth.lit) / (truth.lit + truth.shadowed);
  const auto wrong_share = [&](const shadow_maps::HemisphereMaps& maps,
                               const shadow_maps::LookupBias& bias) {
    const auto error = visibility_error(truth, maps, origins, bias);
    return share_lit * error.false_shadow + (1.0 - share_lit) * error.leak;
  };
  double previous = 1.0;
  for (const int points : {64, 256, 1024, 4096}) {
    const double wrong =
        wrong_share(bench.imperfect_maps(64, origins, {.points_per_map = points}), kImperfectBias);
    EXPECT_LT(wrong, previous) << points;
    previous = wrong;
  }
  EXPECT_LT(previous, 0.09);
  EXPECT_LT(wrong_share(bench.hard_maps(64, origins), {}), previous);
}

TEST(ImperfectMaps, PullAndPushCloseHoles) {
  const MapBench bench(empty_box());
  const auto origins = origins_on_surfaces(bench.scene(), 8);
  const auto empty_share = [&](int levels) {
    const auto maps = bench.imperfect_maps(
        64, origins, {.points_per_map = 128, .splat_scale = 0.5F, .pull_push_levels = levels});
    int empty = 0;
    for (int layer = 0; layer < 8; ++layer) {
      for (const float distance : distances_of(maps, layer)) empty += distance == kInfinity ? 1 : 0;
    }
    return empty / (8.0 * 64.0 * 64.0);
  };
  const double open = empty_share(0);
  EXPECT_GT(open, 0.4);
  EXPECT_LT(empty_share(1), open);
  EXPECT_LT(empty_share(2), empty_share(1));
  EXPECT_LT(empty_share(6), 0.02);
  EXPECT_EQ(empty_share(6), empty_share(60)) << "no more levels than the map has";
}

/// One surface at distance 1, one at 5, and holes: the filled values are those of either surface.
TEST(ImperfectMaps, HolesTakeDistancesOfASurface) {
  const MapBench bench(screen_scene());
  const std::vector<Origin> origins{origin_at(glm::vec3(0.0F), {0, 1, 0})};
  const ImperfectMapSettings open{
      .points_per_map = 256, .splat_scale = 0.5F, .pull_push_levels = 0};
  ImperfectMapSettings filled = open;
  filled.pull_push_levels = 3;
  const auto before = distances_of(bench.imperfect_maps(64, origins, open), 0);
  const auto after = distances_of(bench.imperfect_maps(64, origins, filled), 0);
  int changed = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i] != kInfinity) {
      EXPECT_EQ(after[i], before[i]) << "a splat was overwritten at " << i;
    } else if (after[i] != kInfinity) {
      ++changed;
      EXPECT_GE(after[i], 0.9F);
      EXPECT_LE(after[i], 9.0F);
    }
  }
  EXPECT_GT(changed, 500);
}

TEST(ImperfectMaps, LeaveEmptyMapsClear) {
  const MapBench bench(screen_scene());
  std::vector<Origin> origins(3, origin_at(glm::vec3(0.0F), {0, 1, 0}));
  origins[1].position.w = 0.0F;
  const auto maps = bench.imperfect_maps(33, origins);
  EXPECT_EQ(distances_of(maps, 1), std::vector<float>(33 * 33, kInfinity));
  EXPECT_NE(distances_of(maps, 2), distances_of(maps, 0)) << "every map has points of its own";
  scene::Scene nothing = screen_scene();
  nothing.objects.clear();
  const auto empty = MapBench(nothing).imperfect_maps(32, {origins[0]});
  EXPECT_EQ(distances_of(empty, 0), std::vector<float>(32 * 32, kInfinity));
  EXPECT_EQ(shared_context()->take_messages(), std::vector<std::string>{});
}

TEST(ImperfectMaps, AreTheSameInEveryFrame) {
  const MapBench bench(catalog_scene("cornell-box"));
  const auto origins = origins_on_surfaces(bench.scene(), 16);
  const auto first = bench.imperfect_maps(64, origins).distances().read_words();
  EXPECT_TRUE(bench.imperfect_maps(64, origins).distances().read_words() == first);
}

TEST(ImperfectMaps, KeptPointsAreThoseOfTheFirstLoadUntilARestart) {
  scene::Scene wide = screen_scene();
  // Areas change, so that points dealt anew differ from those that moved along.
  wide.objects[1].to_world[0] = glm::vec4(4, 0, 0, 0);
  const MapBench bench(screen_scene());
  const std::vector<Origin> origins{{{0.1F, 0, 0.2F, 1}, {0, 1, 0, 0}}};
  const auto buffer = opengl::Buffer::of(bench.context(), std::span<const Origin>(origins));
  shadow_maps::ImperfectMaps kept(bench.context(), {.keeps_points = true});
  shadow_maps::ImperfectMaps anew(bench.context());
  shadow_maps::HemisphereMaps maps(bench.context(), 32, 1);
  const auto drawn = [&](shadow_maps::ImperfectMaps& filler, const scene::Scene& scene) {
    StageTimer timer;
    filler.load(scene, timer);
    filler.fill(maps, {&buffer, 2}, 0, 1);
    return maps.distances().read_words();
  };
  const auto first = drawn(anew, screen_scene());
  EXPECT_TRUE(drawn(kept, screen_scene()) == first);
  EXPECT_FALSE(drawn(kept, wide) == drawn(anew, wide));
  EXPECT_EQ(kept.points_left_behind(), 0U);
  EXPECT_TRUE(drawn(kept, screen_scene()) == first);
  kept.restart();
  EXPECT_TRUE(drawn(kept, wide) == drawn(anew, wide));
}

/// The points of a map are those of its origin's index, not of its layer.
TEST(ImperfectMaps, BatchesGiveTheSameMaps) {
  const MapBench bench(catalog_scene("cornell-box"));
  const auto origins = origins_on_surfaces(bench.scene(), 6);
  const auto all = bench.imperfect_maps(32, origins);
  const auto buffer = opengl::Buffer::of(bench.context(), std::span<const Origin>(origins));
  shadow_maps::ImperfectMaps filler(bench.context());
  StageTimer timer;
  filler.load(bench.scene(), timer);
  shadow_maps::HemisphereMaps maps(bench.context(), 32, 3);
  filler.fill(maps, {&buffer, 2}, 2, 3);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(distances_of(maps, i), distances_of(all, 2 + i)) << i;
  EXPECT_GT(filler.memory_bytes(), 256 * 1024 * 32);
}

}  // namespace
}  // namespace renderers::test
