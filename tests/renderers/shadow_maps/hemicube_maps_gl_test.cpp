#include "renderers/shadow_maps/hemicube_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "renderers/contract/devices.h"
#include "tests/renderers/scene_builder.h"
#include "tests/renderers/shadow_maps/map_agreement.h"
#include "tests/renderers/shadow_maps/visibility_truth.h"

namespace renderers::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Every layer against rays. @param most_differing  share of the texels
void expect_near(const MapBench& bench, int size_px, const std::vector<Origin>& origins,
                 double most_differing) {
  const auto maps = bench.hemicube_maps(size_px, origins);
  double texels = 0.0;
  double differing = 0.0;
  double unexplained = 0.0;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    // A pixel of a face spans at most a texel, a texel is 2 / size of the radius.
    const SeenFrom seen{bench, origins[i], maps.near_m()};
    const auto agreement = agreement_of(seen, size_px, distances_of(maps, static_cast<int>(i)),
                                        silhouette_excuse(seen, 2.0 / size_px));
    EXPECT_LT(agreement.median_error, 2e-6) << "layer " << i;
    texels += agreement.texels;
    differing += agreement.differing;
    unexplained += agreement.unexplained;
  }
  EXPECT_LT(differing / texels, most_differing);
  EXPECT_LT(unexplained / texels, 0.1 * most_differing);
  EXPECT_EQ(bench.context()->take_messages(), std::vector<std::string>{});
}

TEST(HemicubeMaps, AgreeWithRaysInTheCornellBox) {
  const MapBench bench(catalog_scene("cornell-box"));
  expect_near(bench, 64, origins_on_surfaces(bench.scene(), 24), 0.01);
  expect_near(bench, 33, origins_on_surfaces(bench.scene(), 5), 0.03);
}

scene::Scene spheres_in_a_box() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F), white, true);
  builder.add_sphere({0.2F, -0.4F, 0.1F}, 0.4F, 24, white);
  builder.add_sphere({-0.5F, 0.3F, -0.2F}, 0.2F, 40, white);
  return builder.scene;
}

TEST(HemicubeMaps, AgreeWithRaysAroundSmallTriangles) {
  const MapBench bench(spheres_in_a_box());
  expect_near(bench, 64, origins_on_surfaces(bench.scene(), 24), 0.02);
}

/// The test can fail: a centimetre is seen.
TEST(HemicubeMaps, OtherOriginsWouldBeFound) {
  const MapBench bench(catalog_scene("cornell-box"));
  const Origin origin = origin_at({2.5F, 0.5F, 1.0F}, {0, 1, 0});
  Origin moved = origin;
  moved.position.x += 0.01F;
  const auto maps = bench.hemicube_maps(64, {moved});
  const SeenFrom seen{bench, origin, maps.near_m()};
  const auto agreement =
      agreement_of(seen, 64, distances_of(maps, 0), silhouette_excuse(seen, 2.0 / 64));
  EXPECT_GT(agreement.median_error, 1e-3);
}

TEST(HemicubeMaps, CutTrianglesAtTheHorizon) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({1, -5, -3}, {0, 10, 0}, {0, 0, 6}, white);       // across the horizon
  builder.add_quad({-0.2F, -4, -9}, {0, 8, 0}, {-3, 0, 12}, white);  // through the lower pole's ray
  const MapBench bench(builder.scene);
  expect_near(
      bench, 64,
      {origin_at(glm::vec3(0.0F), {0, 0, 1}), origin_at(glm::vec3(0.0F), {0, 0, -1}),
       origin_at({0.9F, 0, 0}, {-0.6F, 0, 0.8F}), origin_at({0, 0, -2.9F}, {0.6F, 0.8F, 0})},
      0.01);
}

TEST(HemicubeMaps, DoNotSeeWhatLiesBehind) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({-5, -5, -1}, {10, 0, 0}, {0, 10, 0}, white);
  const MapBench bench(builder.scene);
  const auto maps = bench.hemicube_maps(
      32, {origin_at(glm::vec3(0.0F), {0, 0, 1}), origin_at(glm::vec3(0.0F), {0, 0, -1})});
  EXPECT_EQ(distances_of(maps, 0), std::vector<float>(32 * 32, kInfinity));
  EXPECT_NE(distances_of(maps, 1), std::vector<float>(32 * 32, kInfinity));
}

TEST(HemicubeMaps, LeaveEmptyMapsAndTheRestClear) {
  const MapBench bench(catalog_scene("cornell-box"));
  auto origins = origins_on_surfaces(bench.scene(), 4);
  const auto full = bench.hemicube_maps(32, origins);
  origins[1].position.w = 0.0F;
  origins[1].axis = glm::vec4(std::numeric_limits<float>::quiet_NaN());
  const auto maps = bench.hemicube_maps(32, origins);
  EXPECT_EQ(distances_of(maps, 1), std::vector<float>(32 * 32, kInfinity));
  for (const int layer : {0, 2, 3}) EXPECT_EQ(distances_of(maps, layer), distances_of(full, layer));
}

