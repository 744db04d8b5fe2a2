#include "renderers/many_lights/light_emitters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderers/many_lights/emitter_views.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::many_lights {
namespace {

constexpr double kPi = std::numbers::pi;
const glm::vec3 kIntensity{3.0F, 2.0F, 0.5F};

/// A room for the bounds of area lights and environments.
test::SceneBuilder room() {
  test::SceneBuilder builder;
  const int grey = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_box({-1, -1, -1}, {1, 1, 1}, grey, true);
  return builder;
}

scene::Light spot(float inner_deg, float outer_deg) {
  scene::Light light;
  light.type = scene::LightType::spot;
  light.position = {0.1F, 0.2F, 0.3F};
  light.intensity = kIntensity;
  light.direction = glm::normalize(glm::vec3(0.3F, -0.8F, 0.5F));
  light.inner_cone_rad = glm::radians(inner_deg);
  light.outer_cone_rad = glm::radians(outer_deg);
  return light;
}

Emitter emitter_of(const scene::Light& light, LightSampling sampling) {
  test::SceneBuilder builder = room();
  builder.scene.lights.push_back(light);
  auto emitters = make_emitters(builder.scene, {.sampling = sampling});
  EXPECT_EQ(emitters.size(), 1U);
  return std::move(emitters.front());
}

glm::dvec3 sum_of(const Emitter& emitter, int count, int pass = 0) {
  glm::dvec3 sum(0.0);
  for (int i = 0; i < count; ++i) {
    const EmittedSample sample = emitter.sample(i, count, pass);
    EXPECT_GE(std::min(sample.map_position.x, sample.map_position.y), 0.0);
    EXPECT_LT(std::max(sample.map_position.x, sample.map_position.y), 1.0);
    sum += sample.flux;
  }
  return sum;
}

void expect_near(const glm::dvec3& value, const glm::dvec3& expected, double relative) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], relative * expected[c]) << c;
}

TEST(EmitterViews, MapHoldsThePyramidsSolidAngle) {
  // 4 asin(sin^2(fov / 2)); with one cosine instead of three it is a fifth too much at 60 degrees.
  for (const double fov_deg : {30.0, 60.0, 90.0, 120.0}) {
    opengl::View view = view_along({0, 0, 0}, {0, 0, 1});
    view.half_width = static_cast<float>(std::tan(0.5 * fov_deg * kPi / 180.0));
    view.half_height = view.half_width;
    const double sine = std::sin(0.5 * fov_deg * kPi / 180.0);
    const double expected = 4.0 * std::asin(sine * sine);
    double sum = 0.0;
    double one_cosine = 0.0;
    for (int i = 0; i < 1024; ++i) {
      const glm::dvec2 point = halton_point(i, 1024, 0);
      const double density = map_solid_angle_sr(view, point);
      sum += density / 1024.0;
      const double cosine = direction_through(view, point).z;
      one_cosine += density / (cosine * cosine) / 1024.0;
    }
    // Halton points fill wide maps less evenly where cos^3 falls steeply.
    EXPECT_NEAR(sum, expected, (fov_deg > 100.0 ? 3e-3 : 1e-3) * expected) << fov_deg;
    EXPECT_GT(std::abs(one_cosine - expected), 0.04 * expected) << "cos^1 must be noticed";
  }
}

TEST(EmitterViews, PlaceAndDirectionAreInverse) {
  const auto views = cube_views({1, 2, 3}, glm::normalize(glm::vec3(1, -2, 0.5F)));
  ASSERT_EQ(views.size(), 6U);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec2 u = halton_point(i, 500, 0);
    const double sine = std::sqrt(1.0 - (1.0 - 2.0 * u.x) * (1.0 - 2.0 * u.x));
    const glm::dvec3 direction(sine * std::cos(2.0 * kPi * u.y), sine * std::sin(2.0 * kPi * u.y),
                               1.0 - 2.0 * u.x);
    const MapPlace place = place_of(views, direction);
    const glm::dvec3 back =
        direction_through(views[static_cast<std::size_t>(place.view)], place.position);
    EXPECT_LT(glm::distance(direction, back), 1e-6);
  }
}

