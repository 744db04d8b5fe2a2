#include "renderers/path_tracing/light_vertex.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "renderers/contract/stage_timer.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "tests/renderers/scene_builder.h"

/// Light vertices against closed forms, and what connecting to them is for.
namespace renderers::test {
namespace {

using path_tracing::LightVertexSampler;

constexpr double kPi = std::numbers::pi;
constexpr float kHeight_m = 0.5F;

scene::Light spot_above_floor() {
  scene::Light spot;
  spot.type = scene::LightType::spot;
  spot.position = {0.2F, kHeight_m, -0.1F};
  spot.direction = {0, -1, 0};
  spot.intensity = glm::vec3(2.0F);
  spot.inner_cone_rad = 0.4F;
  spot.outer_cone_rad = 0.9F;
  return spot;
}

/// A wide floor, a point light of 1 W/sr on the left, and a spot light.
SceneBuilder lit_floor() {
  SceneBuilder builder;
  builder.add_quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.5F))));
  builder.add_point_light({-3, kHeight_m, 0}, glm::vec3(1.0F));
  builder.scene.lights.push_back(spot_above_floor());
  return builder;
}

struct Samplers {
  explicit Samplers(const scene::Scene& scene)
      : rays(scene, timer), lights(rays), vertices(rays, lights) {}

  StageTimer timer;
  ray_tracing::RayScene rays;
  ray_tracing::LightSampler lights;
  LightVertexSampler vertices;
};

/// Calls body(vertex) for each of a number of light vertices, those that there are.
template <typename Body>
void for_each_vertex(const LightVertexSampler& sampler, int count, const Body& body) {
  for (int i = 0; i < count; ++i) {
    ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::sobol, 5,
                                        static_cast<std::uint64_t>(i));
    if (const auto vertex = sampler.sample(glm::vec3(numbers.next()))) body(*vertex);
  }
}

TEST(LightVertex, MeanPowerOnADiskIsTheFluxOfTheLights) {
  const SceneBuilder builder = lit_floor();
  const Samplers samplers(builder.scene);
  ASSERT_FALSE(samplers.vertices.is_empty());
  constexpr int kCount = 1 << 16;
  constexpr double kRadius_m = 0.3;
  double below_point = 0.0;
  double of_spot = 0.0;
  for_each_vertex(samplers.vertices, kCount, [&](const path_tracing::LightVertex& vertex) {
    const double x = static_cast<double>(vertex.point.position.x);
    const double z = static_cast<double>(vertex.point.position.z);
    const auto power = static_cast<double>(vertex.power.x) / kCount;
    if (std::hypot(x + 3.0, z) < kRadius_m) below_point += power;
    if (std::hypot(x - 0.2, z + 0.1) < 2.0) of_spot += power;
  });
  // The cone of the disk: 2 pi (1 - cos).
  const double cosine = static_cast<double>(kHeight_m) / std::hypot(0.5, kRadius_m);
  EXPECT_NEAR(below_point, 2.0 * kPi * (1.0 - cosine), 0.01);
  // Smooth between the cones: the flux of a hard cone at the mean cosine; the point light adds the
  // solid angle of the disk seen from the side.
  const double mean_cosine = 0.5 * (std::cos(0.4) + std::cos(0.9));
  const double spot_flux = 2.0 * 2.0 * kPi * (1.0 - mean_cosine);
  double point_on_spot = 0.0;
  constexpr int kCells = 1000;
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const double x = 0.2 + 4.0 * ((i + 0.5) / kCells - 0.5);
      const double z = -0.1 + 4.0 * ((j + 0.5) / kCells - 0.5);
      if (std::hypot(x - 0.2, z + 0.1) >= 2.0) continue;
      const double d2 = (x + 3.0) * (x + 3.0) + z * z + 0.25;
      point_on_spot += 16.0 / (kCells * kCells) * 0.5 / (d2 * std::sqrt(d2));
    }
  }
  EXPECT_NEAR(of_spot, spot_flux + point_on_spot, 0.02);
}

