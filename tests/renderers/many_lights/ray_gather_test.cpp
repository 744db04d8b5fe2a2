#include "renderers/many_lights/ray_gather.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/renderers/ggx_oracle.h"
#include "tests/renderers/many_lights/ray_cast_inputs.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::many_lights {
namespace {

using test::light_at;
using test::numbers;

constexpr double kPi = std::numbers::pi;

glm::vec3 random_direction(const glm::vec2& u) {
  const float z = 1.0F - 2.0F * u.x;
  const float sine = std::sqrt(1.0F - z * z);
  const float azimuth = 2.0F * static_cast<float>(kPi) * u.y;
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), z};
}

/// One receiver at the origin that looks up, of material 0.
SurfaceImage receiver_at_origin() {
  SurfaceImage surfaces = test::make_surfaces(1, 1);
  surfaces.position[0] = {0, 0, 0, 1};
  surfaces.geometric_normal[0] = {0, 1, 0, 0};
  surfaces.shading_normal[0] = {0, 1, 0, 0};
  surfaces.albedo[0] = {0.5F, 0.5F, 0.5F, 0};
  return surfaces;
}

TEST(RayGather, OneLightIsTheFormulaInDoublePrecision) {
  const scene::Scene scene;
  SurfaceImage surfaces = receiver_at_origin();
  int lit = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const glm::vec4 u = numbers(1, i);
    const glm::vec4 v = numbers(2, i);
    VirtualLight light = light_at({4 * u.x - 2, 3 * u.y - 0.3F, 4 * u.z - 2},
                                  random_direction({v.x, v.y}), {1, 2, 5});
    light.shading_normal =
        glm::vec4(glm::normalize(glm::vec3(light.geometric_normal) + glm::vec3(0.2F)), 0);
    surfaces.shading_normal[0] = glm::vec4(glm::normalize(glm::vec3(0.3F, 1, v.z - 0.5F)), 0);
    const float clamp = i % 2 == 0 ? 0.0F : 0.3F;
    const auto result =
        gather_by_rays({scene, surfaces, {&light, 1}}, {.interleave = 1, .geometry_clamp = clamp});

    const glm::dvec3 to_light(light.position);
    const double distance2 = glm::dot(to_light, to_light);
    const glm::dvec3 w = to_light / std::sqrt(distance2);
    const double receiver_cosine =
        std::max(0.0, glm::dot(glm::dvec3(surfaces.shading_normal[0]), w));
    const double light_cosine = std::max(0.0, -glm::dot(glm::dvec3(light.geometric_normal), w));
    const double geometry =
        receiver_cosine * std::fabs(glm::dot(glm::dvec3(light.shading_normal), w)) / distance2;
    double expected = receiver_cosine * light_cosine / (kPi * distance2);
    if (clamp > 0.0F && geometry > 0.0) expected *= std::min(1.0, 0.3 / geometry);
    if (w.y <= 0.0) expected = 0.0;
    lit += expected > 0.0 ? 1 : 0;
    // The cosines' rounding is absolute.
    const double tolerance = 1e-5 * expected + 3e-7 / distance2;
    EXPECT_NEAR(static_cast<double>(result.irradiance[0].x), expected, tolerance) << i;
    EXPECT_NEAR(static_cast<double>(result.irradiance[0].z), 5 * expected, 5 * tolerance) << i;
    EXPECT_EQ(result.irradiance[0].w, 1.0F);
    EXPECT_EQ(result.rays, 0U);
  }
  EXPECT_GT(lit, 50);
}

TEST(RayGather, ClampIsMetExactlyAndLightsBehindGiveNothing) {
  const scene::Scene scene;
  const SurfaceImage surfaces = receiver_at_origin();
  // G = 1 / d2 = 4.
  const VirtualLight above = light_at({0, 0.5F, 0}, {0, -1, 0}, glm::vec3(1.0F));
  const auto open = gather_by_rays({scene, surfaces, {&above, 1}}, {.interleave = 1});
  EXPECT_FLOAT_EQ(open.irradiance[0].x, static_cast<float>(4.0 / kPi));
  const auto cut =
      gather_by_rays({scene, surfaces, {&above, 1}}, {.interleave = 1, .geometry_clamp = 1.5F});
  EXPECT_FLOAT_EQ(cut.irradiance[0].x, static_cast<float>(1.5 / kPi));

  VirtualLight absent = above;
  absent.position.w = 0;
  for (const VirtualLight& light : {light_at({0, -0.5F, 0}, {0, 1, 0}, glm::vec3(1.0F)),
                                    light_at({0, 0.5F, 0}, {0, 1, 0}, glm::vec3(1.0F)), absent}) {
    const auto result = gather_by_rays({scene, surfaces, {&light, 1}}, {.interleave = 1});
    EXPECT_EQ(result.irradiance[0], glm::vec4(0, 0, 0, 1));
  }
}