TEST(LightEmitters, PointLightSendsFourPiI) {
  scene::Light light;
  light.intensity = kIntensity;
  for (const LightSampling sampling : {LightSampling::map, LightSampling::solid_angle}) {
    const Emitter emitter = emitter_of(light, sampling);
    EXPECT_EQ(emitter.views.size(), 6U);
    expect_near(emitter.flux, 4.0 * kPi * glm::dvec3(kIntensity), 1e-7);
    // A face's 170 points integrate its cos^3 no better; directions on the sphere all weigh alike.
    const double gate = sampling == LightSampling::map ? 4e-3 : 1e-6;
    expect_near(sum_of(emitter, 1024), 4.0 * kPi * glm::dvec3(kIntensity), gate);
    expect_near(sum_of(emitter, 1024, 3), 4.0 * kPi * glm::dvec3(kIntensity), gate);
    expect_near(sum_of(emitter, 6 * 1024), 4.0 * kPi * glm::dvec3(kIntensity), 1e-3);
    expect_near(sum_of(emitter, 1), 4.0 * kPi * glm::dvec3(kIntensity), 1.0);
  }
}

TEST(LightEmitters, FewerSamplesThanFacesReachAllFacesOverThePasses) {
  scene::Light light;
  light.intensity = kIntensity;
  const Emitter emitter = emitter_of(light, LightSampling::map);
  for (int count = 1; count < 6; ++count) {
    constexpr int kPasses = 1020;
    std::array<int, 6> hits{};
    glm::dvec3 mean(0.0);
    for (int pass = 0; pass < kPasses; ++pass) {
      for (int i = 0; i < count; ++i) {
        ++hits.at(static_cast<std::size_t>(emitter.sample(i, count, pass).view));
      }
      mean += sum_of(emitter, count, pass) / static_cast<double>(kPasses);
      if (pass == 5) {
        for (const int hit : hits) EXPECT_EQ(hit, count) << "in six passes";
      }
    }
    for (const int hit : hits) EXPECT_EQ(hit, kPasses * count / 6);
    // A face's 170 count points integrate its cos^3.
    expect_near(mean, 4.0 * kPi * glm::dvec3(kIntensity), 5e-3);
  }
}

TEST(LightEmitters, SpotSendsItsConesFlux) {
  for (const auto& [inner, outer] : {std::pair(10.0F, 30.0F), std::pair(0.0F, 55.0F)}) {
    const scene::Light light = spot(inner, outer);
    // Fall-off t^2 (3 - 2 t) over cos integrates to half the interval.
    const double mean_cosine =
        0.5 * (std::cos(inner * kPi / 180.0) + std::cos(outer * kPi / 180.0));
    const glm::dvec3 expected = 2.0 * kPi * (1.0 - mean_cosine) * glm::dvec3(kIntensity);
    const Emitter map = emitter_of(light, LightSampling::map);
    const Emitter cone = emitter_of(light, LightSampling::solid_angle);
    EXPECT_EQ(map.views.size(), 1U);
    expect_near(map.flux, expected, 1e-6);
    expect_near(sum_of(map, 1024), expected, 3e-3);
    expect_near(sum_of(cone, 1024), expected, 1e-3);
    expect_near(sum_of(map, 65536), expected, 3e-4);
  }
}

TEST(LightEmitters, WideSpotNeedsACube) {
  const scene::Light light = spot(60.0F, 80.0F);
  const double mean_cosine = 0.5 * (0.5 + std::cos(80.0 * kPi / 180.0));
  const glm::dvec3 expected = 2.0 * kPi * (1.0 - mean_cosine) * glm::dvec3(kIntensity);
  for (const LightSampling sampling : {LightSampling::map, LightSampling::solid_angle}) {
    const Emitter emitter = emitter_of(light, sampling);
    EXPECT_EQ(emitter.views.size(), 6U);
    expect_near(sum_of(emitter, 6144), expected, 4e-3);
  }
}

