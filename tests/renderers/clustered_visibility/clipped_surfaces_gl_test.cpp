// What maps leave out below their clip heights: closed forms, and what all three ways of filling
// maps really drop.
#include "renderers/clustered_visibility/clipped_surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "renderers/shadow_maps/hemisphere_projection.h"
#include "renderers/shadow_maps/map_filler.h"
#include "tests/renderers/instant_radiosity/box_scenes.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::clustered_visibility {
namespace {

constexpr double kHemisphere_sr = 2.0 * std::numbers::pi;

/// At the origin, looking along z.
AreaLight light_with(float clip_m) {
  AreaLight area;
  area.position.w = 1.0F;
  area.axis = {0.0F, 0.0F, 1.0F, clip_m};
  return area;
}

/// A rectangle of 2 x 1.2 m above the origin.
scene::Scene lid_at(float height_m) {
  test::SceneBuilder builder;
  builder.add_quad({-1.0F, -0.6F, height_m}, {2.0F, 0.0F, 0.0F}, {0.0F, 1.2F, 0.0F},
                   builder.add_material(test::lambert(glm::vec3(0.5F))));
  return builder.scene;
}

/// Of a rectangle 2 a x 2 b at a distance, seen from its axis (the textbook's).
double rectangle_sr(double a, double b, double distance) {
  return 4.0 * std::asin(a * b /
                         std::sqrt((a * a + distance * distance) * (b * b + distance * distance)));
}

TEST(ClippedSurfaces, ALidCountsIfAndOnlyIfItIsLower) {
  const ClippedSurfaces lower = clipped_surfaces(lid_at(0.3F), {light_with(0.31F)}, 0.0F);
  EXPECT_EQ(lower.triangles, 2);
  EXPECT_NEAR(lower.hemisphere_share, rectangle_sr(1.0, 0.6, 0.3) / kHemisphere_sr, 1e-6);
  // The centre lies above the light.
  const ClippedSurfaces nearer = clipped_surfaces(lid_at(0.3F), {light_with(0.31F)}, 0.1F);
  EXPECT_NEAR(nearer.hemisphere_share, rectangle_sr(1.0, 0.6, 0.2) / kHemisphere_sr, 1e-6);
  for (const auto& [height_m, clip_m] :
       {std::pair{0.3F, 0.29F}, std::pair{-0.1F, 0.3F}, std::pair{0.3F, 0.0F}}) {
    const ClippedSurfaces none = clipped_surfaces(lid_at(height_m), {light_with(clip_m)}, 0.0F);
    EXPECT_EQ(none.triangles, 0) << height_m << " " << clip_m;
    EXPECT_EQ(none.hemisphere_share, 0.0) << height_m << " " << clip_m;
  }
}

TEST(ClippedSurfaces, AWallIsCutAtTheHorizonAndAtTheClipHeight) {
  test::SceneBuilder builder;
  builder.add_quad({0.5F, -2.0F, -3.0F}, {0.0F, 4.0F, 0.0F}, {0.0F, 0.0F, 6.0F},
                   builder.add_material(test::lambert(glm::vec3(0.5F))));
  const ClippedSurfaces clipped = clipped_surfaces(builder.scene, {light_with(0.2F)}, 0.0F);
  EXPECT_EQ(clipped.triangles, 0) << "a part of both is left";
  // Half of a rectangle of 4 x 0.4 m at 0.5 m, whose middle is the horizon.
  EXPECT_NEAR(clipped.hemisphere_share, 0.5 * rectangle_sr(2.0, 0.2, 0.5) / kHemisphere_sr, 1e-6);
}

TEST(ClippedSurfaces, BelowZeroOnlyBacksCount) {
  // The lid looks up, away from the light.
  EXPECT_EQ(clipped_surfaces(lid_at(0.3F), {light_with(-0.31F)}, 0.0F).triangles, 2);
  EXPECT_EQ(clipped_surfaces(lid_at(0.3F), {light_with(-0.29F)}, 0.0F).triangles, 0);
  scene::Scene mirrored = lid_at(0.3F);
  mirrored.objects.front().to_world[0] *= -1.0F;
  EXPECT_EQ(clipped_surfaces(mirrored, {light_with(-0.31F)}, 0.0F).triangles, 2);
  scene::Scene turned = lid_at(-0.3F);
  turned.objects.front().to_world[2] *= -1.0F;
  turned.objects.front().to_world[1] *= -1.0F;
  const ClippedSurfaces none = clipped_surfaces(turned, {light_with(-0.31F)}, 0.0F);
  EXPECT_EQ(none.triangles, 0);
  EXPECT_EQ(clipped_surfaces(turned, {light_with(0.31F)}, 0.0F).triangles, 2);
}

TEST(ClippedSurfaces, AreAMeanOverTheMapsWithLights) {
  AreaLight empty = light_with(0.31F);
  empty.position.w = 0.0F;
  const double one = clipped_surfaces(lid_at(0.3F), {light_with(0.31F)}, 0.0F).hemisphere_share;
  const ClippedSurfaces clipped = clipped_surfaces(
      lid_at(0.3F), {light_with(0.31F), empty, light_with(0.0F), light_with(0.31F)}, 0.0F);
  EXPECT_EQ(clipped.triangles, 4);
  EXPECT_NEAR(clipped.hemisphere_share, one * 2.0 / 3.0, 1e-12);
  EXPECT_EQ(clipped_surfaces(lid_at(0.3F), {empty}, 0.0F).hemisphere_share, 0.0);
}

// What is dropped from maps.

constexpr int kMap_px = 256;

class ClippedMaps : public test::GlTest {
 protected:
  /// Share of the hemisphere in which a map with a clip height sees something else than one
  /// without.
  double dropped_share(const scene::Scene& scene, shadow_maps::DepthBackend backend, float clip_m,
                       float& near_m) const {
    StageTimer timer;
    opengl::GpuScene gpu_scene(context());
    gpu_scene.load(scene, timer);
    shadow_maps::MapFiller filler(context(), backend, {.edge_share = 0.01F});
    filler.load(scene, timer);
    const std::vector<AreaLight> lights{light_with(0.0F), light_with(clip_m)};
    const auto buffer = opengl::Buffer::of(context(), std::span<const AreaLight>(lights));
    shadow_maps::HemisphereMaps maps(context(), kMap_px, 2);
    filler.fill(maps, gpu_scene, {&buffer, kAreaLightStride}, 0, 2);
    near_m = maps.near_m();
    const std::vector<std::uint32_t> all = maps.distances().read_words(0);
    const std::vector<std::uint32_t> clipped = maps.distances().read_words(1);
    double share = 0.0;
    for (int i = 0; i < kMap_px * kMap_px; ++i) {
      const glm::ivec2 texel(i % kMap_px, i / kMap_px);
      if (all[static_cast<std::size_t>(i)] == clipped[static_cast<std::size_t>(i)]) continue;
      share += shadow_maps::hemisphere_texel_solid_angle(texel, kMap_px) / kHemisphere_sr;
    }
    return share;
  }
};

TEST_F(ClippedMaps, DropWhatIsCountedWhateverFillsThem) {
  // A low lid, a wall in part, a high lid; none hides another.
  test::SceneBuilder builder;
  const int white = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_quad({0.2F, 0.1F, 0.4F}, {0.6F, 0.0F, 0.0F}, {0.0F, 0.5F, 0.0F}, white);
  builder.add_quad({-0.7F, -1.0F, -0.5F}, {0.0F, 1.5F, 0.0F}, {0.0F, 0.0F, 2.0F}, white);
  builder.add_quad({-0.3F, -1.5F, 1.5F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, white);
  constexpr float kClip_m = 0.5F;
  for (const auto backend : {shadow_maps::DepthBackend::exact, shadow_maps::DepthBackend::hemicube,
                             shadow_maps::DepthBackend::vertex}) {
    float near_m = 0.0F;
    const double dropped = dropped_share(builder.scene, backend, kClip_m, near_m);
    const ClippedSurfaces counted = clipped_surfaces(builder.scene, {light_with(kClip_m)}, near_m);
    EXPECT_EQ(counted.triangles, 2);
    EXPECT_GT(counted.hemisphere_share, 0.1);
    EXPECT_NEAR(dropped, counted.hemisphere_share, 0.01) << static_cast<int>(backend);
    const ClippedSurfaces other = clipped_surfaces(builder.scene, {light_with(0.3F)}, near_m);
    EXPECT_GT(std::abs(dropped - other.hemisphere_share), 0.05) << "another clip height shows";
    if (backend == shadow_maps::DepthBackend::vertex) continue;
    // The wall faces the light, the lid does not.
    const double backs = dropped_share(builder.scene, backend, -kClip_m, near_m);
    const ClippedSurfaces behind = clipped_surfaces(builder.scene, {light_with(-kClip_m)}, near_m);
    EXPECT_NEAR(backs, behind.hemisphere_share, 0.01) << static_cast<int>(backend);
    EXPECT_LT(backs, dropped - 0.05) << static_cast<int>(backend);
    EXPECT_GT(backs, 0.01) << static_cast<int>(backend);
  }
}

Frame frame_of(const std::vector<std::string>& settings) {
  test::RenderRequest request;
  request.renderer = "clustered-visibility";
  request.settings = {"light_map_px=64", "shadow_map_px=32", "vpls=64", "part=indirect"};
  request.settings.insert(request.settings.end(), settings.begin(), settings.end());
  request.width_px = request.height_px = 8;
  request.samples = 0;
  return test::render(test::spot_in_box(), request);
}
double clipped_share(const std::vector<std::string>& settings) {
  return test::counter(frame_of(settings), "clipped_share");
}

TEST(ClippedSurfaces, AreCountedInFramesWithMaps) {
  // Clusters of several walls lose much, those of one wall next to nothing.
  const double mixed = clipped_share({"vals=2", "normal_weight=0", "clip=all"});
  EXPECT_GT(mixed, 0.05);
  EXPECT_LT(clipped_share({"vals=16", "clip=all"}), 0.1 * mixed);
  EXPECT_EQ(clipped_share({"vals=2", "normal_weight=0", "clip=all", "depth=vertex"}), mixed);
  EXPECT_EQ(clipped_share({"vals=2", "normal_weight=0", "clip=all", "depth=hemicube"}), mixed);
  // Walls face the room, and are kept where maps can tell.
  EXPECT_LT(clipped_share({"vals=2", "normal_weight=0"}), 0.5 * mixed);
  const Frame projected = frame_of({"vals=2", "normal_weight=0", "depth=vertex"});
  EXPECT_EQ(test::counter(projected, "clipped_share"), mixed);
  EXPECT_TRUE(std::ranges::any_of(projected.notes, [](const std::string& note) {
    return note.find("leave out all surfaces") != std::string::npos;
  }));
  EXPECT_EQ(clipped_share({"vals=64", "visibility=hard"}), 0.0) << "a light each";
  const Frame by_rays = frame_of({"vals=2", "visibility=oracle"});
  for (const auto& [name, value] : by_rays.counters) EXPECT_NE(name, "clipped_share") << "no maps";
}

}  // namespace
}  // namespace renderers::clustered_visibility
