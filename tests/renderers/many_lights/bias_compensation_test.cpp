#include "renderers/many_lights/bias_compensation.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/many_lights/ray_cast_inputs.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::many_lights {
namespace {

using ray_tracing::LightSampler;
using ray_tracing::RayScene;
using ray_tracing::SampleSequence;
using ray_tracing::SequenceKind;
using test::SceneBuilder;

constexpr int kSide_px = 16;
constexpr float kClamp = 1.5F;  // 1/m2: rays of up to 0.8 m in a room of 2 m

/// A corner of three walls with a block in it, lit by all kinds of light.
SceneBuilder corner(const scene::Material& floor) {
  SceneBuilder builder;
  const int floors = builder.add_material(floor);
  const int walls = builder.add_material(test::lambert({0.7F, 0.5F, 0.4F}));
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.3F), {8, 7, 6}));
  builder.add_quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, floors);
  builder.add_quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, walls);
  builder.add_quad({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, walls);
  builder.add_box({-0.6F, -1, 0.2F}, {-0.1F, -0.4F, 0.7F}, walls, false);
  builder.add_sphere({0.4F, -0.7F, 0.4F}, 0.3F, 16, walls);
  builder.add_quad({-0.3F, 0.9F, -0.3F}, {0.6F, 0, 0}, {0, 0, 0.6F}, lamp);
  builder.add_point_light({0.7F, 0.3F, -0.6F}, glm::vec3(1.5F));
  builder.set_environment(glm::vec3(0.3F));
  builder.look({1.2F, 0.8F, -2}, {-0.3F, -0.5F, 0.5F}, 40.0F);
  return builder;
}

/// Per-pixel mean and variance of that mean over batches with seeds of their own.
struct Estimate {
  explicit Estimate(std::size_t values) : sum(values), squares(values) {}
  void add(std::size_t i, double value) {
    sum[i] += value;
    squares[i] += value * value;
  }
  double mean(std::size_t i) const { return sum[i] / kBatches; }
  double variance(std::size_t i) const {
    return std::max(0.0, squares[i] / kBatches - mean(i) * mean(i)) / (kBatches - 1);
  }

  static constexpr int kBatches = 16;
  std::vector<double> sum;
  std::vector<double> squares;
};

constexpr std::size_t kValues = std::size_t{3} * kSide_px * kSide_px;

/// What the clamp takes from the path tracer's one bounce: the same paths with and without it.
Estimate loss_of_paths(const scene::Scene& scene, std::int64_t samples) {
  Estimate loss(kValues);
  for (int batch = 0; batch < Estimate::kBatches; ++batch) {
    test::RenderRequest request{.settings = {"transport=one_bounce", "part=indirect"},
                                .width_px = kSide_px,
                                .height_px = kSide_px,
                                .samples = samples,
                                .seed = static_cast<std::uint64_t>(50 + batch)};
    const Frame open = test::render(scene, request);
    request.settings.push_back("geometry_clamp=" + std::to_string(kClamp));
    const Frame clamped = test::render(scene, request);
    for (std::size_t i = 0; i < kValues; ++i) {
      loss.add(i, static_cast<double>(open.radiance.pixels[i]) -
                      static_cast<double>(clamped.radiance.pixels[i]));
    }
  }
  return loss;
}

/// The compensation, averaged over positions within the pixels, as the path tracer's box filter
/// covers them.
Estimate compensation(const scene::Scene& scene, float clamp, int rays_per_position) {
  constexpr std::uint32_t kPositions = 16;
  StageTimer timer;
  const RayScene rays(scene, timer);
  const LightSampler lights(rays);
  Estimate made(kValues);
  for (int batch = 0; batch < Estimate::kBatches; ++batch) {
    const auto seed = static_cast<std::uint64_t>(batch);
    std::vector<double> sum(kValues);
    for (std::uint32_t position = 0; position < kPositions; ++position) {
      const glm::vec4 u = SampleSequence(SequenceKind::sobol, seed, position).next();
      const SurfaceImage surfaces =
          test::cast_surfaces(rays, kSide_px, kSide_px, glm::vec2(u) - glm::vec2(0.5F));
      const CompensatedLight light = compensate_bias(rays, lights, surfaces,
                                                     {.geometry_clamp = clamp,
                                                      .rays = rays_per_position,
                                                      .camera_position = scene.camera.position,
                                                      .seed = seed,
                                                      .pass = position});
      for (std::size_t i = 0; i < kValues; ++i) {
        sum[i] += static_cast<double>(light.radiance[i / 3][static_cast<int>(i % 3)]);
      }
    }
    for (std::size_t i = 0; i < kValues; ++i) made.add(i, sum[i] / kPositions);
  }
  return made;
}