TEST(LightEmitters, AreaLightSendsPiLA) {
  test::SceneBuilder builder = room();
  const glm::vec3 radiance(4.0F, 3.0F, 1.0F);
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), radiance));
  // Front side down; a second, mirrored and scaled, shows the transform's part.
  builder.add_quad({-0.2F, 0.9F, -0.2F}, {0.4F, 0, 0}, {0, 0, 0.6F}, lamp);
  const int mirrored = builder.add_quad({-0.2F, 0.5F, -0.2F}, {0.4F, 0, 0}, {0, 0, 0.6F}, lamp);
  builder.scene.objects[static_cast<std::size_t>(mirrored)].to_world =
      glm::scale(glm::mat4(1.0F), glm::vec3(-2.0F, 1.0F, 1.0F));
  const auto emitters = make_emitters(builder.scene, {.area_light_points = 16});
  ASSERT_EQ(emitters.size(), 1U);
  const Emitter& emitter = emitters[0];
  EXPECT_EQ(emitter.views.size(), 80U);
  const glm::dvec3 expected = kPi * (0.24 + 0.48) * glm::dvec3(radiance);
  expect_near(emitter.flux, expected, 1e-6);
  expect_near(sum_of(emitter, 1000), expected, 1e-6);

  double cosine_sum = 0.0;
  int on_second = 0;
  for (int i = 0; i < 1024; ++i) {
    const EmittedSample sample = emitter.sample(i, 1024, 0);
    const opengl::View& view = emitter.views[static_cast<std::size_t>(sample.view)];
    const double cosine = -direction_through(view, sample.map_position).y;
    EXPECT_GT(cosine, 0.0) << "the front side looks down";
    cosine_sum += cosine;
    on_second += view.origin.y < 0.7F ? 1 : 0;
    const float height = view.origin.y < 0.7F ? 0.5F : 0.9F;
    EXPECT_NEAR(view.origin.y, height, 1e-4F);
  }
  EXPECT_NEAR(cosine_sum / 1024.0, 2.0 / 3.0, 2e-3) << "mean cosine of a cosine distribution";
  EXPECT_NEAR(on_second / 1024.0, 2.0 / 3.0, 0.05) << "by area";
}

/// A lamp of 1 m by 1 m with uneven stripes along x, u = x + 0.5.
test::SceneBuilder striped_lamp() {
  test::SceneBuilder builder = room();
  scene::Texture stripes;
  stripes.image = perception::make_rgb_image(8, 1, perception::Encoding::scene_linear);
  stripes.image.pixels.clear();
  for (const float stripe : {1.0F, 0.0F, 0.0F, 0.0F, 0.25F, 0.0F, 0.0F, 0.5F}) {
    stripes.image.pixels.insert(stripes.image.pixels.end(), {stripe, 0.5F * stripe, 0.1F});
  }
  builder.scene.textures.push_back(stripes);
  scene::Material lamp = test::lambert(glm::vec3(0.0F), glm::vec3(2.0F, 2.0F, 0.0F));
  lamp.emission_texture = 0;
  builder.add_quad({-0.5F, 0.9F, -0.5F}, {1, 0, 0}, {0, 0, 1}, builder.add_material(lamp));
  return builder;
}

struct LampPoint {
  glm::dvec3 position{0.0};
  glm::dvec3 flux{0.0};
};

/// What stands for area lights, whichever samples take it.
std::vector<LampPoint> lamp_points(const Emitter& emitter) {
  std::vector<LampPoint> points(emitter.views.size() / 5);
  for (int i = 0; i < 1000; ++i) {
    const EmittedSample sample = emitter.sample(i, 1000, 0);
    LampPoint& point = points[static_cast<std::size_t>(sample.view / 5)];
    point.position = glm::dvec3(emitter.views[static_cast<std::size_t>(sample.view)].origin);
    point.flux = sample.flux * (1000.0 / static_cast<double>(points.size()));
  }
  return points;
}