TEST(HemicubeMaps, NothingIsSeenInAnEmptyScene) {
  const MapBench bench{scene::Scene{}};
  const auto maps = bench.hemicube_maps(16, {origin_at(glm::vec3(0.0F), {0, 0, 1})});
  EXPECT_EQ(distances_of(maps, 0), std::vector<float>(16 * 16, kInfinity));
}

TEST(HemicubeMaps, TakeARangeOfOriginsAtAnyStride) {
  const MapBench bench(catalog_scene("cornell-box"));
  const auto origins = origins_on_surfaces(bench.scene(), 6);
  const auto all = bench.hemicube_maps(32, origins);
  std::vector<glm::vec4> padded;
  for (const Origin& origin : origins) {
    padded.insert(padded.end(), {origin.position, origin.axis, glm::vec4(7.0F), glm::vec4(8.0F)});
  }
  const auto buffer = opengl::Buffer::of(bench.context(), std::span<const glm::vec4>(padded));
  shadow_maps::HemisphereMaps maps(bench.context(), 32, 4);
  // Two batches of faces.
  shadow_maps::HemicubeMaps filler(bench.context(), {.layers_at_once = 2});
  filler.fill(maps, bench.gpu(), {&buffer, 4}, 3, 3);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(distances_of(maps, i), distances_of(all, 3 + i)) << i;
  EXPECT_EQ(distances_of(maps, 3), std::vector<float>(32 * 32, kInfinity));
  filler.fill(maps, bench.gpu(), {&buffer, 4}, 0, 0);
  EXPECT_EQ(distances_of(maps, 0), std::vector<float>(32 * 32, kInfinity)) << "no layer is drawn";
}

TEST(HemicubeMaps, AreTheSameInEveryRun) {
  const MapBench bench(spheres_in_a_box());
  const auto origins = origins_on_surfaces(bench.scene(), 5);
  const shadow_maps::HemicubeMapSettings settings{.layers_at_once = 3};
  const auto first = bench.hemicube_maps(64, origins, settings).distances().read_words();
  for (int run = 0; run < 2; ++run) {
    EXPECT_TRUE(bench.hemicube_maps(64, origins, settings).distances().read_words() == first);
  }
}

TEST(HemicubeMaps, FinerFacesAreCloserToRays) {
  const MapBench bench(spheres_in_a_box());
  const auto origins = origins_on_surfaces(bench.scene(), 6);
  const auto differing = [&](float face_scale) {
    const auto maps = bench.hemicube_maps(48, origins, {.face_scale = face_scale});
    int texels = 0;
    for (std::size_t i = 0; i < origins.size(); ++i) {
      const SeenFrom seen{bench, origins[i], maps.near_m()};
      texels += agreement_of(seen, 48, distances_of(maps, static_cast<int>(i)),
                             [](const glm::dvec2&, float) { return true; })
                    .differing;
    }
    return texels;
  };
  const int coarse = differing(0.5F);
  const int fine = differing(2.0F);
  EXPECT_GT(coarse, 2 * fine);
}

TEST(HemicubeMaps, DoNotDependOnTheSceneScale) {
  const scene::Scene scene = catalog_scene("cornell-box");
  auto origins = origins_on_surfaces(scene, 4);
  for (const float factor : {1000.0F, 0.001F}) {
    auto moved = origins;
    for (Origin& origin : moved) origin.position *= glm::vec4(glm::vec3(factor), 1.0F);
    expect_near(MapBench(scaled(scene, factor)), 48, moved, 0.01);
  }
}

TEST(HemicubeMaps, SayWhatTheDeviceAllows) {
  const MapBench bench(empty_box());
  const auto& context = bench.context();
  const auto limit_px = context->limits().texture_size_px;
  shadow_maps::HemisphereMaps maps(context, 64, 1);
  const auto buffer =
      opengl::Buffer::of(context, std::span<const Origin>(origins_on_surfaces(bench.scene(), 1)));
  shadow_maps::HemicubeMaps filler(context,
                                   {.face_scale = static_cast<float>(limit_px / 2 + 2) / 64.0F});
  std::string message;
  try {
    filler.fill(maps, bench.gpu(), {&buffer, 2}, 0, 1);
  } catch (const UnsupportedError& error) {
    message = error.what();
  }
  EXPECT_EQ(message, fmt::format("hemicubes of {0} x {0} px: {1} allows {2} px", limit_px / 2 + 2,
                                 context->facts().renderer, limit_px / 2));
}

}  // namespace
}  // namespace renderers::test
