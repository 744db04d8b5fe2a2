#include "renderers/shadow_maps/hard_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "renderers/contract/devices.h"
#include "renderers/shadow_maps/hemisphere_projection.h"
#include "tests/renderers/scene_builder.h"
#include "tests/renderers/shadow_maps/map_agreement.h"
#include "tests/renderers/shadow_maps/map_bench.h"
#include "tests/renderers/shadow_maps/visibility_truth.h"

namespace renderers::test {
namespace {

using shadow_maps::hemisphere_texel_is_used;
using shadow_maps::hemisphere_texel_position;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::vector<Origin> scaled_origins(std::vector<Origin> origins, float factor) {
  for (Origin& origin : origins) origin.position *= glm::vec4(glm::vec3(factor), 1.0F);
  return origins;
}

/// Every layer against rays.
void expect_exact(const MapBench& bench, int size_px, const std::vector<Origin>& origins,
                  const shadow_maps::HardMapSettings& settings = {}) {
  const auto maps = bench.hard_maps(size_px, origins, settings);
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const SeenFrom seen{bench, origins[i], maps.near_m()};
    const auto agreement =
        agreement_of(seen, size_px, distances_of(maps, static_cast<int>(i)), rounding_excuse(seen));
    EXPECT_LT(agreement.median_error, 2e-6) << "layer " << i;
    EXPECT_LE(agreement.differing, agreement.texels / 100) << "layer " << i;
    EXPECT_EQ(agreement.unexplained, 0) << "layer " << i << " of " << agreement.differing;
  }
  EXPECT_EQ(bench.context()->take_messages(), std::vector<std::string>{});
}

TEST(HardMaps, AreExactInTheCornellBox) {
  const MapBench bench(catalog_scene("cornell-box"));
  expect_exact(bench, 64, origins_on_surfaces(bench.scene(), 24));
  expect_exact(bench, 33, origins_on_surfaces(bench.scene(), 5));
}

TEST(HardMaps, AreExactAroundSmallTriangles) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F), white, true);
  builder.add_sphere({0.2F, -0.4F, 0.1F}, 0.4F, 24, white);
  builder.add_sphere({-0.5F, 0.3F, -0.2F}, 0.2F, 40, white);
  const MapBench bench(builder.scene);
  expect_exact(bench, 64, origins_on_surfaces(bench.scene(), 24));
}

/// The map as a vertex shader and a rasteriser would draw it: vertices projected, edges straight,
/// distances linear in between; triangles that reach below the horizon are left out.
std::vector<float> draw_vertices(const scene::Scene& scene, const Origin& origin, float near_m,
                                 int size_px) {
  std::vector<float> distances(static_cast<std::size_t>(size_px * size_px), kInfinity);
  const glm::dvec3 axis(origin.axis);
  const glm::dmat3 to_map = glm::transpose(shadow_maps::hemisphere_frame(axis));
  const glm::dvec3 center = glm::dvec3(origin.position) + static_cast<double>(near_m) * axis;
  const auto cross2 = [](const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
  };
  for (const scene::Object& object : scene.objects) {
    for (const glm::uvec3& index : object.mesh->triangles) {
      std::array<glm::dvec2, 3> p;
      glm::dvec3 length;
      bool is_above = true;
      for (int i = 0; i < 3; ++i) {
        const glm::vec3 vertex(object.to_world * glm::vec4(object.mesh->positions[index[i]], 1.0F));
        const glm::dvec3 local = to_map * (glm::dvec3(vertex) - center);
        is_above = is_above && local.z > 0.0;
        p[static_cast<std::size_t>(i)] = shadow_maps::hemisphere_position(local);
        length[i] = glm::length(local);
      }
      if (!is_above) continue;
      const double area = cross2(p[1] - p[0], p[2] - p[0]);
      for (int y = 0; y < size_px; ++y) {
        for (int x = 0; x < size_px; ++x) {
          const glm::dvec2 at = hemisphere_texel_position({x, y}, size_px);
          const glm::dvec3 weight =
              glm::dvec3(cross2(p[1] - at, p[2] - at), cross2(p[2] - at, p[0] - at),
                         cross2(p[0] - at, p[1] - at)) /
              area;
          if (!(weight.x >= 0.0 && weight.y >= 0.0 && weight.z >= 0.0)) continue;
          float& nearest = distances[static_cast<std::size_t>(y * size_px + x)];
          nearest = std::fmin(nearest, static_cast<float>(glm::dot(weight, length)));
        }
      }
    }
  }
  return distances;
}