/// A sphere's inside as lights: E = Phi / (4 pi R^2) everywhere, whatever the lights.
TEST(RayGather, IntegratingSphereIsEvenEverywhere) {
  constexpr float kRadius = 2.0F;
  const scene::Scene scene;
  std::vector<VirtualLight> lights;
  double flux = 0.0;
  for (std::uint32_t i = 0; i < 256; ++i) {
    const glm::vec4 u = numbers(3, i);
    const glm::vec3 direction = random_direction({u.x, u.y});
    lights.push_back(light_at(kRadius * direction, -direction, glm::vec3(u.z)));
    flux += static_cast<double>(u.z);
  }
  SurfaceImage surfaces = test::make_surfaces(64, 1);
  for (std::uint32_t i = 0; i < 64; ++i) {
    const glm::vec4 u = numbers(4, i);
    const glm::vec3 direction = random_direction({u.x, u.y});
    surfaces.position[i] = glm::vec4(kRadius * direction, 1);
    surfaces.geometric_normal[i] = surfaces.shading_normal[i] = glm::vec4(-direction, 0);
  }
  const auto result = gather_by_rays({scene, surfaces, lights}, {.interleave = 1});
  const double expected = flux / (4.0 * kPi * static_cast<double>(kRadius * kRadius));
  for (const glm::vec4& irradiance : result.irradiance) {
    EXPECT_NEAR(static_cast<double>(irradiance.x), expected, 1e-4 * expected);
  }
}

TEST(RayGather, PixelsReadTheirRunAndPixelsWithoutSurfaceStayBlack) {
  const scene::Scene scene;
  SurfaceImage surfaces = test::make_surfaces(4, 4);
  for (std::size_t i = 0; i < 15; ++i) {
    surfaces.position[i] = {0, 0, 0, 1};
    surfaces.geometric_normal[i] = surfaces.shading_normal[i] = {0, 1, 0, 0};
  }
  std::vector<VirtualLight> lights;
  for (int i = 0; i < 8; ++i) {
    lights.push_back(
        light_at({0, 1, 0}, {0, -1, 0}, glm::vec3(std::pow(10.0F, static_cast<float>(i % 4)))));
  }
  const auto result = gather_by_rays({scene, surfaces, lights}, {.interleave = 2});
  // Class (x mod 2, y mod 2) reads lights 2 s and 2 s + 1; the sum counts four times.
  const auto value = [&](int x, int y) {
    return static_cast<double>(result.irradiance[static_cast<std::size_t>(4 * y + x)].x) * kPi / 4;
  };
  EXPECT_NEAR(value(0, 0), 11.0, 1e-4);
  EXPECT_NEAR(value(3, 2), 1100.0, 1e-2);
  EXPECT_NEAR(value(2, 1), 11.0, 1e-4);
  EXPECT_NEAR(value(1, 3), 1100.0, 1e-2);
  EXPECT_EQ(result.irradiance[15], glm::vec4(0.0F));
}

TEST(RayGather, GlossyIsThePhongLobeSeenByTheCamera) {
  scene::Scene scene;
  scene.materials.push_back(test::phong(glm::vec3(0.2F), {0.5F, 0.25F, 0.1F}, 8.0F));
  SurfaceImage surfaces = receiver_at_origin();
  surfaces.albedo[0].w = 1;
  const VirtualLight light = light_at({1, 1, 0.2F}, {0, -1, 0}, glm::vec3(3.0F));
  const GatherSettings settings{
      .interleave = 1, .with_glossy = true, .camera_position = {-1, 0.8F, 0.1F}};
  const auto result = gather_by_rays({scene, surfaces, {&light, 1}}, settings);
  const glm::dvec3 w = glm::normalize(glm::dvec3(1, 1, static_cast<double>(0.2F)));
  const glm::dvec3 mirror =
      glm::normalize(glm::dvec3(1, static_cast<double>(0.8F), -static_cast<double>(0.1F)));
  const double lobe = 10.0 / (2.0 * kPi) * std::pow(glm::dot(mirror, w), 8.0);
  const double irradiance = static_cast<double>(result.irradiance[0].x);
  EXPECT_NEAR(static_cast<double>(result.glossy[0].x), 0.5 * lobe * irradiance, 1e-5 * irradiance);
  EXPECT_NEAR(static_cast<double>(result.glossy[0].y), 0.25 * lobe * irradiance, 1e-5 * irradiance);
  surfaces.albedo[0].w = 0;
  EXPECT_EQ(gather_by_rays({scene, surfaces, {&light, 1}}, settings).glossy[0],
            glm::vec4(0, 0, 0, 1));
}

TEST(RayGather, GlossyIsTheLobeOfGgxSeenByTheCamera) {
  scene::Scene scene;
  scene.materials.push_back(test::ggx(glm::vec3(0.2F), {0.5F, 0.25F, 0.1F}, 0.4F));
  SurfaceImage surfaces = receiver_at_origin();
  surfaces.albedo[0].w = 1;
  const VirtualLight light = light_at({1, 1, 0.2F}, {0, -1, 0}, glm::vec3(3.0F));
  const GatherSettings settings{
      .interleave = 1, .with_glossy = true, .camera_position = {-1, 0.8F, 0.1F}};
  const auto result = gather_by_rays({scene, surfaces, {&light, 1}}, settings);
  const glm::dvec3 in = glm::normalize(glm::dvec3(1, 1, static_cast<double>(0.2F)));
  const glm::dvec3 out =
      glm::normalize(glm::dvec3(-1, static_cast<double>(0.8F), static_cast<double>(0.1F)));
  const double lobe = test::ggx_value(static_cast<double>(0.4F), {0.0, 1.0, 0.0}, out, in);
  const double irradiance = static_cast<double>(result.irradiance[0].x);
  EXPECT_NEAR(static_cast<double>(result.glossy[0].x), 0.5 * lobe * irradiance, 1e-5 * irradiance);
  EXPECT_NEAR(static_cast<double>(result.glossy[0].z), 0.1 * lobe * irradiance, 1e-5 * irradiance);
}

}  // namespace
}  // namespace renderers::many_lights
