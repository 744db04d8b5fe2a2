#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "renderers/photon_map/photon_light.h"
#include "renderers/photon_map/photon_tracing.h"
#include "renderers/scene/generators/uniform_number.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"
#include "tests/renderers/scene_builder.h"

/// Photons, their tree and their density, each against what is known; then the renderer against
/// the path tracer.
namespace renderers::test {
namespace {

using photon_map::NearPhoton;
using photon_map::Neighbours;
using photon_map::Photon;
using photon_map::PhotonEmission;
using photon_map::PhotonPaths;
using photon_map::PhotonTree;

constexpr double kPi = 3.14159265358979;

struct Traced {
  explicit Traced(const scene::Scene& scene, std::int64_t photons) : rays(scene, timer) {
    const PhotonEmission emission(rays);
    paths = photon_map::trace_photons(rays, emission, {.photons = photons});
  }
  StageTimer timer;
  ray_tracing::RayScene rays;
  PhotonPaths paths;
};

double power_of(const std::vector<Photon>& photons) {
  double sum = 0.0;
  for (const Photon& photon : photons) sum += static_cast<double>(photon.power.x);
  return sum;
}

/// Every surface reflects the same share r: the light met in all is Phi (1 + r + r^2 + ...).
TEST(PhotonTracing, AClosedBoxMeetsTheSeriesOfItsAlbedo) {
  for (const float albedo : {0.2F, 0.5F, 0.8F}) {
    SceneBuilder builder;
    const int wall = builder.add_material(lambert(glm::vec3(albedo)));
    const int lamp = builder.add_material(lambert(glm::vec3(albedo), glm::vec3(3.0F)));
    builder.add_box({-1, -1, -1}, {1, 1, 1}, wall, true);
    builder.add_quad({-0.25F, 0.99F, -0.25F}, {0.5F, 0, 0}, {0, 0, 0.5F}, lamp);
    builder.add_point_light({0.2F, 0.1F, -0.3F}, glm::vec3(0.5F));
    const Traced traced(builder.scene, 20000);
    const double emitted = kPi * 3.0 * 0.25 + 4.0 * kPi * 0.5;
    const double expected = emitted / (1.0 - static_cast<double>(albedo));
    EXPECT_NEAR(power_of(traced.paths.photons), expected, 0.015 * expected) << albedo;
    EXPECT_EQ(traced.paths.escaped, 0U);
  }
}

scene::Light spot_light(const glm::vec3& position, float cone_rad) {
  scene::Light light;
  light.type = scene::LightType::spot;
  light.position = position;
  light.intensity = glm::vec3(2.0F);
  light.inner_cone_rad = light.outer_cone_rad = cone_rad;
  return light;
}

/// A floor whose shading normals lean by 60 degrees, in a dark box: what it reflects reaches the
/// walls, a quarter of it from below the shading normal.
TEST(PhotonTracing, LeaningNormalsReflectAllOfTheirAlbedo) {
  SceneBuilder builder;
  const int floor = builder.add_quad({-1, 0.1F, -1}, {0, 0, 2}, {2, 0, 0},
                                     builder.add_material(lambert(glm::vec3(0.8F))));
  scene::Object& object = builder.scene.objects[static_cast<std::size_t>(floor)];
  scene::Mesh leaning = *object.mesh;
  leaning.normals.assign(leaning.positions.size(), {std::sqrt(0.75F), 0.5F, 0.0F});
  object.mesh = std::make_shared<const scene::Mesh>(leaning);
  builder.add_box({-1, 0, -1}, {1, 2, 1}, builder.add_material(lambert(glm::vec3(1e-4F))), true);
  builder.scene.lights.push_back(spot_light({0, 1, 0}, 0.5F));
  const Traced traced(builder.scene, 20000);
  double on_floor_w = 0.0;
  double on_walls_w = 0.0;
  for (const Photon& photon : traced.paths.photons) {
    const bool is_on_floor = photon.normal.y > 0.5F;
    (is_on_floor ? on_floor_w : on_walls_w) += static_cast<double>(photon.power.x);
  }
  EXPECT_GT(on_floor_w, 0.4);
  EXPECT_NEAR(on_walls_w / on_floor_w, 0.8, 0.02);
}

/// A spot's intensity over its cone, an environment's radiance over a sphere around the scene.
TEST(PhotonTracing, SpotsAndEnvironmentSendTheirFlux) {
  SceneBuilder spot;
  spot.add_quad({-9, 0, -9}, {0, 0, 18}, {18, 0, 0}, spot.add_material(lambert(glm::vec3(0.1F))));
  spot.scene.lights.push_back(spot_light({0, 1, 0}, 0.5F));
  const double cone = 2.0 * kPi * (1.0 - std::cos(0.5)) * 2.0;
  EXPECT_NEAR(power_of(Traced(spot.scene, 4000).paths.photons), cone, 1e-3 * cone);

  SceneBuilder sky;
  sky.add_sphere({0, 0, 0}, 1.0F, 24, sky.add_material(lambert(glm::vec3(0.5F))));
  sky.set_environment(glm::vec3(0.7F));
  const double over_sphere = kPi * 0.7 * 4.0 * kPi;  // a convex body: pi L per area
  EXPECT_NEAR(power_of(Traced(sky.scene, 40000).paths.photons), over_sphere, 0.02 * over_sphere);
}

TEST(PhotonTracing, PiecesAreJoinedInOrderUpToALimit) {
  const auto pieces = [] {
    std::vector<PhotonPaths> made(3);
    for (std::size_t i = 0; i < 3; ++i) {
      made[i].photons.resize(i + 1);
      made[i].photons.back().power = glm::vec3(static_cast<float>(i + 1));
      made[i].rays = 10;
      made[i].escaped = i;
    }
    return made;
  };
  const PhotonPaths all = photon_map::joined(pieces(), 6);
  ASSERT_EQ(all.photons.size(), 6U);
  EXPECT_EQ(all.photons[0].power.x, 1.0F);
  EXPECT_EQ(all.photons[2].power.x, 2.0F);
  EXPECT_EQ(all.photons[5].power.x, 3.0F);
  EXPECT_EQ(all.rays, 30U);
  EXPECT_EQ(all.escaped, 3U);
  EXPECT_EQ(tests::input_error_of([&] { photon_map::joined(pieces(), 5); }),
            "photon-map: photons are stored 6 times; accepted: at most 5; lower the parameter "
            "photons");
}

std::vector<Photon> scattered_photons(int count, bool on_plane, std::uint64_t seed = 7) {
  std::mt19937_64 engine(seed);
  std::vector<Photon> photons(static_cast<std::size_t>(count));
  for (Photon& photon : photons) {
    photon.position = {scene::uniform(engine, -1.0F, 1.0F),
                       on_plane ? 0.0F : scene::uniform(engine, -1.0F, 1.0F),
                       scene::uniform(engine, -1.0F, 1.0F)};
    photon.power = glm::vec3(4.0F / static_cast<float>(count));
    photon.normal = {0, 1, 0};
    photon.direction = {0, scene::uniform(engine, 0.0F, 1.0F) < 0.3F && !on_plane ? 1.0F : -1.0F,
                        0};
  }
  return photons;
}

TEST(PhotonTree, FindsWhatALookAtAllFinds) {
  const PhotonTree tree(scattered_photons(3000, false));
  std::mt19937_64 engine(3);
  std::vector<NearPhoton> found;
  for (int i = 0; i < 50; ++i) {
    const glm::vec3 at(scene::uniform(engine, -1.0F, 1.0F), scene::uniform(engine, -1.0F, 1.0F),
                       scene::uniform(engine, -1.0F, 1.0F));
    std::vector<float> expected;
    for (const Photon& photon : tree.photons()) {
      const glm::vec3 d = photon.position - at;
      if (photon.direction.y < 0.0F && glm::dot(d, d) < 0.09F) expected.push_back(glm::dot(d, d));
    }
    std::ranges::sort(expected);
    if (expected.size() > 20) expected.resize(20);
    tree.nearest({at, {0, 1, 0}, 20, 0.3F, Neighbours::arriving}, found);
    std::vector<float> distances;
    for (const NearPhoton& photon : found) distances.push_back(photon.distance2_m2);
    std::ranges::sort(distances);
    EXPECT_EQ(distances, expected);
  }
}

/// 4 W over 4 m2: 1 W/m2, whatever the filter.
TEST(PhotonDensity, OfAUniformPlaneIsItsIrradiance) {
  const PhotonTree tree(scattered_photons(20000, true));
  for (const auto kernel : {photon_map::Kernel::none, photon_map::Kernel::cone}) {
    for (const int nearest : {10, 100}) {
      double sum = 0.0;
      std::vector<NearPhoton> found;
      for (int i = 0; i < 100; ++i) {
        const glm::vec3 at(-0.5F + 0.1F * static_cast<float>(i % 10), 0.0F,
                           -0.5F + 0.1F * static_cast<float>(i / 10));
        const glm::vec3 light = photon_map::photon_irradiance(
            tree, {nearest, 1.0F, kernel, Neighbours::same_surface}, at, {0, 1, 0}, found);
        sum += static_cast<double>(light.x) / 100.0;
      }
      EXPECT_NEAR(sum, 1.0, 0.05) << nearest;
    }
  }
}

/// Mean over a uniform plane of the irradiance of the nearest place, over the truth, 1 W/m2.
double mean_irradiance(const PhotonTree& photons, int nearest, std::vector<Photon> places) {
  const PhotonTree irradiances = photon_map::irradiance_tree(
      photons, {nearest, 1.0F, photon_map::Kernel::cone, Neighbours::same_surface},
      std::move(places));
  constexpr int kSide = 40;
  std::vector<NearPhoton> found;
  double sum = 0.0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const glm::vec3 at(-0.7F + 1.4F * static_cast<float>(i % kSide) / kSide, 0.0F,
                       -0.7F + 1.4F * static_cast<float>(i / kSide) / kSide);
    irradiances.nearest({at, {0, 1, 0}, 1, 1.0F, Neighbours::same_surface}, found);
    sum += static_cast<double>(irradiances.at(found.front().index).power.x);
  }
  return sum / (kSide * kSide);
}

/// At their own places estimates count one photon too many: 1.2 of the truth with 10.
TEST(PhotonDensity, IrradiancesBeforehandHaveNoBias) {
  constexpr int kSets = 5;
  for (const int nearest : {5, 10, 50}) {
    double elsewhere = 0.0;
    double own = 0.0;
    for (std::uint64_t set = 0; set < kSets; ++set) {
      const PhotonTree tree(scattered_photons(10000, true, 2 * set));
      elsewhere +=
          mean_irradiance(tree, nearest, scattered_photons(2500, true, 2 * set + 1)) / kSets;
      if (nearest == 10) own += mean_irradiance(tree, nearest, tree.photons()) / kSets;
    }
    EXPECT_NEAR(elsewhere, 1.0, 0.02) << nearest;
    if (nearest == 10) {
      EXPECT_GT(own, 1.1);
    }
  }
}

/// A lit plane just below is not taken for the surface looked at, and neither is its back.
TEST(PhotonDensity, OtherSurfacesDoNotCount) {
  const PhotonTree tree(scattered_photons(2000, true));
  std::vector<NearPhoton> found;
  const auto light_at = [&](const glm::vec3& at, const glm::vec3& normal, Neighbours neighbours) {
    return photon_map::photon_irradiance(tree, {50, 0.3F, photon_map::Kernel::none, neighbours}, at,
                                         normal, found)
        .x;
  };
  EXPECT_GT(light_at({0, 0, 0}, {0, 1, 0}, Neighbours::same_surface), 0.7F);
  EXPECT_EQ(light_at({0, 0, 0}, {0, -1, 0}, Neighbours::arriving), 0.0F);
  const glm::vec3 tilted = glm::normalize(glm::vec3(1.0F, 0.5F, 0.0F));
  EXPECT_GT(light_at({0, 0, 0}, tilted, Neighbours::arriving), 0.7F);
  EXPECT_EQ(light_at({0, 0, 0}, tilted, Neighbours::same_surface), 0.0F);
}

Frame photon_map_of(const scene::Scene& scene, std::vector<std::string> settings,
                    std::int64_t samples = 2, int threads = 0, std::uint64_t seed = 1) {
  settings.emplace_back("photons=20000");
  return render(scene, {.renderer = "photon-map",
                        .settings = settings,
                        .width_px = 16,
                        .height_px = 16,
                        .samples = samples,
                        .seed = seed,
                        .threads = threads});
}

TEST(PhotonMap, AgreesWithThePathTracer) {
  const SceneBuilder builder = lit_room();
  const Frame truth =
      render(builder.scene,
             {.settings = {"transport=diffuse"}, .width_px = 16, .height_px = 16, .samples = 256});
  const double direct = mean_of(aov(truth, "direct"));
  const double indirect = mean_of(aov(truth, "indirect"));
  for (const std::vector<std::string>& settings :
       {std::vector<std::string>{"nearest=30", "gather_rays=16"},
        {"nearest=30", "gather_rays=4", "precompute_every=0", "gather_sequence=strata",
         "near_radii=0"}}) {
    const Frame frame = photon_map_of(builder.scene, settings, 16);
    EXPECT_NEAR(mean_of(aov(frame, "direct")), direct, 0.02 * direct);
    EXPECT_NEAR(mean_of(aov(frame, "indirect")), indirect, 0.04 * indirect);
  }
}

TEST(PhotonMap, GlossyLobesSeeThePhotons) {
  SceneBuilder builder = closed_room();
  builder.scene.materials[0] = phong(glm::vec3(0.3F), glm::vec3(0.5F), 20.0F);
  const Frame truth = render(builder.scene, {.settings = {"transport=diffuse", "part=indirect"},
                                             .width_px = 16,
                                             .height_px = 16,
                                             .samples = 256});
  const Frame frame = photon_map_of(builder.scene, {"part=indirect", "nearest=30"}, 4);
  EXPECT_NEAR(mean_of(frame.radiance), mean_of(truth.radiance), 0.05 * mean_of(truth.radiance));
}

TEST(PhotonMap, SameBytesForEveryNumberOfThreads) {
  const SceneBuilder builder = lit_room();
  const Frame one = photon_map_of(builder.scene, {"gather_rays=4"}, 2, 1);
  const Frame two = photon_map_of(builder.scene, {"gather_rays=4"}, 2, 2);
  EXPECT_EQ(one.radiance.pixels, two.radiance.pixels);
  const Frame other = photon_map_of(builder.scene, {"gather_rays=4"}, 2, 2, 2);
  EXPECT_NE(one.radiance.pixels, other.radiance.pixels);
  EXPECT_EQ(counter(one, "photons"), 20000.0);
  EXPECT_GT(counter(one, "photons_stored"), 20000.0);
}

/// Another view keeps the map: its rays are those of the first picture alone.
TEST(PhotonMap, AnotherViewDoesNotCountTheMapAgain) {
  const SceneBuilder builder = lit_room();
  const RendererInfo& info = find_renderer("photon-map", {});
  const std::unique_ptr<Renderer> renderer = info.create(
      parameters_of("photon-map", {"photons=2000", "samples=1", "precompute_every=2"}), {});
  StageTimer timer;
  renderer->prepare(builder.scene, timer);
  RenderJob job;
  job.width_px = job.height_px = 8;
  job.camera = builder.scene.camera;
  const Frame first = renderer->render(job, timer);
  const Frame second = renderer->render(job, timer);
  EXPECT_EQ(first.radiance.pixels, second.radiance.pixels);
  EXPECT_GT(counter(first, "photon_rays"), 2000.0);
  EXPECT_EQ(counter(first, "rays"), counter(second, "rays") + counter(first, "photon_rays"));
  EXPECT_EQ(counter(second, "photon_rays"), counter(first, "photon_rays"));
  // Photons and irradiances, 48 bytes and a byte of the tree each.
  EXPECT_GT(counter(first, "photon_bytes"), 1.4 * 49.0 * counter(first, "photons_stored"));
}

TEST(PhotonMap, ADarkSceneIsBlackAndSaysSo) {
  SceneBuilder builder;
  builder.add_quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.5F))));
  builder.look({0, 0, 0}, {0, 0, 1}, 60.0F);
  const Frame frame = photon_map_of(builder.scene, {});
  for (const float value : frame.radiance.pixels) EXPECT_EQ(value, 0.0F);
  ASSERT_EQ(frame.notes.size(), 1U);
  EXPECT_EQ(frame.notes.front(), "no light reaches a surface");
}

}  // namespace
}  // namespace renderers::test