TEST(HardMaps, StraightEdgesWouldFailTheSameTest) {
  const MapBench bench(catalog_scene("cornell-box"));
  // The middle of the floor, from where all of the room is above the horizon.
  const Origin origin = origin_at({2.5F, 0.5F, 1.0F}, {0, 1, 0});
  constexpr int kSize_px = 64;
  const float near_m = bench.hard_maps(kSize_px, {origin}).near_m();
  const SeenFrom seen{bench, origin, near_m};
  const auto agreement =
      agreement_of(seen, kSize_px, draw_vertices(bench.scene(), origin, near_m, kSize_px),
                   rounding_excuse(seen));
  EXPECT_GT(agreement.median_error, 1e-3);
  EXPECT_GT(agreement.unexplained, agreement.texels / 2);
}

TEST(HardMaps, KnowTheDistancesInABox) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F), white, true);
  const MapBench bench(builder.scene);
  const Origin origin = origin_at({0.25F, -1.0F, -0.5F}, {0, 1, 0});
  constexpr int kSize_px = 48;
  const auto maps = bench.hard_maps(kSize_px, {origin});
  EXPECT_NEAR(maps.near_m(), shadow_maps::kNearShare * std::sqrt(12.0F), 1e-9);
  const auto distances = distances_of(maps, 0);
  const glm::dvec3 center = glm::dvec3(origin.position) + glm::dvec3(0, maps.near_m(), 0);
  const glm::dmat3 frame = shadow_maps::hemisphere_frame(glm::dvec3(0, 1, 0));
  int rim_texels = 0;
  for (int y = 0; y < kSize_px; ++y) {
    for (int x = 0; x < kSize_px; ++x) {
      if (!hemisphere_texel_is_used({x, y}, kSize_px)) continue;
      const glm::dvec2 position = hemisphere_texel_position({x, y}, kSize_px);
      const glm::dvec3 direction = frame * shadow_maps::hemisphere_direction(position);
      double expected = 1e9;
      for (int axis = 0; axis < 3; ++axis) {
        if (std::fabs(direction[axis]) < 1e-12) continue;
        expected = std::fmin(
            expected, (std::copysign(1.0, direction[axis]) - center[axis]) / direction[axis]);
      }
      const float distance = distances[static_cast<std::size_t>(y * kSize_px + x)];
      EXPECT_NEAR(distance / expected, 1.0, 1e-5) << x << " " << y;
      if (glm::length(position) > 1.0 - 1e-9) ++rim_texels;
    }
  }
  EXPECT_GT(rim_texels, kSize_px);
}

TEST(HardMaps, CutTrianglesAtTheHorizon) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({1, -5, -3}, {0, 10, 0}, {0, 0, 6}, white);       // across the horizon
  builder.add_quad({-0.2F, -4, -9}, {0, 8, 0}, {-3, 0, 12}, white);  // through the lower pole's ray
  const MapBench bench(builder.scene);
  expect_exact(
      bench, 64,
      {origin_at(glm::vec3(0.0F), {0, 0, 1}), origin_at(glm::vec3(0.0F), {0, 0, -1}),
       origin_at({0.9F, 0, 0}, {-0.6F, 0, 0.8F}), origin_at({0, 0, -2.9F}, {0.6F, 0.8F, 0})});
}

TEST(HardMaps, DoNotSeeWhatLiesBehind) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({-5, -5, -1}, {10, 0, 0}, {0, 10, 0}, white);
  const MapBench bench(builder.scene);
  const auto maps = bench.hard_maps(
      32, {origin_at(glm::vec3(0.0F), {0, 0, 1}), origin_at(glm::vec3(0.0F), {0, 0, -1})});
  EXPECT_EQ(distances_of(maps, 0), std::vector<float>(32 * 32, kInfinity));
  EXPECT_NE(distances_of(maps, 1), std::vector<float>(32 * 32, kInfinity));
}

