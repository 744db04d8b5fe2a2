#include "renderers/ray_tracing/surface_brdf.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "renderers/ray_tracing/sample_sequence.h"
#include "tests/renderers/ggx_oracle.h"
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

/// Seen along the normal, facets cover what the surface covers (Walter et al. 2007, Eq. 4,
/// recalled).
TEST(GlossyLobe, FacetsOfGgxFillTheirSurface) {
  const glm::vec3 up(0, 0, 1);
  for (const float alpha : {0.2F, 0.6F, 1.0F}) {
    const double area = integrate(
        [&](const glm::vec3& h) {
          return static_cast<double>(ggx_distribution(alpha, up, h) * h.z);
        },
        0.5 * kPiDouble);
    EXPECT_NEAR(area, 1.0, 1e-3) << alpha;
  }
}

TEST(GlossyLobe, GgxIsThatOfTheLiterature) {
  const glm::dvec3 normal(0, 0, 1);
  const glm::dvec3 out = glm::normalize(glm::dvec3(0.4, -0.3, 0.6));
  const glm::dvec3 in = glm::normalize(glm::dvec3(-0.7, 0.1, 0.4));
  for (const double alpha : {0.05, 0.3, 0.8, 1.0}) {
    const double expected = test::ggx_value(alpha, normal, out, in);
    const scene::GlossyLobe lobe{glm::vec3(1.0F), scene::LobeShape::ggx, 0.0F,
                                 static_cast<float>(alpha)};
    const SeenLobe seen = see_lobe(lobe, glm::vec3(normal), glm::vec3(out));
    EXPECT_NEAR(lobe_value(seen, glm::vec3(in)) / expected, 1.0, 1e-4) << alpha;
  }
}

TEST(GlossyLobe, GgxLosesLittleWhenSharpAndNeverGains) {
  for (const double angle : {0.0, 0.6, 1.2, 1.5}) {
    double last = 1.0;
    for (const float alpha : {0.1F, 0.3F, 0.6F, 1.0F}) {
      const double albedo =
          albedo_of(brdf_of(test::ggx(glm::vec3(0.0F), glm::vec3(1.0F), alpha), angle));
      EXPECT_LE(albedo, 1.0 + 1e-3) << alpha << " at " << angle;
      if (angle < 1.0) {
        EXPECT_LT(albedo, last) << alpha << " at " << angle;
      }
      if (angle < 1.0 && alpha < 0.2F) {
        EXPECT_GT(albedo, 0.98) << angle;
      }
      last = albedo;
    }
  }
}

TEST(GlossyLobe, GgxIsReciprocal) {
  const scene::Material material = test::ggx(glm::vec3(0.3F), glm::vec3(0.5F), 0.25F);
  const auto to = brdf_of(material, 0.3);
  const auto from = brdf_of(material, -0.8);
  const glm::vec3 a(std::sin(0.3F), 0.0F, std::cos(0.3F));
  const glm::vec3 b(-std::sin(0.8F), 0.0F, std::cos(0.8F));
  EXPECT_NEAR(evaluate(to, b).x / b.z, evaluate(from, a).x / a.z, 1e-5F);
}

/// Of all draws, those below the surface count as well.
TEST(GlossyLobe, DensityOfGgxIntegratesToOne) {
  for (const double angle : {0.0, 0.7, 1.3}) {
    const auto brdf = brdf_of(test::ggx(glm::vec3(0.3F), glm::vec3(0.4F), 0.4F), angle);
    const double total =
        integrate([&](const glm::vec3& w) { return static_cast<double>(pdf(brdf, w)); }, kPiDouble);
    EXPECT_NEAR(total, 1.0, 1e-3) << angle;
  }
}

TEST(GlossyLobe, SamplesOfGgxFollowTheDensity) {
  for (const float alpha : {0.15F, 0.5F, 1.0F}) {
    const auto brdf = brdf_of(test::ggx(glm::vec3(0.2F), glm::vec3(0.7F), alpha), 1.1);
    double weight_sum = 0.0;
    glm::dvec3 sum(0.0);
    constexpr std::uint32_t kSamples = 1 << 16;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      const glm::vec4 u = SampleSequence(SequenceKind::sobol, 4, i).next();
      const BrdfSample drawn = sample(brdf, u.z, {u.x, u.y});
      ASSERT_GT(drawn.pdf, 0.0F);
      weight_sum += static_cast<double>(drawn.value.x / drawn.pdf);
      sum += glm::dvec3(drawn.direction);
    }
    EXPECT_NEAR(weight_sum / kSamples, albedo_of(brdf), 2e-3) << alpha;
    for (int axis = 0; axis < 3; ++axis) {
      const double mean =
          integrate([&](const glm::vec3& w) { return static_cast<double>(pdf(brdf, w) * w[axis]); },
                    kPiDouble);
      EXPECT_NEAR(sum[axis] / kSamples, mean, 2e-3) << alpha << " axis " << axis;
    }
  }
}

/// Shading normals may turn away from the viewer, who then sees no facet.
TEST(GlossyLobe, GgxIsBlackFromBelowTheShadingNormal) {
  SurfaceBrdf brdf;
  brdf.geometric_normal = {0, 0, 1};
  brdf.normal = glm::normalize(glm::vec3(1.0F, 0.0F, 0.1F));
  const glm::vec3 viewer = glm::normalize(glm::vec3(-1.0F, 0.0F, 0.05F));
  add_glossy_lobe(test::ggx(glm::vec3(0.0F), glm::vec3(0.9F), 0.3F), viewer, brdf);
  for (int i = 0; i < 16; ++i) {
    const float u = static_cast<float>(i) / 16.0F;
    const BrdfSample drawn = sample(brdf, 0.0F, {u, 1.0F - u - 0.03F});
    EXPECT_EQ(drawn.pdf, 0.0F);
    EXPECT_EQ(drawn.value, glm::vec3(0.0F));
    EXPECT_NEAR(glm::length(drawn.direction), 1.0F, 1e-5F);
  }
}

/// Away from the viewer there is no half vector.
TEST(GlossyLobe, DensityOfGgxIsZeroStraightAhead) {
  const auto brdf = brdf_of(test::ggx(glm::vec3(0.0F), glm::vec3(0.9F), 0.3F), 0.4);
  EXPECT_EQ(pdf(brdf, -brdf.glossy.to_viewer), 0.0F);
  EXPECT_EQ(evaluate(brdf, -brdf.glossy.to_viewer), glm::vec3(0.0F));
}

TEST(GlossyLobe, SharpnessOfGgxAsAnExponent) {
  const scene::GlossyLobe facets{glm::vec3(1.0F), scene::LobeShape::ggx, 0.0F, 0.1F};
  const scene::GlossyLobe phong{glm::vec3(1.0F), scene::LobeShape::phong,
                                equivalent_exponent(facets), 0.0F};
  const glm::vec3 up(0, 0, 1);
  EXPECT_NEAR(equivalent_exponent(facets), 48.0F, 1e-4F);
  EXPECT_NEAR(lobe_value(see_lobe(facets, up, up), up), lobe_value(see_lobe(phong, up, up), up),
              1e-4F);
  EXPECT_EQ(equivalent_exponent(phong), phong.exponent);
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