struct Agreement {
  double relative = 0.0;   ///< of the image's mean
  double precision = 0.0;  ///< standard error of `relative`
  double mean_z2 = 0.0;    ///< mean of the pixels' squared z
};

Agreement agreement(const Estimate& made, const Estimate& expected) {
  double difference = 0.0;
  double total = 0.0;
  double sigma2 = 0.0;
  double z2 = 0.0;
  int counted = 0;
  for (std::size_t i = 0; i < kValues; ++i) {
    const double delta = made.mean(i) - expected.mean(i);
    const double joint = made.variance(i) + expected.variance(i);
    difference += delta;
    total += expected.mean(i);
    sigma2 += joint;
    if (joint <= 0.0) continue;
    z2 += delta * delta / joint;
    ++counted;
  }
  return {difference / total, std::sqrt(sigma2) / total, z2 / counted};
}

void expect_agreement(const SceneBuilder& builder) {
  const Estimate loss = loss_of_paths(builder.scene, 256);
  const Agreement result = agreement(compensation(builder.scene, kClamp, 16), loss);
  EXPECT_LT(std::fabs(result.relative), 0.01);
  EXPECT_LT(result.precision, 0.005);
  EXPECT_LT(std::fabs(result.relative), 4.5 * result.precision);
  // Variances of 16 values: 15 / 13 if they were Gaussian.
  EXPECT_GT(result.mean_z2, 0.7);
  EXPECT_LT(result.mean_z2, 1.7);
}

TEST(BiasCompensation, IsWhatTheClampTakesFromPathsInALambertCorner) {
  expect_agreement(corner(test::lambert({0.6F, 0.7F, 0.8F})));
}

TEST(BiasCompensation, IsWhatTheClampTakesFromPathsOnAGlossyFloor) {
  expect_agreement(corner(test::phong(glm::vec3(0.3F), {0.6F, 0.5F, 0.4F}, 30.0F)));
}

/// What comes out if short hits count in full, without the weight (G - b) / G: with C(b) the right
/// value, the integral of G where G > b is C(b) - b C'(b), here by a difference quotient.
double mean_without_weight(const scene::Scene& scene) {
  constexpr double kStep = 0.05;
  const Estimate at = compensation(scene, kClamp, 16);
  const Estimate above = compensation(scene, kClamp * (1.0F + static_cast<float>(kStep)), 16);
  double sum = 0.0;
  for (std::size_t i = 0; i < kValues; ++i) {
    sum += at.mean(i) + (at.mean(i) - above.mean(i)) / kStep;
  }
  return sum;
}

TEST(BiasCompensation, HitsWithoutTheirWeightWouldShow) {
  const SceneBuilder builder = corner(test::lambert({0.6F, 0.7F, 0.8F}));
  const Estimate loss = loss_of_paths(builder.scene, 64);
  double expected = 0.0;
  for (std::size_t i = 0; i < kValues; ++i) expected += loss.mean(i);
  EXPECT_GT(mean_without_weight(builder.scene), 1.2 * expected);
}

struct Corner {
  SceneBuilder builder = corner(test::lambert(glm::vec3(0.6F)));
  StageTimer timer;
  RayScene rays{builder.scene, timer};
  LightSampler lights{rays};
  SurfaceImage surfaces = test::cast_surfaces(rays, 33, 17);
  BiasCompensationSettings settings{
      .geometry_clamp = kClamp, .rays = 4, .camera_position = builder.scene.camera.position};

  CompensatedLight compensate() const { return compensate_bias(rays, lights, surfaces, settings); }
};