/// A floor of n x n squares in the plane y = 0.3 x + 0.1 z.
scene::Scene tilted_floor(int squares) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  const float step = 2.0F / static_cast<float>(squares);
  for (int i = 0; i < squares * squares; ++i) {
    const float x = -1.0F + step * static_cast<float>(i % squares);
    const float z = -1.0F + step * static_cast<float>(i / squares);
    builder.add_quad({x, 0.3F * x + 0.1F * z, z}, {0, 0.1F * step, step}, {step, 0.3F * step, 0},
                     white);
  }
  return builder.scene;
}

TEST(HardMaps, TheSurfaceOfTheLightShadowsNothing) {
  for (const float scale : {1.0F, 1000.0F, 0.001F}) {
    const MapBench bench(scaled(tilted_floor(8), scale));
    const auto origins = origins_on_surfaces(bench.scene(), 40);
    const auto maps = bench.hard_maps(64, origins);
    for (int layer = 0; layer < 40; ++layer) {
      EXPECT_EQ(distances_of(maps, layer), std::vector<float>(64 * 64, kInfinity)) << layer;
    }
    // Without the height above the surface, rounding makes it shadow itself.
    const auto touching = bench.hard_maps(64, origins, {.near_share = 0.0F});
    int shadowed = 0;
    for (int layer = 0; layer < 40; ++layer) {
      if (distances_of(touching, layer) != std::vector<float>(64 * 64, kInfinity)) ++shadowed;
    }
    EXPECT_GT(shadowed, 0);
  }
}

TEST(HardMaps, LeaveEmptyMapsAndTheRestClear) {
  const MapBench bench(catalog_scene("cornell-box"));
  auto origins = origins_on_surfaces(bench.scene(), 4);
  const auto full = bench.hard_maps(32, origins);
  origins[1].position.w = 0.0F;
  origins[1].axis = glm::vec4(std::numeric_limits<float>::quiet_NaN());
  const auto maps = bench.hard_maps(32, origins);
  EXPECT_EQ(distances_of(maps, 1), std::vector<float>(32 * 32, kInfinity));
  for (const int layer : {0, 2, 3}) EXPECT_EQ(distances_of(maps, layer), distances_of(full, layer));
}

TEST(HardMaps, TakeARangeOfOriginsAtAnyStride) {
  const MapBench bench(catalog_scene("cornell-box"));
  const auto origins = origins_on_surfaces(bench.scene(), 6);
  const auto all = bench.hard_maps(32, origins);
  std::vector<glm::vec4> padded;
  for (const Origin& origin : origins) {
    padded.insert(padded.end(), {origin.position, origin.axis, glm::vec4(7.0F), glm::vec4(8.0F)});
  }
  const auto buffer = opengl::Buffer::of(bench.context(), std::span<const glm::vec4>(padded));
  shadow_maps::HemisphereMaps maps(bench.context(), 32, 4);
  shadow_maps::HardMaps filler(bench.context());
  filler.fill(maps, bench.gpu(), {&buffer, 4}, 3, 3);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(distances_of(maps, i), distances_of(all, 3 + i)) << i;
  EXPECT_EQ(distances_of(maps, 3), std::vector<float>(32 * 32, kInfinity));
  filler.fill(maps, bench.gpu(), {&buffer, 4}, 0, 0);
  EXPECT_EQ(distances_of(maps, 0), std::vector<float>(32 * 32, kInfinity)) << "no layer is drawn";
}

TEST(HardMaps, DegenerateTrianglesChangeNothing) {
  scene::Scene scene = catalog_scene("cornell-box");
  const MapBench bench(scene);
  const auto origins = origins_on_surfaces(scene, 4);
  const auto expected = bench.hard_maps(48, origins);
  scene::Object object = scene.objects.front();
  auto mesh = std::make_shared<scene::Mesh>();
  // Within the scene's bounds, which the height of the centres follows.
  mesh->positions = {{3, 1, 2}, {3.5F, 1, 2}, {3.25F, 1, 2}, {2.5F, 1.1F, 2.3F}};
  mesh->triangles = {{0, 0, 0}, {0, 1, 2}, {0, 1, 1}, {3, 3, 0}};
  object.mesh = mesh;
  scene.objects.push_back(object);
  const auto maps = MapBench(scene).hard_maps(48, origins);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(distances_of(maps, i), distances_of(expected, i)) << i;
}