TEST(LightEmitters, TexturedLampsPointSendsItsOwnRadiance) {
  const test::SceneBuilder builder = striped_lamp();
  const auto emitters = make_emitters(builder.scene, {.area_light_points = 64});
  ASSERT_EQ(emitters.size(), 1U);
  expect_near(emitters[0].flux, kPi * glm::dvec3(2.0 * 1.75 / 8.0, 1.75 / 8.0, 0.0), 1e-6);
  int dark = 0;
  for (const LampPoint& point : lamp_points(emitters[0])) {
    const glm::vec2 uv(static_cast<float>(point.position.x) + 0.5F, 0.5F);
    const glm::vec3 stripe = scene::sample_texture(builder.scene.textures[0], uv);
    const double expected = kPi * 2.0 * static_cast<double>(stripe.x) / 64.0;
    EXPECT_NEAR(point.flux.x, expected, 1e-5) << "u " << uv.x;
    dark += point.flux.x == 0.0 ? 1 : 0;
  }
  // Nothing shines between the centres of dark texels: 2 + 1 of 8 texels' widths.
  EXPECT_NEAR(dark / 64.0, 3.0 / 8.0, 0.1);
}

TEST(LightEmitters, TexturedLampsMeanOverPointSetsIsItsIntegral) {
  const test::SceneBuilder builder = striped_lamp();
  double expected_flux = 0.0;
  double expected_moment = 0.0;
  constexpr int kSteps = 8000;
  for (int i = 0; i < kSteps; ++i) {
    const double u = (i + 0.5) / kSteps;
    const double radiance =
        2.0 *
        static_cast<double>(
            scene::sample_texture(builder.scene.textures[0], {static_cast<float>(u), 0.5F}).x);
    expected_flux += kPi * radiance / kSteps;
    expected_moment += kPi * radiance * (u - 0.5) / kSteps;
  }
  ASSERT_GT(std::abs(expected_moment), 0.03 * expected_flux) << "the mean everywhere has none";
  double flux = 0.0;
  double moment = 0.0;
  constexpr int kSets = 400;
  for (int set = 0; set < kSets; ++set) {
    for (const LampPoint& point :
         lamp_points(make_emitters(builder.scene, {.point_set = set})[0])) {
      flux += point.flux.x / kSets;
      moment += point.flux.x * point.position.x / kSets;
    }
  }
  EXPECT_NEAR(flux, expected_flux, 5e-3 * expected_flux);
  EXPECT_NEAR(moment, expected_moment, 3e-3 * expected_flux);
}

TEST(LightEmitters, EveryPointTakesAllPlacesOverThePointSets) {
  test::SceneBuilder builder = room();
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  builder.add_quad({0, 0.9F, 0}, {1, 0, 0}, {0, 0, 1}, lamp);
  // Numbers of points that share a factor with the bases of Halton points, too.
  for (const int count : {2, 3, 16}) {
    glm::dvec3 mean(0.0);
    constexpr int kSets = 400;
    for (int set = 0; set < kSets; ++set) {
      const auto emitters =
          make_emitters(builder.scene, {.area_light_points = count, .point_set = set});
      ASSERT_EQ(emitters.size(), 1U);
      mean += glm::dvec3(emitters[0].views[0].origin) / static_cast<double>(kSets);
    }
    // The first of two or more points is on the first triangle, (0, 0), (1, 0), (1, 1).
    EXPECT_NEAR(mean.x, 2.0 / 3.0, 0.01) << count;
    EXPECT_NEAR(mean.z, 1.0 / 3.0, 0.01) << count;
  }
}

