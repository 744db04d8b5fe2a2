#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "tests/renderers/scene_builder.h"

/// Direct light against closed forms, in double precision.
namespace renderers::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Irradiance of a polygon of radiance 1 at the origin, normal n, W/m2: Lambert 1760; Baum,
/// Rushmeier, Winget 1989, "Improving Radiosity Solutions Through the Use of Analytically
/// Determined Form-Factors", Eq. 5 (number recalled): E = 1/2 sum theta_i (Gamma_i . n).
/// The polygon lies above the horizon and is clockwise seen from the origin's front.
double lambert_polygon(const std::vector<glm::dvec3>& vertices, const glm::dvec3& normal) {
  double sum = 0.0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const glm::dvec3 a = glm::normalize(vertices[i]);
    const glm::dvec3 b = glm::normalize(vertices[(i + 1) % vertices.size()]);
    const glm::dvec3 axis = glm::cross(a, b);
    sum += std::atan2(glm::length(axis), glm::dot(a, b)) * glm::dot(glm::normalize(axis), normal);
  }
  return 0.5 * std::fabs(sum);
}

constexpr float kAlbedo = 0.6F;
constexpr float kEmission = 3.0F;

/// A floor seen from a low angle, one tiny spot of it, and a rectangle of light above.
SceneBuilder floor_and_rectangle(const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b) {
  SceneBuilder builder;
  const int floor = builder.add_material(lambert(glm::vec3(kAlbedo)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(kEmission)));
  builder.add_quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, floor);
  builder.add_quad(corner, a, b, lamp);
  builder.look({3, 1, 2}, {0, 0, 0}, 0.01F);
  return builder;
}

double expected_radiance(const std::vector<glm::dvec3>& polygon) {
  return static_cast<double>(kEmission) * static_cast<double>(kAlbedo) / kPi *
         lambert_polygon(polygon, {0, 1, 0});
}

TEST(LambertPolygon, OracleGivesTheHemisphereAndAKnownFormFactor) {
  // A huge square at a small height covers the hemisphere: E = pi.
  const std::vector<glm::dvec3> sky{{-1e4, 1, -1e4}, {1e4, 1, -1e4}, {1e4, 1, 1e4}, {-1e4, 1, 1e4}};
  EXPECT_NEAR(lambert_polygon(sky, {0, 1, 0}), kPi, 1e-3);
  // Parallel rectangle with a corner above the point, sides and distance 1: F = 0.1385
  // (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3).
  const std::vector<glm::dvec3> corner{{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}};
  const double s = 1.0 / std::sqrt(2.0);
  EXPECT_NEAR(lambert_polygon(corner, {0, 1, 0}) / kPi, 2.0 * s * std::atan(s) / (2.0 * kPi),
              1e-12);
}

TEST(DirectLight, RectangleIsTheLambertPolygon) {
  const SceneBuilder builder = floor_and_rectangle({-0.5F, 1, -0.25F}, {1.5F, 0, 0}, {0, 0, 1});
  const double expected =
      expected_radiance({{-0.5, 1, -0.25}, {1, 1, -0.25}, {1, 1, 0.75}, {-0.5, 1, 0.75}});
  for (const char* sampling : {"mis", "nee", "bsdf"}) {
    const Frame frame =
        render(builder.scene, {.settings = {std::string("sampling=") + sampling}, .samples = 512});
    const Mean mean = mean_of(frame);
    EXPECT_TRUE(agree(mean, expected, 0.01))
        << sampling << ' ' << to_string(mean) << ' ' << expected;
    EXPECT_FALSE(agree(mean, expected * kPi, 0.01)) << "a missing 1 / pi must not pass";
    EXPECT_FALSE(agree(mean, expected * 1.03, 0.01));
  }
}

TEST(DirectLight, TiltedRectangleIsTheLambertPolygon) {
  const SceneBuilder builder = floor_and_rectangle({0.5F, 0.2F, -0.5F}, {0, 0, 1}, {0.5F, 1.0F, 0});
  const double expected =
      expected_radiance({{0.5, 0.2, -0.5}, {0.5, 0.2, 0.5}, {1.0, 1.2, 0.5}, {1.0, 1.2, -0.5}});
  const Mean mean = mean_of(render(builder.scene, {.samples = 512}));
  EXPECT_TRUE(agree(mean, expected, 0.01)) << to_string(mean) << ' ' << expected;
}

TEST(DirectLight, RectangleThatLooksAwayGivesNothing) {
  const SceneBuilder builder = floor_and_rectangle({-0.5F, 1, -0.25F}, {0, 0, 1}, {1.5F, 0, 0});
  for (const char* sampling : {"mis", "nee", "bsdf"}) {
    const Frame frame = render(builder.scene, {.settings = {std::string("sampling=") + sampling}});
    for (const float value : frame.radiance.pixels) EXPECT_EQ(value, 0.0F);
  }
}

TEST(DirectLight, PointLightFollowsCosineOverSquaredDistance) {
  SceneBuilder builder;
  builder.add_quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0},
                   builder.add_material(lambert({0.2F, 0.4F, 0.8F})));
  builder.add_point_light({1, 2, -1}, {10, 20, 30});
  builder.look({3, 1, 2}, {0, 0, 0}, 0.01F);
  const Frame frame = render(builder.scene, {.samples = 4});
  const double distance2 = 6.0;
  const double cosine = 2.0 / std::sqrt(distance2);
  const glm::dvec3 expected = glm::dvec3(2, 8, 24) * (cosine / distance2 / kPi);
  for (std::size_t i = 0; i < frame.radiance.pixels.size(); ++i) {
    const double e = expected[static_cast<int>(i % 3)];
    EXPECT_NEAR(static_cast<double>(frame.radiance.pixels[i]), e, 1e-3 * e);
  }
}

