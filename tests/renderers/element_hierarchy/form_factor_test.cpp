#include "renderers/element_hierarchy/form_factor.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "renderers/element_hierarchy/spherical_triangle.h"
#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"

/// Form factors against closed forms (Howell's catalogue of radiation view factors, C-11, C-14).
namespace renderers::test {
namespace {

using element_hierarchy::point_form_factor;
using element_hierarchy::vector_form_factor;
using Triangle = std::array<glm::vec3, 3>;

constexpr glm::vec3 kUp(0.0F, 0.0F, 1.0F);

/// A point under the corner of a parallel rectangle a x b at distance c:
/// F = 1 / (2 pi) (A / sqrt(1 + A^2) atan(B / sqrt(1 + A^2)) + the same with A, B swapped).
TEST(FormFactor, OfAParallelRectangleFromBelowItsCorner) {
  const double a = 1.5;
  const double b = 0.7;
  const double c = 0.4;
  const auto term = [](double x, double y) {
    return x / std::sqrt(1.0 + x * x) * std::atan(y / std::sqrt(1.0 + x * x));
  };
  const double expected = (term(a / c, b / c) + term(b / c, a / c)) / (2.0 * std::numbers::pi);
  const glm::vec3 corner(0, 0, 0.4F);
  const glm::vec3 right(1.5F, 0, 0.4F);
  const glm::vec3 far(1.5F, 0.7F, 0.4F);
  const glm::vec3 left(0, 0.7F, 0.4F);
  const double sum = point_form_factor(glm::vec3(0.0F), kUp, {corner, right, far}) +
                     point_form_factor(glm::vec3(0.0F), kUp, {corner, far, left});
  EXPECT_NEAR(sum, expected, 1e-6);
}

TEST(FormFactor, CountsOnlyWhatIsAboveTheHorizon) {
  // A wall through the horizon: what is below gives nothing, the rest what the cut wall gives.
  const Triangle wall{glm::vec3(1, -2, -1), glm::vec3(1, 2, -1), glm::vec3(1, 0, 1)};
  const Triangle cut{glm::vec3(1, -1, 0), glm::vec3(1, 1, 0), glm::vec3(1, 0, 1)};
  const double whole = point_form_factor(glm::vec3(0.0F), kUp, wall);
  EXPECT_NEAR(whole, point_form_factor(glm::vec3(0.0F), kUp, cut), 1e-6);
  EXPECT_GT(whole, 0.05);
  const Triangle below{glm::vec3(1, -1, -0.1F), glm::vec3(1, 1, -0.1F), glm::vec3(1, 0, -1)};
  EXPECT_EQ(point_form_factor(glm::vec3(0.0F), kUp, below), 0.0);
}

TEST(FormFactor, TheVectorFormHasAllNormalsAboveTheHorizon) {
  const Triangle triangle{glm::vec3(0.3F, -0.2F, 1), glm::vec3(0.9F, 0.4F, 1.2F),
                          glm::vec3(-0.1F, 0.5F, 0.8F)};
  const glm::dvec3 vector = vector_form_factor(glm::vec3(0.0F), triangle);
  for (const glm::vec3& tilt : {glm::vec3(0, 0, 1), glm::vec3(0.3F, 0.1F, 1)}) {
    const glm::vec3 normal = glm::normalize(tilt);
    EXPECT_NEAR(glm::dot(vector, glm::dvec3(normal)),
                point_form_factor(glm::vec3(0.0F), normal, triangle), 1e-6);
  }
}

/// The mean of cos / pi over directions uniform in solid angle is the form factor; an octant's
/// solid angle is pi / 2.
TEST(SphericalTriangle, IsSampledUniformly) {
  const Triangle octant{glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)};
  EXPECT_NEAR(element_hierarchy::solid_angle(glm::vec3(0.0F), octant), std::numbers::pi / 2.0,
              1e-6);
  const Triangle triangle{glm::vec3(0.3F, -0.9F, 0.2F), glm::vec3(1.9F, 0.4F, 1.2F),
                          glm::vec3(-0.1F, 0.5F, 0.8F)};
  for (const float distance : {1.0F, 60.0F}) {  // large in the sky, and small
    double sum = 0.0;
    constexpr int kSide = 64;
    for (int i = 0; i < kSide * kSide; ++i) {
      const glm::vec2 u((static_cast<float>(i % kSide) + 0.5F) / kSide,
                        (static_cast<float>(i / kSide) + 0.5F) / kSide);
      Triangle far = triangle;
      for (glm::vec3& corner : far) corner += (distance - 1.0F) * kUp;
      const auto point = element_hierarchy::sample_solid_angle(glm::vec3(0.0F), far, u);
      const glm::vec3 place = (1.0F - point.weights.x - point.weights.y) * far[0] +
                              point.weights.x * far[1] + point.weights.y * far[2];
      sum += point.solid_angle * static_cast<double>(glm::normalize(place).z) / std::numbers::pi;
    }
    const Triangle moved{triangle[0] + (distance - 1.0F) * kUp,
                         triangle[1] + (distance - 1.0F) * kUp,
                         triangle[2] + (distance - 1.0F) * kUp};
    const double expected = point_form_factor(glm::vec3(0.0F), kUp, moved);
    EXPECT_NEAR(sum / (kSide * kSide), expected, 2e-3 * expected) << distance;
  }
}

/// Irradiance on `receiver` when `sender` alone emits 1 W/m2: their form factor.
double solved_form_factor(const SceneBuilder& builder, std::size_t links) {
  const SolvedScene solved(builder.scene, solver_settings(links));
  return leaf_mean(solved, solved.solution->field->irradiance(), 0);
}

/// @param sender_corner, a, b  of a quad that emits
SceneBuilder two_quads(const glm::vec3& sender_corner, const glm::vec3& a, const glm::vec3& b) {
  SceneBuilder builder;
  const int receiver = builder.add_material(lambert(glm::vec3(0.5F)));
  const int sender =
      builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F / std::numbers::pi_v<float>)));
  builder.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, receiver);
  builder.add_quad(sender_corner, a, b, sender);
  return builder;
}

TEST(FormFactor, OfUnitSquaresComesOutOfTheLinks) {
  // The side that looks away gets nothing and is not in the tree.
  EXPECT_NEAR(solved_form_factor(two_quads({0, 0, 1}, {0, 1, 0}, {1, 0, 0}), 4000), 0.199825,
              0.005 * 0.199825);
  EXPECT_NEAR(solved_form_factor(two_quads({0, 0, 0.5F}, {0, 1, 0}, {1, 0, 0}), 4000), 0.415253,
              0.005 * 0.415253);
  EXPECT_NEAR(solved_form_factor(two_quads({0, 0, 2}, {0, 1, 0}, {1, 0, 0}), 4000), 0.068590,
              0.005 * 0.068590);
  // Perpendicular, with a common edge.
  EXPECT_NEAR(solved_form_factor(two_quads({0, 0, 0}, {0, 1, 0}, {0, 0, 1}), 4000), 0.200044,
              0.005 * 0.200044);
  EXPECT_NEAR(solved_form_factor(two_quads({0, 0, 0}, {0, 1, 0}, {0, 0, 2}), 4000), 0.232853,
              0.005 * 0.232853);
}

TEST(FormFactor, ComesCloserWithMoreLinks) {
  const SceneBuilder builder = two_quads({0, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const double coarse = std::fabs(solved_form_factor(builder, 16) - 0.200044);
  const double fine = std::fabs(solved_form_factor(builder, 4000) - 0.200044);
  EXPECT_LT(fine, 0.3 * coarse);
}

}  // namespace
}  // namespace renderers::test