TEST(LightEmitters, PointSetsDiffer) {
  test::SceneBuilder builder = room();
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  builder.add_quad({-0.2F, 0.9F, -0.2F}, {0.4F, 0, 0}, {0, 0, 0.4F}, lamp);
  builder.set_environment(glm::vec3(1.0F));
  const auto first = make_emitters(builder.scene, {.point_set = 0});
  const auto second = make_emitters(builder.scene, {.point_set = 1});
  ASSERT_EQ(first.size(), 2U);
  ASSERT_EQ(second.size(), 2U);
  for (std::size_t e = 0; e < 2; ++e) {
    EXPECT_NE(first[e].views[0].origin, second[e].views[0].origin);
    // The environment's is an estimate: this map has few pixels, whose directions weigh sin(theta).
    expect_near(second[e].flux, first[e].flux, e == 0 ? 1e-6 : 0.05);
  }
}

TEST(LightEmitters, EnvironmentSendsParallelLightOverTheScenesDisc) {
  test::SceneBuilder builder = room();
  builder.set_environment(glm::vec3(0.5F, 1.0F, 2.0F));
  const auto emitters = make_emitters(builder.scene, {.environment_directions = 64});
  ASSERT_EQ(emitters.size(), 1U);
  const Emitter& emitter = emitters[0];
  ASSERT_EQ(emitter.views.size(), 64U);
  // Box of diagonal sqrt(12): disc of radius sqrt(3); 4 pi sr of radiance L.
  const glm::dvec3 expected = 4.0 * kPi * (3.0 * kPi) * glm::dvec3(0.5, 1.0, 2.0);
  expect_near(emitter.flux, expected, 0.02);
  expect_near(sum_of(emitter, 1024), emitter.flux, 0.02);
  for (int i = 0; i < 256; ++i) {
    const EmittedSample sample = emitter.sample(i, 256, 0);
    EXPECT_LE(glm::length(sample.map_position - 0.5), 0.5 + 1e-12);
    const opengl::View& view = emitter.views[static_cast<std::size_t>(sample.view)];
    EXPECT_TRUE(view.is_orthographic);
    EXPECT_NEAR(glm::length(view.origin), std::sqrt(3.0F), 1e-5F);
    EXPECT_NEAR(glm::dot(view.forward, view.origin), -std::sqrt(3.0F), 1e-5F);
  }
}

TEST(LightEmitters, LightsWithoutFluxAreNoEmitters) {
  test::SceneBuilder builder = room();
  EXPECT_TRUE(make_emitters(builder.scene, {}).empty());
  builder.add_point_light({0, 0, 0}, glm::vec3(0.0F));
  builder.set_environment(glm::vec3(0.0F));
  EXPECT_TRUE(make_emitters(builder.scene, {}).empty());
}

TEST(LightEmitters, PassesContinueTheSequence) {
  const Emitter emitter = emitter_of(spot(10.0F, 40.0F), LightSampling::map);
  for (const int i : {0, 1, 17}) {
    EXPECT_EQ(emitter.sample(i, 512, 1).map_position,
              emitter.sample(512 + i, 1024, 0).map_position);
  }
}

/// Sides of the smallest rectangle around some samples' map positions.
glm::dvec2 spread(const Emitter& emitter, int first, int step, int count) {
  glm::dvec2 least(1.0);
  glm::dvec2 greatest(0.0);
  for (int i = 0; i < count; ++i) {
    const glm::dvec2 position = emitter.sample(first + i * step, 1024, 0).map_position;
    least = glm::min(least, position);
    greatest = glm::max(greatest, position);
  }
  return greatest - least;
}

TEST(LightEmitters, RunsCoverTheMapWhereStridesAreStrips) {
  const Emitter emitter = emitter_of(spot(10.0F, 40.0F), LightSampling::map);
  for (int s = 0; s < 64; ++s) {
    const glm::dvec2 run = spread(emitter, 16 * s, 1, 16);
    EXPECT_GT(std::min(run.x, run.y), 0.8) << "run " << s;
    const glm::dvec2 stride = spread(emitter, s, 64, 16);
    EXPECT_LT(std::min(stride.x, stride.y), 0.05) << "a strided interleave must be noticed";
  }
}

}  // namespace
}  // namespace renderers::many_lights
