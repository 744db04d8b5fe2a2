#include "renderers/ray_tracing/light_sampler.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/light_cone.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::ray_tracing {
namespace {

TEST(PiecewiseDistribution, ChoosesInProportionAndNeverNothing) {
  const std::vector<double> weights{0.0, 1.0, 0.0, 3.0, 0.0};
  const PiecewiseDistribution distribution(weights);
  EXPECT_EQ(distribution.total(), 4.0);
  EXPECT_FLOAT_EQ(distribution.probability(1), 0.25F);
  std::array<int, 5> counts{};
  for (int i = 0; i < 4000; ++i) {
    const auto choice = distribution.choose(static_cast<float>(i) / 4000.0F);
    counts[choice.index] += 1;
    EXPECT_GE(choice.rest, 0.0F);
    EXPECT_LT(choice.rest, 1.0F);
    EXPECT_EQ(choice.probability, distribution.probability(choice.index));
  }
  EXPECT_EQ(counts, (std::array<int, 5>{0, 1000, 0, 3000, 0}));
  EXPECT_EQ(distribution.choose(1.0F - 0x1p-24F).index, 3U);
}

TEST(PiecewiseDistribution, WithoutWeightHasNoTotal) {
  EXPECT_EQ(PiecewiseDistribution(std::vector<double>{0.0, 0.0}).total(), 0.0);
  EXPECT_EQ(PiecewiseDistribution(std::vector<double>{}).total(), 0.0);
}

/// Sphere of directions around -y in bands, midpoint rule; W.
double integral_of_intensity(const scene::Light& light) {
  constexpr int kBands = 20000;
  double sum = 0.0;
  for (int i = 0; i < kBands; ++i) {
    const double cosine = 1.0 - (2.0 * i + 1.0) / kBands;
    const double sine = std::sqrt(1.0 - cosine * cosine);
    sum += static_cast<double>(scene::intensity_towards(light, glm::vec3(sine, -cosine, 0.0)).x);
  }
  return 4.0 * std::numbers::pi * sum / kBands;
}

TEST(LightCone, FluxIsTheIntegralOfTheIntensity) {
  scene::Light light;
  light.intensity = glm::vec3(3.0F);
  EXPECT_NEAR(3.0 * flux_solid_angle_sr(light), integral_of_intensity(light), 1e-4);
  light.type = scene::LightType::spot;
  light.inner_cone_rad = 0.3F;
  light.outer_cone_rad = 1.1F;
  EXPECT_NEAR(3.0 * flux_solid_angle_sr(light), integral_of_intensity(light), 1e-3);
  // Less than all that its cone could take.
  EXPECT_LT(flux_solid_angle_sr(light), 0.8 * static_cast<double>(solid_angle_sr(light)));
}

scene::Environment spotted_environment() {
  scene::Environment environment;
  environment.image = perception::make_rgb_image(12, 6, perception::Encoding::scene_linear);
  for (int c = 0; c < 3; ++c) {
    environment.image.at(0, 1, c) = 50.0F;
    environment.image.at(7, 3, c) = 5.0F;
    environment.image.at(7, 5, c) = 9.0F;
  }
  environment.rotation_rad = 1.1F;
  return environment;
}

TEST(EnvironmentSampler, SampleAndDensityAgree_AndIntegrateToOne) {
  const scene::Environment environment = spotted_environment();
  const EnvironmentSampler sampler(environment);
  int different = 0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const glm::vec4 u = SampleSequence(SequenceKind::sobol, 4, i).next();
    const auto drawn = sampler.sample({u.x, u.y});
    ASSERT_GT(drawn.pdf, 0.0F);
    EXPECT_NEAR(glm::length(drawn.direction), 1.0F, 1e-5F);
    const float density = sampler.pdf(drawn.direction);
    different += std::fabs(density - drawn.pdf) > 1e-2F * drawn.pdf ? 1 : 0;
  }
  // Within rounding of a cell's edge the direction may fall into the neighbour.
  EXPECT_LE(different, 4);
  double sum = 0.0;
  constexpr int kRows = 600;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < 2 * kRows; ++column) {
      const float v = (static_cast<float>(row) + 0.5F) / kRows;
      const glm::vec2 position((static_cast<float>(column) + 0.5F) / (2.0F * kRows), v);
      const glm::vec3 direction = scene::environment_direction(environment, position);
      sum += static_cast<double>(sampler.pdf(direction) * std::sin(kPi * v));
    }
  }
  const double cell = 2.0 * 9.8696044 / (2.0 * kRows * kRows);
  EXPECT_NEAR(sum * cell, 1.0, 2e-3);
}

