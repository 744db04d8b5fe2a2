#include "renderers/ray_tracing/light_points.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/renderers/scene_builder.h"

namespace renderers::ray_tracing {
namespace {

using test::lambert;
using test::SceneBuilder;

struct Lights {
  explicit Lights(const SceneBuilder& builder, int count = 64)
      : rays(builder.scene, timer), sets(make_light_points(rays, count, 7)) {}
  StageTimer timer;
  RayScene rays;
  std::vector<LightPointSet> sets;
};

glm::dvec3 total_power(const LightPointSet& set) {
  glm::dvec3 sum(0.0);
  for (const LightPoint& point : set.points) sum += glm::dvec3(point.power);
  return sum;
}

/// A lamp of 2 m x 1 m in the plane y = 3, looking down.
SceneBuilder lamp(const scene::Material& material) {
  SceneBuilder builder;
  builder.add_quad({0, 3, 0}, {2, 0, 0}, {0, 0, 1}, builder.add_material(material));
  return builder;
}

TEST(LightPoints, ARectanglesPointsAreStratifiedInEveryRun) {
  const Lights lights(lamp(lambert(glm::vec3(0.0F), {1, 2, 3})));
  ASSERT_EQ(lights.sets.size(), 1U);
  const LightPointSet& set = lights.sets[0];
  ASSERT_EQ(set.points.size(), 64U);
  // One of each run of 16 in each cell of a 4 x 4 grid, and of all 64 in one of 8 x 8.
  const auto cells = [&](std::size_t begin, std::size_t count, float across) {
    std::set<int> found;
    for (std::size_t i = begin; i < begin + count; ++i) {
      const glm::vec3& p = set.points[i].position;
      found.insert(static_cast<int>(p.x / 2.0F * across) + 100 * static_cast<int>(p.z * across));
    }
    return found.size();
  };
  for (std::size_t run = 0; run < 64; run += 16) EXPECT_EQ(cells(run, 16, 4.0F), 16U) << run;
  EXPECT_EQ(cells(0, 64, 8.0F), 64U);
  for (const LightPoint& point : set.points) {
    EXPECT_NEAR(point.position.y, 3.0F, 1e-5F);
    EXPECT_LT(point.target.y, point.position.y);
    EXPECT_EQ(point.normal, glm::vec3(0, -1, 0));
  }
  EXPECT_NEAR(total_power(set).y, 2.0 * 2.0, 1e-4);  // radiance x area
}

TEST(LightPoints, TexturedEmissionKeepsItsMeanWithFewPoints) {
  SceneBuilder builder;
  scene::Texture texture;
  texture.image = perception::make_rgb_image(8, 8, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < texture.image.pixels.size(); ++i) {
    texture.image.pixels[i] = static_cast<float>((i * 37) % 11);
  }
  builder.scene.textures.push_back(texture);
  scene::Material screen = lambert(glm::vec3(0.0F), glm::vec3(1.0F));
  screen.emission_texture = 0;
  builder.add_quad({0, 3, 0}, {2, 0, 0}, {0, 0, 1}, builder.add_material(screen));
  const glm::dvec3 few = total_power(Lights(builder, 16).sets[0]);
  const glm::dvec3 many = total_power(Lights(builder, 4096).sets[0]);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(few[c], many[c], 0.02 * many[c]) << c;
  // Control: the emission at the points alone is off by more.
  const LightPointSet set = Lights(builder, 16).sets[0];
  double at_points = 0.0;
  for (const LightPoint& point : set.points) {
    const glm::vec2 uv(point.position.x / 2.0F, point.position.z);
    at_points += static_cast<double>(scene::sample_texture(texture, uv).x) * 2.0 / 16.0;
  }
  EXPECT_GT(std::fabs(at_points - many.x), 0.03 * many.x);
}

/// Uniform in area over any triangles: the first moments are those of the surface.
TEST(LightPoints, TrianglesOfAMeshGetTheirShareOfArea) {
  SceneBuilder builder;
  const int glow = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  builder.add_sphere({1, 2, 3}, 0.5F, 16, glow);
  const Lights lights(builder, 4096);
  glm::dvec3 mean(0.0);
  for (const LightPoint& point : lights.sets[0].points) mean += glm::dvec3(point.position) / 4096.0;
  EXPECT_NEAR(mean.x, 1.0, 0.01);
  EXPECT_NEAR(mean.y, 2.0, 0.01);
  EXPECT_NEAR(mean.z, 3.0, 0.01);
  EXPECT_NEAR(total_power(lights.sets[0]).x, std::numbers::pi, 0.1);  // 4 pi r^2, faceted
}

TEST(LightPoints, AUniformEnvironmentGivesPiTimesItsRadiance) {
  SceneBuilder builder = lamp(lambert(glm::vec3(0.5F)));  // no emission
  builder.set_environment(glm::vec3(0.5F));
  const Lights lights(builder, 1024);
  ASSERT_EQ(lights.sets.size(), 1U);
  const LightPointSet& sky = lights.sets[0];
  EXPECT_TRUE(sky.is_environment);
  Receiver receiver;
  receiver.normal = receiver.geometric_normal = glm::normalize(glm::vec3(1, 2, -1));
  double sum = 0.0;
  for (std::size_t g = 0; g < sky.group_count(); ++g) {
    const GroupFactors factors = group_factors(sky, g, receiver);
    EXPECT_EQ(facing_points(sky, g, receiver), factors.facing);
    sum += static_cast<double>(group_irradiance(sky, g, factors, factors.facing).x);
  }
  EXPECT_NEAR(sum, 0.5 * std::numbers::pi, 0.01);
}

/// Factors added up before they meet the points' common power, and after.
TEST(LightPoints, OpenIrradianceIsTheSumOfItsGroups) {
  SceneBuilder builder = lamp(lambert(glm::vec3(0.0F), glm::vec3(1.0F, 2.0F, 3.0F)));
  Lights lights(builder);
  LightPointSet one_power = lights.sets[0];
  EXPECT_TRUE(one_power.has_one_power);
  LightPointSet others = one_power;
  others.has_one_power = false;
  Receiver receiver;
  receiver.position = one_power.points[0].position + 0.7F * one_power.points[0].normal;
  receiver.normal = receiver.geometric_normal = -one_power.points[0].normal;
  const glm::vec3 sum = open_irradiance(others, receiver);
  EXPECT_GT(sum.x, 0.0F);
  const glm::vec3 at_once = open_irradiance(one_power, receiver);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(at_once[c], sum[c], 2e-6F * sum[c]);
  receiver.normal = receiver.geometric_normal = one_power.points[0].normal;
  EXPECT_EQ(open_irradiance(one_power, receiver), glm::vec3(0.0F));
}

/// Receivers all around a box of lamps: whenever a point shines on one, the test must not say no.
TEST(LightPoints, TheShortTestNeverDeniesLight) {
  SceneBuilder builder;
  const int glow = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  builder.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, glow);
  builder.add_quad({0, 0, 0.5F}, {0, 1, 0}, {0, 0, 1}, glow);
  const Lights lights(builder);
  int lit = 0;
  int denied = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto wave = [&](float speed) { return std::sin(speed * static_cast<float>(i)); };
    Receiver receiver;
    receiver.position = 2.0F * glm::vec3(wave(1.1F), wave(2.3F), wave(3.7F));
    receiver.normal = receiver.geometric_normal =
        glm::normalize(glm::vec3(wave(5.3F), wave(7.1F), wave(0.7F)));
    for (const LightPointSet& set : lights.sets) {
      bool is_lit = false;
      for (std::size_t g = 0; g < set.group_count(); ++g) {
        const std::uint32_t facing = group_factors(set, g, receiver).facing;
        EXPECT_EQ(facing_points(set, g, receiver), facing) << i;
        is_lit = is_lit || facing != 0;
      }
      EXPECT_TRUE(!is_lit || may_shine_on(set, receiver)) << i;
      lit += is_lit ? 1 : 0;
      denied += may_shine_on(set, receiver) ? 0 : 1;
    }
  }
  EXPECT_GT(lit, 500);
  EXPECT_GT(denied, 500);
}

}  // namespace
}  // namespace renderers::ray_tracing
