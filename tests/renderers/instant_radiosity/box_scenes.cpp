#include "tests/renderers/instant_radiosity/box_scenes.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/renderers/scene_builder.h"

namespace renderers::test {

namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.0F;

/// Room of 2 m with its floor at y = 0, seen through the missing wall at z = 2 if it is open.
SceneBuilder room(bool is_open, const scene::Material& floor_material) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.7F)));
  const int red = builder.add_material(lambert(glm::vec3(0.6F, 0.1F, 0.1F)));
  const int blue = builder.add_material(lambert(glm::vec3(0.1F, 0.2F, 0.6F)));
  const int floor = builder.add_material(floor_material);
  const glm::vec3 x(2.0F, 0.0F, 0.0F);
  const glm::vec3 y(0.0F, 2.0F, 0.0F);
  const glm::vec3 z(0.0F, 0.0F, 2.0F);
  const glm::vec3 o(-1.0F, 0.0F, 0.0F);
  builder.add_quad(o, z, x, floor);      // floor, seen from above
  builder.add_quad(o + y, x, z, white);  // ceiling
  builder.add_quad(o, x, y, white);      // back wall
  builder.add_quad(o, y, z, red);        // left
  builder.add_quad(o + x, z, y, blue);   // right
  if (!is_open) builder.add_quad(o + z, y, x, white);
  builder.add_box({-0.5F, 0.0F, 0.5F}, {0.1F, 0.9F, 1.0F}, white, false);
  builder.look({0.3F, 1.1F, 1.9F}, {-0.1F, 0.7F, 0.3F}, 70.0F);
  return builder;
}

scene::Light spot() {
  scene::Light light;
  light.type = scene::LightType::spot;
  light.position = {0.4F, 1.6F, 1.4F};
  light.direction = glm::normalize(glm::vec3(0.6F, -1.6F, -1.4F));
  light.intensity = glm::vec3(4.0F, 3.5F, 3.0F);
  light.inner_cone_rad = 20.0F * kDegree;
  light.outer_cone_rad = 35.0F * kDegree;
  return light;
}

void add_lamp(SceneBuilder& builder) {
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(6.0F, 5.0F, 4.0F)));
  builder.add_quad({-0.3F, 1.95F, 0.6F}, {0.5F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.5F}, lamp);
}

}  // namespace

scene::Scene spot_in_box() {
  SceneBuilder builder = room(false, lambert(glm::vec3(0.7F)));
  builder.scene.lights.push_back(spot());
  return builder.scene;
}

std::vector<std::pair<std::string, scene::Scene>> boxes_by_light() {
  std::vector<std::pair<std::string, scene::Scene>> scenes;
  SceneBuilder point = room(false, lambert(glm::vec3(0.7F)));
  point.add_point_light({0.2F, 1.5F, 1.3F}, {0.5F, 0.7F, 0.6F});
  scenes.emplace_back("point", point.scene);

  SceneBuilder area = room(false, lambert(glm::vec3(0.7F)));
  add_lamp(area);
  scenes.emplace_back("area", area.scene);

  SceneBuilder mixed = room(false, lambert(glm::vec3(0.7F)));
  add_lamp(mixed);
  mixed.add_point_light({0.2F, 1.5F, 1.3F}, {0.5F, 0.7F, 0.6F});
  mixed.scene.lights.push_back(spot());
  scenes.emplace_back("mixed", mixed.scene);

  SceneBuilder environment = room(true, lambert(glm::vec3(0.7F)));
  environment.set_environment({0.8F, 0.9F, 1.0F});
  scenes.emplace_back("environment", environment.scene);
  return scenes;
}

scene::Scene glossy_box() {
  SceneBuilder builder = room(false, phong(glm::vec3(0.3F), glm::vec3(0.4F), 20.0F));
  builder.scene.lights.push_back(spot());
  return builder.scene;
}

std::vector<bool> is_flat_pixel(const Frame& truth) {
  const perception::Image& normals = aov(truth, "normal");
  const std::vector<float>& depth = aov(truth, "depth").pixels;
  const auto normal_at = [&](std::size_t pixel) {
    const float* n = &normals.pixels[3 * pixel];
    return glm::vec3(n[0], n[1], n[2]);
  };
  const auto width = static_cast<std::size_t>(normals.width_px);
  std::vector<bool> is_flat(depth.size(), true);
  const auto compare = [&](std::size_t a, std::size_t b) {
    const bool is_one_surface = glm::dot(normal_at(a), normal_at(b)) > 0.999F &&
                                std::fabs(depth[a] - depth[b]) < 0.08F * depth[a];
    if (!is_one_surface) is_flat[a] = is_flat[b] = false;
  };
  for (std::size_t pixel = 0; pixel < is_flat.size(); ++pixel) {
    if (pixel % width + 1 < width) compare(pixel, pixel + 1);
    if (pixel + width < is_flat.size()) compare(pixel, pixel + width);
  }
  return is_flat;
}

scene::Scene scaled(scene::Scene scene, float scale) {
  for (scene::Object& object : scene.objects) {
    object.to_world = glm::scale(glm::mat4(1.0F), glm::vec3(scale)) * object.to_world;
  }
  for (scene::Light& light : scene.lights) {
    light.position *= scale;
    light.intensity *= scale * scale;
  }
  scene.camera.position *= scale;
  scene.camera.look_at *= scale;
  return scene;
}

double mean_radiance(const Frame& frame) {
  double sum = 0.0;
  for (const float value : frame.radiance.pixels) sum += static_cast<double>(value);
  return sum / static_cast<double>(frame.radiance.pixels.size());
}

double relative_rms(const Frame& test, const Frame& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.radiance.pixels.size(); ++i) {
    const double error = static_cast<double>(test.radiance.pixels[i]) -
                         static_cast<double>(truth.radiance.pixels[i]);
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<double>(truth.radiance.pixels.size())) / mean_radiance(truth);
}

}  // namespace renderers::test
