#include "renderers/clustered_visibility/re_emission.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "renderers/many_lights/gather.h"
#include "renderers/many_lights/surface_image.h"
#include "renderers/many_lights/virtual_light.h"
#include "renderers/opengl/context.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/ray_tracing/surface_brdf.h"
#include "tests/renderers/many_lights/light_oracle.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::test {
namespace {

namespace cv = clustered_visibility;
using many_lights::VirtualLight;

constexpr glm::dvec3 kLuminance{0.2126, 0.7152, 0.0722};

/// A table of 2 x 1 m whose normal is +y, of a colour.
scene::Scene table(const glm::vec3& albedo) {
  SceneBuilder builder;
  builder.add_quad({0, 0, 0}, {0, 0, 1}, {2, 0, 0}, builder.add_material(lambert(albedo)));
  return builder.scene;
}

TEST(ReEmission, APointSendsOnWhatItsSidesReceive) {
  constexpr int kCount = 24;
  const glm::vec3 albedo(0.2F, 0.5F, 0.8F);
  const scene::Scene scene = table(albedo);
  const auto context = opengl::Context::create("auto");
  StageTimer timer;
  opengl::GpuScene gpu_scene(context);
  gpu_scene.load(scene, timer);
  const shadow_maps::SurfacePoints points = shadow_maps::surface_points(scene, 0, kCount);
  cv::ReEmission emission(context, kCount);
  emission.place(points, gpu_scene);

  // By thirds: front alone, back alone, both sides with three times as much in front.
  const opengl::GeometryBuffer& receivers = emission.receivers();
  const auto texels = static_cast<std::size_t>(receivers.width_px() * receivers.height_px());
  std::vector<float> irradiance(texels * 4, 0.0F);
  const glm::vec3 light(3.0F, 2.0F, 1.0F);
  for (std::size_t i = 0; i < kCount; ++i) {
    const float front = i % 3 == 1 ? 0.0F : 3.0F;
    const float back = i % 3 == 0 ? 0.0F : 1.0F;
    for (glm::length_t c = 0; c < 3; ++c) {
      irradiance[i * 4 + static_cast<std::size_t>(c)] = front * light[c];
      irradiance[(kCount + i) * 4 + static_cast<std::size_t>(c)] = back * light[c];
    }
  }
  opengl::Texture received(context, {.format = opengl::TextureFormat::rgba32f,
                                     .width_px = receivers.width_px(),
                                     .height_px = receivers.height_px()});
  received.write(irradiance);
  emission.emit(received);

  const auto lights = emission.lights().read<VirtualLight>(kCount);
  ASSERT_EQ(points.points.size(), std::size_t{kCount});
  int drawn_front = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const shadow_maps::SurfacePoint& point = points.points[i];
    const VirtualLight& got = lights[static_cast<std::size_t>(point.place)];
    const bool is_front = got.geometric_normal.y > 0.0F;
    EXPECT_EQ(glm::vec3(got.position), point.position);
    EXPECT_EQ(got.position.w, 1.0F);
    EXPECT_FLOAT_EQ(std::fabs(got.geometric_normal.y), 1.0F);
    if (i % 3 != 2) {
      EXPECT_EQ(is_front, i % 3 == 0);
    }
    if (i % 3 == 2 && is_front) ++drawn_front;
    // Phi = albedo E A / N of one side, over the probability of having drawn it.
    const double power = i % 3 == 0 ? 3.0 : i % 3 == 1 ? 1.0 : 4.0;
    const glm::dvec3 expected =
        glm::dvec3(albedo) * glm::dvec3(light) * power * 2.0 / static_cast<double>(kCount);
    EXPECT_NEAR(glm::dot(glm::dvec3(got.flux), kLuminance), glm::dot(expected, kLuminance),
                1e-6 * glm::dot(expected, kLuminance));
    EXPECT_NEAR(got.flux.x / got.flux.z, expected.x / expected.z, 1e-5);
  }
  EXPECT_GE(drawn_front, 5) << "three quarters of eight";
  EXPECT_LE(drawn_front, 7);
}

/// A room whose walls have a texture, with a ball of smooth normals in it.
scene::Scene textured_room() {
  SceneBuilder builder;
  scene::Material tiles = lambert({0.9F, 0.8F, 0.7F});
  scene::Texture texture;
  texture.image = perception::make_rgb_image(4, 3, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < texture.image.pixels.size(); ++i) {
    texture.image.pixels[i] = static_cast<float>((7 * i + 3) % 36) / 36.0F;
  }
  builder.scene.textures.push_back(std::move(texture));
  tiles.albedo_texture = 0;
  builder.add_box({0, 0, 0}, {3, 2, 2.5F}, builder.add_material(tiles), true);
  builder.add_sphere({1.4F, 0.7F, 1.2F}, 0.5F, 12,
                     builder.add_material(lambert({0.3F, 0.6F, 0.2F})));
  return builder.scene;
}

/// Both sides of a point, as a ray finds them that comes along its normal.
struct Sides {
  OracleReceiver front;
  OracleReceiver back;
  glm::dvec3 albedo{0.0};
};