TEST(BiasCompensation, WithoutClampDoesNothing) {
  Corner corner;
  corner.settings.geometry_clamp = 0.0F;
  const CompensatedLight light = corner.compensate();
  EXPECT_EQ(light.short_rays, 0U);
  EXPECT_EQ(light.shadow_rays, 0U);
  for (const glm::vec4& radiance : light.radiance) EXPECT_EQ(glm::vec3(radiance), glm::vec3(0.0F));
}

TEST(BiasCompensation, AnUnreachableClampKeepsNoHit) {
  Corner corner;
  corner.settings.geometry_clamp = 1e8F;
  const CompensatedLight light = corner.compensate();
  EXPECT_GT(light.short_rays, 1000U);
  EXPECT_EQ(light.kept_hits, 0U);
}

TEST(BiasCompensation, PixelsWithoutSurfaceStayBlack) {
  Corner corner;
  corner.surfaces.position[5] = glm::vec4(0.0F);
  const CompensatedLight light = corner.compensate();
  EXPECT_EQ(light.radiance[5], glm::vec4(0.0F));
  EXPECT_EQ(light.radiance[33 * 12 + 15].w, 1.0F);
  EXPECT_GT(light.kept_hits, 0U);
  EXPECT_LE(light.shadow_rays, light.kept_hits);
  EXPECT_LT(light.kept_hits, light.short_rays);
}

TEST(BiasCompensation, PassesContinueTheSamples_SeedsDiffer_ThreadsDoNot) {
  Corner corner;
  const CompensatedLight whole = corner.compensate();
  for (const int threads : {1, 4}) {
    const base::ThreadLimit limit(threads);
    EXPECT_EQ(corner.compensate().radiance, whole.radiance);
  }
  corner.settings.seed = 2;
  EXPECT_NE(corner.compensate().radiance, whole.radiance);

  corner.settings.seed = 1;
  corner.settings.rays = 1;
  std::vector<glm::vec4> sum(whole.radiance.size());
  for (std::uint32_t pass = 0; pass < 4; ++pass) {
    corner.settings.pass = pass;
    const CompensatedLight part = corner.compensate();
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += 0.25F * part.radiance[i];
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    EXPECT_NEAR(sum[i].x, whole.radiance[i].x, 1e-5F * whole.radiance[i].x);
  }
}

TEST(BiasCompensation, RefusesBadSettings) {
  Corner corner;
  corner.settings.rays = 0;
  EXPECT_EQ(tests::input_error_of([&] { corner.compensate(); }),
            "bias compensation: rays is 0; accepted: 1 and more");
  corner.settings.rays = 1;
  corner.settings.geometry_clamp = -1.0F;
  EXPECT_EQ(tests::input_error_of([&] { corner.compensate(); }),
            "bias compensation: geometry_clamp is -1.000000; accepted: 0 (none) and more, 1/m2");
}

/// A rasteriser may put a receiver of one wall onto the next: a ray then meets that at distance 0.
TEST(BiasCompensation, AReceiverOnTheEdgeOfTwoWallsIsFinite) {
  const SceneBuilder builder = corner(test::lambert(glm::vec3(0.5F)));
  StageTimer timer;
  const RayScene rays(builder.scene, timer);
  const LightSampler lights(rays);
  SurfaceImage surfaces;
  surfaces.width_px = kSide_px;
  surfaces.height_px = 1;
  for (int x = 0; x < kSide_px; ++x) {
    const float along = -0.9F + 0.1F * static_cast<float>(x);
    surfaces.position.push_back({-1.0F, -1.0F, along, 1.0F});
    surfaces.geometric_normal.push_back({0.0F, 1.0F, 0.0F, 0.0F});
    surfaces.shading_normal.push_back({0.0F, 1.0F, 0.0F, 0.0F});
    surfaces.albedo.push_back({0.5F, 0.5F, 0.5F, 0.0F});
  }
  BiasCompensationSettings settings;
  settings.geometry_clamp = kClamp;
  settings.rays = 256;
  for (const glm::vec4& radiance : compensate_bias(rays, lights, surfaces, settings).radiance) {
    EXPECT_TRUE(std::isfinite(radiance.x)) << radiance.x;
  }
}

}  // namespace
}  // namespace renderers::many_lights
