#include "renderers/scene/light_reader.h"

#include "renderers/scene/file_locator.h"
#include "renderers/scene/texture_reader.h"
#include "renderers/scene/value_reader.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

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

Light read_light_key(base::MapReader& key, const Light& rest) {
  Light light = rest;
  if (const auto* node = key.find("position")) light.position = read_vec3(*node, "position");
  if (const auto* node = key.find("intensity")) light.intensity = read_color(*node, "intensity");
  if (light.type != LightType::spot) return light;
  if (const auto* node = key.find("direction")) {
    light.direction = read_direction(*node, "direction");
  }
  return light;
}

/// Directions this near to opposite (cosine) leave open which way the light turns.
constexpr float kOppositeCosine = -0.9999F;

void check_turns(const Track<Light>& track, const NamedSource& source) {
  for (std::size_t i = 1; i < track.keys.size(); ++i) {
    const Key<Light>& a = track.keys[i - 1];
    const Key<Light>& b = track.keys[i];
    if (glm::dot(a.value.direction, b.value.direction) >= kOppositeCosine) continue;
    throw base::InputError(
        source.source.node->place(),
        fmt::format("light \"{}\" turns around from frame {} to frame {}; add a key between them",
                    source.name, a.frame, b.frame));
  }
}

/// From a to b at constant speed along the shorter arc, both unit length: slerp (Shoemake 1985).
glm::vec3 turned(const glm::vec3& a, const glm::vec3& b, float t) {
  const float cosine = std::clamp(glm::dot(a, b), -1.0F, 1.0F);
  const glm::vec3 across = b - cosine * a;
  const float length = glm::length(across);
  if (length == 0.0F) return a;
  const float angle_rad = t * std::atan2(length, cosine);
  return glm::normalize(std::cos(angle_rad) * a + std::sin(angle_rad) / length * across);
}

perception::Image constant_image(const glm::vec3& radiance) {
  auto image = perception::make_rgb_image(1, 1, perception::Encoding::scene_linear);
  for (int i = 0; i < 3; ++i) image.at(0, 0, i) = radiance[i];
  return image;
}

/// A disc in the sky.
struct Sun {
  glm::vec3 towards{0.0F, 1.0F, 0.0F};  ///< unit length, from the scene
  glm::vec3 irradiance{0.0F};           ///< W/m2, of a surface that faces it
  float radius_rad = 0.0F;
};

Sun read_sun(const base::Node& node) {
  base::MapReader reader(node, "sun");
  Sun sun;
  sun.towards = read_direction(reader.require("towards"), "towards");
  sun.irradiance = read_color(reader.require("irradiance"), "irradiance");
  float radius_deg = 1.0F;
  if (const auto* radius = reader.find("radius_deg")) {
    constexpr float kLeast_deg = 0.5F;
    constexpr float kMost_deg = 45.0F;
    radius_deg = read_float(*radius, "radius_deg");
    if (!(radius_deg >= kLeast_deg && radius_deg <= kMost_deg)) {
      throw base::InputError(radius->place(),
                             fmt::format("radius_deg {} of the sun; accepted: {} to {}", radius_deg,
                                         kLeast_deg, kMost_deg));
    }
  }
  sun.radius_rad = glm::radians(radius_deg);
  reader.finish();
  return sun;
}

constexpr int kSkyHeight_px = 128;
constexpr int kSkyWidth_px = 2 * kSkyHeight_px;
constexpr int kSkyParts = 6;  ///< along a pixel's side

/// Goes through the middles of a sky's parts: f(pixel, direction, solid angle).
template <typename Visit>
void for_each_part(const Visit& visit) {
  constexpr int kRows = kSkyHeight_px * kSkyParts;
  constexpr int kColumns = kSkyWidth_px * kSkyParts;
  const Environment unturned;
  for (int y = 0; y < kRows; ++y) {
    const float v = (static_cast<float>(y) + 0.5F) / kRows;
    const double part_sr = 2.0 * std::numbers::pi / kColumns * std::numbers::pi / kRows *
                           std::sin(std::numbers::pi * static_cast<double>(v));
    for (int x = 0; x < kColumns; ++x) {
      const float u = (static_cast<float>(x) + 0.5F) / kColumns;
      const auto pixel = static_cast<std::size_t>(y / kSkyParts) * kSkyWidth_px +
                         static_cast<std::size_t>(x / kSkyParts);
      visit(pixel, environment_direction(unturned, {u, v}), part_sr);
    }
  }
}

/// A map of even radiance with a sun, whose border is a pixel wide: 1.4 degrees.
perception::Image sunny_image(const glm::vec3& radiance, const Sun& sun) {
  const float least_cosine = std::cos(sun.radius_rad);
  std::vector<double> covered(std::size_t{kSkyWidth_px} * kSkyHeight_px, 0.0);
  std::vector<double> whole = covered;
  for_each_part([&](std::size_t pixel, const glm::vec3& direction, double part_sr) {
    whole[pixel] += part_sr;
    if (glm::dot(direction, sun.towards) >= least_cosine) covered[pixel] += part_sr;
  });
  Environment sky;
  sky.image =
      perception::make_rgb_image(kSkyWidth_px, kSkyHeight_px, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < covered.size(); ++i) {
    const auto share = static_cast<float>(covered[i] / whole[i]);
    for (std::size_t c = 0; c < 3; ++c) sky.image.pixels[3 * i + c] = share;
  }
  // What such a map, as it is looked up, lets arrive at a surface that faces the sun.
  double arriving = 0.0;
  for_each_part([&](std::size_t, const glm::vec3& direction, double part_sr) {
    const float cosine = glm::dot(direction, sun.towards);
    if (cosine <= 0.0F) return;
    arriving += part_sr * static_cast<double>(cosine * sample_environment(sky, direction).x);
  });
  const glm::vec3 disc = sun.irradiance / static_cast<float>(arriving);
  for (std::size_t i = 0; i < covered.size(); ++i) {
    const glm::vec3 color = radiance + sky.image.pixels[3 * i] * disc;
    for (std::size_t c = 0; c < 3; ++c) {
      sky.image.pixels[3 * i + c] = color[static_cast<glm::length_t>(c)];
    }
  }
  return std::move(sky.image);
}

perception::Image even_sky(const base::Node& constant, const base::Node* sun) {
  const glm::vec3 radiance = read_color(constant, "constant");
  return sun == nullptr ? constant_image(radiance) : sunny_image(radiance, read_sun(*sun));
}

}  // namespace

Track<Light> read_light(const NamedSource& source) {
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
  Track<Light> track = read_track(reader, light, read_light_key);
  reader.finish();
  if (light.type == LightType::spot) check_turns(track, source);
  return track;
}

Light mix_lights(const Light& a, const Light& b, float t) {
  Light light = a;
  light.position = glm::mix(a.position, b.position, t);
  light.intensity = glm::mix(a.intensity, b.intensity, t);
  if (a.type == LightType::spot) light.direction = turned(a.direction, b.direction, t);
  return light;
}

std::shared_ptr<const Environment> read_environment(const SourceNode& source) {
  if (source.node == nullptr || source.node->is_null()) return nullptr;
  base::MapReader reader(*source.node, "environment");
  auto environment = std::make_shared<Environment>();
  if (const base::Node* constant = reader.find("constant")) {
    environment->image = even_sky(*constant, reader.find("sun"));
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

}  // namespace renderers::scene