Sides sides_of(const ray_tracing::RayScene& rays, const scene::Scene& scene,
               const shadow_maps::SurfacePoint& point, const glm::vec3& normal) {
  ray_tracing::Hit hit;
  EXPECT_TRUE(rays.intersect({point.position + 0.01F * normal, -normal}, hit));
  const glm::dvec3 geometric(hit.geometric_normal);
  const glm::dvec3 shading(hit.shading_normal);
  const glm::dvec3 position(point.position);
  return {{position, geometric, shading},
          {position, -geometric, -shading},
          glm::dvec3(ray_tracing::diffuse_albedo(scene, hit))};
}

/// Lights on the left wall and the ceiling, and within the ball, where backs alone are lit.
std::vector<VirtualLight> lights_in_room() {
  std::vector<VirtualLight> lights;
  for (int i = 0; i < 12; ++i) {
    const double u = (i + 0.5) / 12.0;
    const glm::dvec3 flux(1.0 + u, 2.0 - u, 0.5 + 3.0 * u * u);
    lights.push_back(flat_light({0.0, 0.3 + 1.4 * u, 2.5 * u}, {1.0, 0.0, 0.0}, flux));
    lights.push_back(flat_light({3.0 * u, 2.0, 2.2 - 2.0 * u}, {0.0, -1.0, 0.0}, 2.0 * flux));
  }
  lights.push_back(flat_light({1.4, 0.7, 1.2}, {0.0, 1.0, 0.0}, {1.0, 1.0, 0.1}));
  lights.push_back(flat_light({1.4, 0.7, 1.2}, {0.0, -1.0, 0.0}, {0.1, 1.0, 1.0}));
  return lights;
}

TEST(ReEmission, IsThatOfTheOracleInDoublePrecision) {
  constexpr int kCount = 150;
  constexpr double kClamp = 4.0;
  const scene::Scene scene = textured_room();
  const auto context = opengl::Context::create("auto");
  StageTimer timer;
  opengl::GpuScene gpu_scene(context);
  gpu_scene.load(scene, timer);
  const ray_tracing::RayScene rays(scene, timer);
  const shadow_maps::SurfacePoints points = shadow_maps::surface_points(scene, 1, kCount);
  cv::ReEmission emission(context, kCount);
  emission.place(points, gpu_scene);
  const std::vector<VirtualLight> sources = lights_in_room();
  const auto buffer = opengl::Buffer::of(context, std::span<const VirtualLight>(sources));
  many_lights::Gather gather(context);
  const many_lights::GatherSettings settings{.interleave = 1, .geometry_clamp = float{kClamp}};
  const auto source_count = static_cast<int>(sources.size());
  gather.begin(emission.receivers(), settings);
  gather.add(emission.receivers(), gpu_scene,
             {.lights = &buffer, .count = source_count, .batch = source_count}, settings);
  emission.emit(gather.targets().irradiance);
  const auto lights = emission.lights().read<VirtualLight>(kCount);
  const auto surfaces = many_lights::read_surfaces(emission.receivers());

  int two_sided = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const glm::vec3 normal(surfaces.geometric_normal[i]);
    const Sides sides = sides_of(rays, scene, points.points[i], normal);
    const auto flux = [&](const OracleReceiver& receiver) {
      glm::dvec3 irradiance(0.0);
      for (const VirtualLight& source : sources) {
        irradiance += oracle_irradiance(oracle_light(source), receiver, kClamp);
      }
      return sides.albedo * irradiance * points.area_m2 / static_cast<double>(kCount);
    };
    const glm::dvec3 front = flux(sides.front);
    const glm::dvec3 back = flux(sides.back);
    const VirtualLight& got = lights[static_cast<std::size_t>(points.points[i].place)];
    const bool is_front =
        glm::dot(glm::dvec3(got.geometric_normal), sides.front.geometric_normal) > 0.0;
    const OracleReceiver& side = is_front ? sides.front : sides.back;
    const glm::dvec3 own = is_front ? front : back;
    const double total = glm::dot(front + back, kLuminance);
    const glm::dvec3 expected = own * (total / glm::dot(own, kLuminance));
    two_sided += glm::dot(front, kLuminance) > 0.0 && glm::dot(back, kLuminance) > 0.0 ? 1 : 0;
    EXPECT_LT(glm::length(glm::dvec3(got.flux) - expected), 2e-4 * glm::length(expected)) << i;
    EXPECT_LT(glm::length(glm::dvec3(got.shading_normal) - side.shading_normal), 1e-4) << i;
    EXPECT_LT(glm::length(glm::dvec3(got.geometric_normal) - side.geometric_normal), 1e-5) << i;
  }
  EXPECT_GT(two_sided, 5) << "the ball is lit on both sides";
}

TEST(ReEmission, ASceneWithoutAreaReceivesNothing) {
  const auto context = opengl::Context::create("auto");
  StageTimer timer;
  opengl::GpuScene gpu_scene(context);
  gpu_scene.load({}, timer);
  cv::ReEmission emission(context, 5);
  emission.place(shadow_maps::surface_points({}, 0, 5), gpu_scene);
  for (const glm::vec4& position : many_lights::read_surfaces(emission.receivers()).position) {
    EXPECT_EQ(position, glm::vec4(0.0F));
  }
  emission.emit(emission.receivers().position());
  for (const VirtualLight& light : emission.lights().read<VirtualLight>(5)) {
    EXPECT_EQ(light.position.w, 0.0F);
  }
}

}  // namespace
}  // namespace renderers::test