TEST(LightVertex, DensityIsTheOneThatThePointIsAskedFor) {
  const SceneBuilder builder = lit_floor();
  const Samplers samplers(builder.scene);
  int found = 0;
  for_each_vertex(samplers.vertices, 256, [&](const path_tracing::LightVertex& vertex) {
    // Which light it was follows from where its ray points.
    const glm::vec3 to_point = builder.scene.lights[0].position - vertex.point.position;
    const bool is_point = glm::dot(glm::normalize(to_point), vertex.to_light) > 0.9999F;
    const std::uint32_t light = is_point ? 0 : 1;
    const float pdf = samplers.vertices.pdf(light, vertex.point, vertex.to_light);
    EXPECT_NEAR(pdf, vertex.pdf, 1e-3F * vertex.pdf);
    EXPECT_EQ(vertex.light_probability, samplers.lights.probability_of(light));
    // Power over density is irradiance over cosine: I / d2.
    const glm::vec3 way = builder.scene.lights[light].position - vertex.point.position;
    const float expected =
        scene::intensity_towards(builder.scene.lights[light], -vertex.to_light).x /
        glm::dot(way, way);
    EXPECT_NEAR(vertex.power.x * vertex.pdf / vertex.cosine, expected, 1e-3F * expected);
    ++found;
  });
  EXPECT_GT(found, 100);
}

TEST(LightVertex, ThereAreNoneWithoutPointOrSpotLights) {
  SceneBuilder builder;
  builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F))));
  EXPECT_TRUE(Samplers(builder.scene).vertices.is_empty());
}

/// A closed box with a lamp close to its ceiling.
SceneBuilder lamp_by_the_ceiling() {
  SceneBuilder builder;
  const int grey = builder.add_material(lambert(glm::vec3(0.7F)));
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F), grey, true);
  builder.add_point_light({0.3F, 0.95F, 0.2F}, glm::vec3(1.0F));
  builder.look({0, -0.2F, -0.9F}, {0, -0.6F, 1}, 60.0F);
  return builder;
}

double mean_variance(const Frame& frame) { return mean_of(aov(frame, "variance")); }

TEST(LightRays, FindTheLightThatALampCastsOnTheCeilingBesideIt) {
  const SceneBuilder builder = lamp_by_the_ceiling();
  RenderRequest request{
      .settings = {"light_rays=false"}, .width_px = 32, .height_px = 32, .samples = 64};
  const Frame without = render(builder.scene, request);
  request.settings = {"light_rays=true"};
  const Frame with = render(builder.scene, request);
  EXPECT_LT(mean_variance(with), 0.25 * mean_variance(without));
  EXPECT_TRUE(agree(mean_of(with), mean_of(without), 0.05));
}

TEST(LightRays, LeaveDirectLightAsItIs) {
  const SceneBuilder builder = lamp_by_the_ceiling();
  const Frame without =
      render(builder.scene, {.settings = {"pixel=centre", "light_rays=false"}, .samples = 4});
  const Frame with =
      render(builder.scene, {.settings = {"pixel=centre", "light_rays=true"}, .samples = 4});
  EXPECT_EQ(aov(with, "direct").pixels, aov(without, "direct").pixels);
  EXPECT_NE(aov(with, "indirect").pixels, aov(without, "indirect").pixels);
}

TEST(LightRays, KeepTheirMeanWhereSurfacesShine) {
  // A glossy plate close to the lamp, seen in a glossy floor: both lobes are in both ways' weights.
  SceneBuilder builder;
  const int floor = builder.add_material(phong(glm::vec3(0.3F), glm::vec3(0.5F), 40.0F));
  const int plate = builder.add_material(ggx(glm::vec3(0.2F), glm::vec3(0.6F), 0.3F));
  builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, floor);
  builder.add_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, plate);
  builder.add_point_light({0.2F, 0.8F, 0.1F}, glm::vec3(1.0F));
  builder.look({0.8F, 0.5F, 0.3F}, {-0.2F, 0, 0}, 30.0F);
  for (const char* transport : {"transport=one_bounce", "transport=full"}) {
    RenderRequest request{.settings = {transport, "part=indirect", "light_rays=false"},
                          .width_px = 24,
                          .height_px = 24,
                          .samples = 1024};
    const Mean without = mean_of(render(builder.scene, request));
    request.settings.back() = "light_rays=true";
    request.seed = 3;
    const Mean with = mean_of(render(builder.scene, request));
    EXPECT_TRUE(agree(with, without, 0.01))
        << transport << ' ' << to_string(with) << ' ' << to_string(without);
  }
}

}  // namespace
}  // namespace renderers::test