TEST(DirectLight, OneLampNeedsNoChoice_AndADarkOneBesideItChangesNothing) {
  SceneBuilder builder;
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F),
                  builder.add_material(lambert({0.2F, 0.4F, 0.8F})), true);
  builder.add_point_light({0.4F, 0.5F, -0.3F}, glm::vec3(1.0F));
  builder.look({-0.5F, 0, -0.8F}, {0, 0, 1}, 70.0F);
  const Frame alone = render(builder.scene, {.samples = 4});
  builder.add_point_light({0, 0, 0}, glm::vec3(0.0F));
  const Frame with_dark = render(builder.scene, {.samples = 4});
  EXPECT_EQ(alone.radiance.pixels, with_dark.radiance.pixels);
}

TEST(DirectLight, SpotFallsOffSmoothlyBetweenItsCones) {
  SceneBuilder builder;
  builder.add_quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0},
                   builder.add_material(lambert(glm::vec3(1.0F))));
  scene::Light spot;
  spot.type = scene::LightType::spot;
  spot.position = {0, 2, 0};
  spot.intensity = glm::vec3(5.0F);
  spot.inner_cone_rad = 0.2F;
  spot.outer_cone_rad = 0.5F;
  builder.scene.lights.push_back(spot);
  for (const double angle_rad : {0.1, 0.25, 0.35, 0.45, 0.6}) {
    const double x = 2.0 * std::tan(angle_rad);
    builder.look({static_cast<float>(x), 3, -2}, {static_cast<float>(x), 0, 0}, 0.01F);
    const Frame frame = render(builder.scene, {.width_px = 2, .height_px = 2, .samples = 4});
    const double range = std::cos(0.2) - std::cos(0.5);
    const double t = std::min(1.0, std::max(0.0, (std::cos(angle_rad) - std::cos(0.5)) / range));
    const double distance2 = 4.0 + x * x;
    const double expected = 5.0 * t * t * (3.0 - 2.0 * t) * std::cos(angle_rad) / distance2 / kPi;
    EXPECT_NEAR(static_cast<double>(frame.radiance.pixels[0]), expected, 4e-3 * expected + 1e-9)
        << angle_rad;
  }
}

TEST(DirectLight, ConstantEnvironmentGivesAlbedoTimesRadiance) {
  SceneBuilder builder;
  builder.add_quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.5F))));
  builder.set_environment(glm::vec3(2.0F));
  builder.look({3, 1, 2}, {0, 0, 0}, 0.01F);
  for (const char* sampling : {"mis", "nee", "bsdf"}) {
    const Mean mean = mean_of(
        render(builder.scene, {.settings = {std::string("sampling=") + sampling}, .samples = 256}));
    EXPECT_TRUE(agree(mean, 1.0, 0.01)) << sampling << ' ' << to_string(mean);
    EXPECT_FALSE(agree(mean, 1.0 * kPi, 0.01));
  }
}

TEST(DirectLight, EnvironmentSeenByTheCameraIsDirect) {
  SceneBuilder builder;
  builder.set_environment({1, 2, 3});
  builder.look({0, 0, 0}, {0, 0, 1}, 60.0F);
  const Frame frame = render(builder.scene, {.samples = 2});
  EXPECT_EQ(frame.radiance.at(3, 3, 1), 2.0F);
  EXPECT_EQ(aov(frame, "direct").at(3, 3, 2), 3.0F);
  EXPECT_EQ(aov(frame, "indirect").at(3, 3, 2), 0.0F);
}

/// Irradiance of an environment at an upward floor, by midpoint quadrature over the upper half.
double environment_irradiance(const scene::Environment& environment) {
  constexpr int kRows = 400;
  constexpr int kColumns = 800;
  double sum = 0.0;
  for (int row = 0; row < kRows; ++row) {
    const double polar = 0.5 * kPi * (row + 0.5) / kRows;
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = 2.0 * kPi * (column + 0.5) / kColumns;
      const glm::vec3 direction(static_cast<float>(std::sin(polar) * std::cos(azimuth)),
                                static_cast<float>(std::cos(polar)),
                                static_cast<float>(std::sin(polar) * std::sin(azimuth)));
      sum += static_cast<double>(scene::sample_environment(environment, direction).x) *
             std::cos(polar) * std::sin(polar);
    }
  }
  return sum * (0.5 * kPi / kRows) * (2.0 * kPi / kColumns);
}

TEST(DirectLight, EnvironmentMapAgreesWithQuadrature) {
  SceneBuilder builder;
  builder.add_quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.5F))));
  auto environment = std::make_shared<scene::Environment>();
  environment->image = perception::make_rgb_image(16, 8, perception::Encoding::scene_linear);
  for (int c = 0; c < 3; ++c) {
    environment->image.at(5, 1, c) = 100.0F;
    environment->image.at(0, 2, c) = 30.0F;
    environment->image.at(11, 7, c) = 500.0F;  // below the floor
  }
  environment->scale = 0.5F;
  environment->rotation_rad = 0.7F;
  builder.scene.environment = environment;
  builder.look({3, 1, 2}, {0, 0, 0}, 0.01F);
  const double expected = 0.5 / kPi * environment_irradiance(*environment);
  for (const char* sampling : {"mis", "nee", "bsdf"}) {
    const Mean mean = mean_of(render(
        builder.scene, {.settings = {std::string("sampling=") + sampling}, .samples = 1024}));
    EXPECT_TRUE(agree(mean, expected, 0.02))
        << sampling << ' ' << to_string(mean) << ' ' << expected;
  }
}

}  // namespace
}  // namespace renderers::test
