#include "renderers/scene/light_reader.h"

#include "renderers/scene/file_locator.h"
#include "renderers/scene/texture_reader.h"
#include "renderers/scene/value_reader.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <string>

namespace renderers::scene {
namespace {

LightType read_type(const base::Node& node) {
  const std::string& name = node.text("type");
  if (name == "point") return LightType::point;
  if (name == "spot") return LightType::spot;
  const std::vector<std::string> known{"point", "spot"};
  throw base::InputError(node.place(), base::unknown_name("type of light", name, known));
}

void read_cone(const base::Node& node, Light& light) {
  const auto cone_deg = base::number_list(node, "cone_deg", 2);
  const double inner = cone_deg[0];
  const double outer = cone_deg[1];
  if (!(0.0 <= inner && inner <= outer && 0.0 < outer && outer <= 90.0)) {
    throw base::InputError(
        node.place(),
        fmt::format("cone_deg [{}, {}]: half angles [inner, outer] must satisfy 0 <= inner <= "
                    "outer <= 90, outer > 0",
                    inner, outer));
  }
  light.inner_cone_rad = glm::radians(static_cast<float>(inner));
  light.outer_cone_rad = glm::radians(static_cast<float>(outer));
}

perception::Image constant_image(const glm::vec3& radiance) {
  auto image = perception::make_rgb_image(1, 1, perception::Encoding::scene_linear);
  for (int i = 0; i < 3; ++i) image.at(0, 0, i) = radiance[i];
  return image;
}

}  // namespace

Light read_light(const NamedSource& source) {
  base::MapReader reader(*source.source.node, fmt::format("light \"{}\"", source.name));
  reader.required_text("name");
  Light light;
  light.name = source.name;
  light.type = read_type(reader.require("type"));
  light.position = read_vec3(reader.require("position"), "position");
  light.intensity = read_color(reader.require("intensity"), "intensity");
  if (light.type == LightType::spot) {
    light.direction = read_direction(reader.require("direction"), "direction");
    read_cone(reader.require("cone_deg"), light);
  }
  reader.finish();
  return light;
}

std::shared_ptr<const Environment> read_environment(const SourceNode& source) {
  if (source.node == nullptr || source.node->is_null()) return nullptr;
  base::MapReader reader(*source.node, "environment");
  auto environment = std::make_shared<Environment>();
  if (const base::Node* constant = reader.find("constant")) {
    environment->image = constant_image(read_color(*constant, "constant"));
  } else {
    environment->image =
        read_linear_image(read_file_reference(reader, source.folder), source.node->place());
  }
  if (const auto* node = reader.find("scale")) environment->scale = read_positive(*node, "scale");
  if (const auto* node = reader.find("rotate_deg")) {
    environment->rotation_rad = glm::radians(read_float(*node, "rotate_deg"));
  }
  reader.finish();
  return environment;
}

Camera read_camera(const SourceNode& source, const base::Place& file) {
  if (source.node == nullptr) {
    throw base::InputError(
        file, "scene has no camera; add camera: {position, look_at, vertical_fov_deg}");
  }
  base::MapReader reader(*source.node, "camera");
  Camera camera;
  camera.position = read_vec3(reader.require("position"), "position");
  const base::Node& look_at = reader.require("look_at");
  camera.look_at = read_vec3(look_at, "look_at");
  if (const auto* node = reader.find("up")) camera.up = read_direction(*node, "up");
  const base::Node& fov = reader.require("vertical_fov_deg");
  camera.vertical_fov_deg = read_float(fov, "vertical_fov_deg");
  reader.finish();
  if (!(camera.vertical_fov_deg > 0.0F && camera.vertical_fov_deg < 180.0F)) {
    throw base::InputError(fov.place(), fmt::format("vertical_fov_deg {} is outside (0, 180)",
                                                    camera.vertical_fov_deg));
  }
  const glm::vec3 forward = camera.look_at - camera.position;
  const float distance_m = glm::length(forward);
  if (distance_m == 0.0F) {
    throw base::InputError(look_at.place(), "look_at is the camera's position");
  }
  // Below about 0.06 degrees the picture's horizon is rounding noise.
  constexpr float kMinSine = 1e-3F;
  if (glm::length(glm::cross(forward / distance_m, camera.up)) < kMinSine) {
    throw base::InputError(look_at.place(), "the camera looks along its up direction; change up");
  }
  return camera;
}

}  // namespace renderers::scene
