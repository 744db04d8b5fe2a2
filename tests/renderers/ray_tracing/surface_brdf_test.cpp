#include "renderers/ray_tracing/surface_brdf.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "renderers/ray_tracing/sample_sequence.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::ray_tracing {
namespace {

constexpr double kPiDouble = 3.14159265358979323846;

SurfaceBrdf brdf_of(const scene::Material& material, double viewer_angle_rad,
                    Lobes lobes = Lobes::all) {
  scene::Scene scene;
  scene.materials.push_back(material);
  SurfacePoint point;
  point.geometric_normal = {0, 0, 1};
  point.shading_normal = {0, 0, 1};
  const glm::vec3 viewer(static_cast<float>(std::sin(viewer_angle_rad)), 0.0F,
                         static_cast<float>(std::cos(viewer_angle_rad)));
  return make_brdf(scene, point, viewer, lobes);
}

/// Integral over the hemisphere around +z (or the sphere) by the midpoint rule.
double integrate(const std::function<double(const glm::vec3&)>& value, double polar_end) {
  constexpr int kRows = 800;
  constexpr int kColumns = 800;
  double sum = 0.0;
  for (int row = 0; row < kRows; ++row) {
    const double polar = polar_end * (row + 0.5) / kRows;
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = 2.0 * kPiDouble * (column + 0.5) / kColumns;
      const glm::vec3 direction(static_cast<float>(std::sin(polar) * std::cos(azimuth)),
                                static_cast<float>(std::sin(polar) * std::sin(azimuth)),
                                static_cast<float>(std::cos(polar)));
      sum += value(direction) * std::sin(polar);
    }
  }
  return sum * (polar_end / kRows) * (2.0 * kPiDouble / kColumns);
}

double albedo_of(const SurfaceBrdf& brdf) {
  return integrate([&](const glm::vec3& w) { return static_cast<double>(evaluate(brdf, w).x); },
                   0.5 * kPiDouble);
}

TEST(SurfaceBrdf, LobeReflectsItsAlbedoAtNormalIncidence) {
  for (const float exponent : {0.0F, 1.0F, 10.0F, 100.0F}) {
    const auto brdf = brdf_of(test::phong(glm::vec3(0.0F), glm::vec3(0.7F), exponent), 0.0);
    EXPECT_NEAR(albedo_of(brdf), 0.7, 2e-4) << exponent;
    EXPECT_GT(std::fabs(albedo_of(brdf) * (exponent + 1.0) / (exponent + 2.0) - 0.7), 5e-3)
        << "the normalisation of the density, n + 1, must not pass for that of the BRDF";
  }
}

TEST(SurfaceBrdf, LobeLosesEnergyAtGrazingIncidenceAndNeverGains) {
  double last = 1.0;
  for (const double angle : {0.0, 0.5, 1.0, 1.4}) {
    const double albedo =
        albedo_of(brdf_of(test::phong(glm::vec3(0.0F), glm::vec3(1.0F), 20.0F), angle));
    EXPECT_LE(albedo, last + 1e-4);
    last = albedo;
  }
  EXPECT_LT(last, 0.6);
}

TEST(SurfaceBrdf, LambertReflectsItsAlbedo) {
  EXPECT_NEAR(albedo_of(brdf_of(test::lambert(glm::vec3(0.4F)), 1.0)), 0.4, 1e-5);
}

TEST(SurfaceBrdf, IsReciprocal) {
  const scene::Material material = test::phong(glm::vec3(0.3F), glm::vec3(0.5F), 15.0F);
  const auto to = brdf_of(material, 0.3);
  const auto from = brdf_of(material, -0.8);
  const glm::vec3 a(std::sin(0.3F), 0.0F, std::cos(0.3F));
  const glm::vec3 b(-std::sin(0.8F), 0.0F, std::cos(0.8F));
  EXPECT_NEAR(evaluate(to, b).x / b.z, evaluate(from, a).x / a.z, 1e-5F);
}

TEST(SurfaceBrdf, DensityIntegratesToOne) {
  for (const double angle : {0.0, 0.7, 1.3}) {
    const auto brdf = brdf_of(test::phong(glm::vec3(0.3F), glm::vec3(0.4F), 8.0F), angle);
    const double total =
        integrate([&](const glm::vec3& w) { return static_cast<double>(pdf(brdf, w)); }, kPiDouble);
    EXPECT_NEAR(total, 1.0, 1e-4) << angle;
  }
}

TEST(SurfaceBrdf, SamplesFollowTheDensity) {
  const auto brdf = brdf_of(test::phong(glm::vec3(0.3F), glm::vec3(0.4F), 8.0F), 0.9);
  double weight_sum = 0.0;
  double x_sum = 0.0;
  constexpr std::uint32_t kSamples = 1 << 16;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const glm::vec4 u = SampleSequence(SequenceKind::sobol, 4, i).next();
    const BrdfSample drawn = sample(brdf, u.z, {u.x, u.y});
    EXPECT_NEAR(drawn.pdf, pdf(brdf, drawn.direction), 1e-6F);
    weight_sum += static_cast<double>(drawn.value.x / drawn.pdf);
    x_sum += static_cast<double>(drawn.direction.x);
  }
  EXPECT_NEAR(weight_sum / kSamples, albedo_of(brdf), 1e-3);
  const double x_mean = integrate(
      [&](const glm::vec3& w) { return static_cast<double>(pdf(brdf, w) * w.x); }, kPiDouble);
  EXPECT_NEAR(x_sum / kSamples, x_mean, 1e-3);
}

TEST(SurfaceBrdf, BothSidesReflectAlike) {
  scene::Scene scene;
  scene.materials.push_back(test::lambert(glm::vec3(0.5F)));
  SurfacePoint point;
  point.geometric_normal = {0, 0, -1};
  point.shading_normal = {0, 0, -1};
  const auto brdf = make_brdf(scene, point, {0, 0, 1}, Lobes::all);
  EXPECT_FLOAT_EQ(evaluate(brdf, {0, 0, 1}).x, 0.5F / kPi);
  EXPECT_EQ(evaluate(brdf, {0, 0, -1}).x, 0.0F);
}

TEST(SurfaceBrdf, DiffuseLobesLeaveTheGlossOut) {
  const scene::Material material = test::phong(glm::vec3(0.3F), glm::vec3(0.4F), 8.0F);
  EXPECT_NEAR(albedo_of(brdf_of(material, 0.0, Lobes::diffuse)), 0.3, 1e-5);
}

TEST(DirectionSampling, FramesAreOrthonormal) {
  for (const glm::vec3& n : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0),
                             glm::normalize(glm::vec3(1, -2, -1e-7F))}) {
    const Frame3 frame = frame_around(n);
    EXPECT_NEAR(glm::dot(frame.tangent, frame.bitangent), 0.0F, 1e-6F);
    EXPECT_NEAR(glm::dot(frame.tangent, n), 0.0F, 1e-6F);
    EXPECT_NEAR(glm::length(frame.tangent), 1.0F, 1e-6F);
    EXPECT_NEAR(glm::distance(glm::cross(frame.tangent, frame.bitangent), n), 0.0F, 1e-6F);
  }
}

}  // namespace
}  // namespace renderers::ray_tracing