TEST(EnvironmentSampler, NoDirectionWithLightHasDensityZero) {
  const scene::Environment environment = spotted_environment();
  const EnvironmentSampler sampler(environment);
  int lit = 0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const glm::vec4 u = SampleSequence(SequenceKind::sobol, 8, i).next();
    const glm::vec3 direction = scene::environment_direction(environment, {u.x, u.y});
    if (scene::sample_environment(environment, direction).x <= 0.0F) continue;
    ++lit;
    EXPECT_GT(sampler.pdf(direction), 0.0F);
  }
  EXPECT_GT(lit, 1000);
}

TEST(LightSampler, DensitiesOfSampleAndHitAgree) {
  test::SceneBuilder builder;
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  const int strong = builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(7.0F)));
  builder.add_quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, lamp);
  builder.add_quad({3, 2, -1}, {1, 0, 0}, {0, 0, 1}, strong);
  builder.set_environment(glm::vec3(0.2F));
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  const LightSampler lights(rays);
  SurfacePoint from;
  from.geometric_normal = {0, 1, 0};
  std::array<int, 2> kinds{};
  for (std::uint32_t i = 0; i < 500; ++i) {
    const glm::vec4 u = SampleSequence(SequenceKind::sobol, 8, i).next();
    const auto sample = lights.sample(from, glm::vec3(u));
    if (!sample || sample->direction.y <= 0.0F) continue;
    Hit hit;
    // A sample of the environment may point at a lamp: it is occluded, not of interest here.
    const bool is_from_lamp = std::isfinite(sample->shadow_ray.t_max);
    const bool hits_lamp = rays.intersect({from.position, sample->direction}, hit);
    if (is_from_lamp) {
      kinds[0] += 1;
      ASSERT_TRUE(hits_lamp);
      const float density = lights.pdf_of_emission(hit, sample->direction, hit.t);
      EXPECT_NEAR(density, sample->pdf, 1e-4F * density);
    } else if (!hits_lamp) {
      kinds[1] += 1;
      EXPECT_NEAR(lights.pdf_of_environment(sample->direction), sample->pdf, 1e-3F * sample->pdf);
    }
  }
  EXPECT_GT(kinds[0], 50);
  EXPECT_GT(kinds[1], 5);
}

TEST(LightSampler, HittableSetLeavesPointLightsOut) {
  test::SceneBuilder builder;
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  builder.add_quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, lamp);
  builder.add_point_light({0, 1, 0}, glm::vec3(100.0F));
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  const LightSampler all(rays);
  const LightSampler hittable(rays, LightSet::hittable);
  SurfacePoint from;
  from.geometric_normal = {0, 1, 0};
  int deltas = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const glm::vec3 u(SampleSequence(SequenceKind::sobol, 8, i).next());
    deltas += all.sample(from, u)->is_delta ? 1 : 0;
    const auto sample = hittable.sample(from, u);
    ASSERT_TRUE(sample);
    EXPECT_FALSE(sample->is_delta);
    // Both triangles, by area alone: 1 / 4 m2 each.
    const float cosine = sample->direction.y;
    const float distance_m = 2.0F / cosine;
    EXPECT_NEAR(sample->pdf, 0.25F * distance_m * distance_m / cosine, 1e-4F * sample->pdf);
  }
  EXPECT_GT(deltas, 150);
  // Without area lights and environment the set is empty.
  builder.scene.objects.clear();
  const RayScene bare(builder.scene, timer);
  EXPECT_TRUE(LightSampler(bare, LightSet::hittable).is_empty());
  EXPECT_FALSE(LightSampler(bare).is_empty());
}

TEST(LightSampler, AGivenPointLightIsIntensityOverSquaredDistance) {
  test::SceneBuilder builder;
  builder.add_point_light({0, 3, 4}, {50, 25, 100});
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  const LightSampler lights(rays);
  SurfacePoint from;
  from.geometric_normal = {0, 1, 0};
  const auto sample = lights.sample_point_light(builder.scene.lights[0], from);
  ASSERT_TRUE(sample);
  EXPECT_TRUE(sample->is_delta);
  EXPECT_EQ(sample->pdf, 1.0F);
  EXPECT_FLOAT_EQ(sample->radiance.x, 2.0F);
  EXPECT_FLOAT_EQ(sample->radiance.z, 4.0F);
  EXPECT_FLOAT_EQ(sample->direction.z, 0.8F);
  from.position = {0, 3, 4};
  EXPECT_FALSE(lights.sample_point_light(builder.scene.lights[0], from));
}

TEST(LightSampler, SeesNoLightWhereThereIsNone) {
  test::SceneBuilder builder;
  builder.add_quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2},
                   builder.add_material(test::lambert(glm::vec3(0.5F))));
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  const LightSampler lights(rays);
  EXPECT_TRUE(lights.is_empty());
  EXPECT_FALSE(lights.can_be_hit());
}

}  // namespace
}  // namespace renderers::ray_tracing