TEST(HardMaps, DoNotDependOnTheSceneScale) {
  const scene::Scene scene = catalog_scene("cornell-box");
  const auto origins = origins_on_surfaces(scene, 6);
  for (const float factor : {1000.0F, 0.001F}) {
    expect_exact(MapBench(scaled(scene, factor)), 48, scaled_origins(origins, factor));
  }
}

TEST(HardMaps, DoNotDependOnHowTheWorkIsSplit) {
  const MapBench bench(catalog_scene("cornell-box"));
  const auto origins = origins_on_surfaces(bench.scene(), 6);
  shadow_maps::HardMapWork queued;
  const auto expected =
      bench.hard_maps(64, origins, {.direct_texels = 0, .counts_work = true}, &queued);
  EXPECT_EQ(queued.pairs, 6 * bench.gpu().triangle_count());
  EXPECT_EQ(queued.direct_pairs, 0);
  EXPECT_GT(queued.queued_pairs, queued.pairs / 4);
  EXPECT_EQ(queued.overflow_pairs, 0);
  EXPECT_GT(queued.texels_tested, 6 * 3000);

  shadow_maps::HardMapWork direct;
  const auto walked =
      bench.hard_maps(64, origins, {.direct_texels = 1 << 20, .counts_work = true}, &direct);
  EXPECT_EQ(direct.queued_pairs, 0);
  EXPECT_EQ(direct.direct_pairs, queued.queued_pairs);
  EXPECT_GT(direct.texels_tested, queued.texels_tested) << "spheres bound less tightly than arcs";

  shadow_maps::HardMapWork overflow;
  const auto crowded =
      bench.hard_maps(64, origins, {.direct_texels = 0, .queue_capacity = 3}, &overflow);
  EXPECT_EQ(overflow.queued_pairs, 3);
  EXPECT_EQ(overflow.overflow_pairs, queued.queued_pairs - 3);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(distances_of(walked, i), distances_of(expected, i)) << i;
    EXPECT_EQ(distances_of(crowded, i), distances_of(expected, i)) << i;
  }
}

TEST(HardMaps, AreTheSameInEveryRun) {
  const MapBench bench(catalog_scene("cornell-box"));
  const auto origins = origins_on_surfaces(bench.scene(), 32);
  const auto first = bench.hard_maps(64, origins).distances().read_words();
  for (int run = 0; run < 3; ++run) {
    EXPECT_TRUE(bench.hard_maps(64, origins).distances().read_words() == first);
  }
}

TEST(HardMaps, AreTheSameOnEglAndOsmesa) {
  const scene::Scene scene = catalog_scene("cornell-box");
  const auto origins = origins_on_surfaces(scene, 8);
  const MapBench egl(scene, opengl::Context::create("egl-surfaceless"));
  const MapBench osmesa(scene, opengl::Context::create("osmesa"));
  const auto a = egl.hard_maps(64, origins);
  const auto b = osmesa.hard_maps(64, origins);
  std::size_t differing = 0;
  for (int layer = 0; layer < 8; ++layer) {
    const auto distances_a = distances_of(a, layer);
    const auto distances_b = distances_of(b, layer);
    for (std::size_t i = 0; i < distances_a.size(); ++i) {
      if (!is_alike(distances_a[i], distances_b[i], 1e-6F)) ++differing;
    }
  }
  // Two drivers may round differently where a ray meets an edge.
  EXPECT_LE(differing, 8U * 64U * 64U / 10000U);
}

TEST(HardMaps, SayWhatTheDeviceAllows) {
  const auto context = shared_context();
  const auto size_px = context->limits().texture_size_px;
  const auto layers = context->limits().array_layers;
  const auto message_of = [&](std::int64_t size, std::int64_t count) -> std::string {
    try {
      const shadow_maps::HemisphereMaps maps(context, static_cast<int>(size),
                                             static_cast<int>(count));
    } catch (const UnsupportedError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(
      message_of(size_px + 1, 1),
      fmt::format("shadow maps of {0} x {0} px: this device allows {1} px", size_px + 1, size_px));
  EXPECT_EQ(
      message_of(16, layers + 1),
      fmt::format("{} shadow maps at once: this device allows {} layers", layers + 1, layers));
  EXPECT_EQ(message_of(16, 2), "");
}

}  // namespace
}  // namespace renderers::test
