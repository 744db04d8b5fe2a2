#include "renderers/scene/scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace renderers::scene {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// Two neighbouring sample positions of a linear interpolation, and the weight of the second.
struct Neighbours {
  int first;
  int second;
  float weight;
};

/// @param position  in samples, sample i has its centre at i
Neighbours neighbours(float position) {
  const float floor_position = std::floor(position);
  const int first = static_cast<int>(floor_position);
  return {first, first + 1, position - floor_position};
}

int repeated(int index, int count) {
  const int remainder = index % count;
  return remainder < 0 ? remainder + count : remainder;
}

glm::vec3 rgb_at(const perception::Image& image, int x, int y) {
  const auto pixel = image.pixel(x, y);
  return {pixel[0], pixel[1], pixel[2]};
}

glm::vec3 bilinear(const perception::Image& image, const Neighbours& x, const Neighbours& y) {
  const glm::vec3 top = rgb_at(image, x.first, y.first) * (1.0F - x.weight) +
                        rgb_at(image, x.second, y.first) * x.weight;
  const glm::vec3 bottom = rgb_at(image, x.first, y.second) * (1.0F - x.weight) +
                           rgb_at(image, x.second, y.second) * x.weight;
  return top * (1.0F - y.weight) + bottom * y.weight;
}

/// Rotation about +y by an angle: +z turns towards +x.
glm::vec3 rotated_about_y(const glm::vec3& v, float angle_rad) {
  const float c = std::cos(angle_rad);
  const float s = std::sin(angle_rad);
  return {c * v.x + s * v.z, v.y, -s * v.x + c * v.z};
}

}  // namespace

std::size_t Scene::face_count() const {
  std::size_t count = 0;
  for (const Object& object : objects) count += object.mesh->triangles.size();
  return count;
}

float Box::diagonal_m() const {
  return least.x > greatest.x ? 0.0F : glm::length(greatest - least);
}

Box bounding_box(const Scene& scene) {
  Box box;
  for (const Object& object : scene.objects) {
    for (const glm::uvec3& triangle : object.mesh->triangles) {
      for (glm::length_t corner = 0; corner < 3; ++corner) {
        const glm::vec3 position(object.to_world *
                                 glm::vec4(object.mesh->positions[triangle[corner]], 1.0F));
        box.least = glm::min(box.least, position);
        box.greatest = glm::max(box.greatest, position);
      }
    }
  }
  return box;
}

const Object* find_non_finite(const Scene& scene) {
  for (const Object& object : scene.objects) {
    for (const glm::vec3& position : object.mesh->positions) {
      const glm::vec3 world(object.to_world * glm::vec4(position, 1.0F));
      if (!std::isfinite(world.x + world.y + world.z)) return &object;
    }
  }
  return nullptr;
}

glm::vec3 intensity_towards(const Light& light, const glm::vec3& to_point) {
  if (light.type == LightType::point) return light.intensity;
  const float cos_angle = glm::dot(light.direction, to_point);
  const float cos_inner = std::cos(light.inner_cone_rad);
  const float cos_outer = std::cos(light.outer_cone_rad);
  if (cos_angle >= cos_inner) return light.intensity;
  if (cos_angle <= cos_outer) return glm::vec3(0.0F);
  const float t = (cos_angle - cos_outer) / (cos_inner - cos_outer);
  return light.intensity * (t * t * (3.0F - 2.0F * t));
}

glm::vec3 sample_texture(const Texture& texture, const glm::vec2& uv) {
  const perception::Image& image = texture.image;
  // Reduced to one period first: floats far from 0 lose the fraction's bits.
  const float u = uv.x - std::floor(uv.x);
  const float v = uv.y - std::floor(uv.y);
  Neighbours x = neighbours(u * static_cast<float>(image.width_px) - 0.5F);
  Neighbours y = neighbours((1.0F - v) * static_cast<float>(image.height_px) - 0.5F);
  x.first = repeated(x.first, image.width_px);
  x.second = repeated(x.second, image.width_px);
  y.first = repeated(y.first, image.height_px);
  y.second = repeated(y.second, image.height_px);
  return bilinear(image, x, y);
}

glm::vec2 environment_position(const Environment& environment, const glm::vec3& direction) {
  const glm::vec3 local = rotated_about_y(direction, -environment.rotation_rad);
  const float turn = std::atan2(-local.x, local.z) / (2.0F * kPi);
  const float polar_rad = std::acos(std::clamp(local.y, -1.0F, 1.0F));
  return {0.5F + turn, polar_rad / kPi};
}

glm::vec3 environment_direction(const Environment& environment, const glm::vec2& position) {
  const float azimuth_rad = (position.x - 0.5F) * 2.0F * kPi;
  const float polar_rad = position.y * kPi;
  const float radius = std::sin(polar_rad);
  const glm::vec3 local(-radius * std::sin(azimuth_rad), std::cos(polar_rad),
                        radius * std::cos(azimuth_rad));
  return rotated_about_y(local, environment.rotation_rad);
}

glm::vec3 sample_environment(const Environment& environment, const glm::vec3& direction) {
  const perception::Image& image = environment.image;
  const glm::vec2 position = environment_position(environment, direction);
  Neighbours x = neighbours(position.x * static_cast<float>(image.width_px) - 0.5F);
  Neighbours y = neighbours(position.y * static_cast<float>(image.height_px) - 0.5F);
  x.first = repeated(x.first, image.width_px);
  x.second = repeated(x.second, image.width_px);
  y.first = std::clamp(y.first, 0, image.height_px - 1);
  y.second = std::clamp(y.second, 0, image.height_px - 1);
  return environment.scale * bilinear(image, x, y);
}

std::string to_string(Feature feature) {
  switch (feature) {
    case Feature::point_light:
      return "point-light";
    case Feature::spot_light:
      return "spot-light";
    case Feature::area_light:
      return "area-light";
    case Feature::emission_profile:
      return "emission-profile";
    case Feature::environment:
      return "environment";
    case Feature::texture:
      return "texture";
    case Feature::glossy:
      return "glossy";
    case Feature::animation:
      return "animation";
  }
  return "";
}

std::vector<Feature> features_of(const Scene& scene) {
  const auto any_light = [&](LightType type) {
    return std::ranges::any_of(scene.lights, [&](const Light& l) { return l.type == type; });
  };
  const auto any_surface = [&](auto&& fact) {
    return std::ranges::any_of(scene.objects, [&](const Object& object) {
      return fact(scene.materials[static_cast<std::size_t>(object.material)]);
    });
  };
  const auto is_textured = [](const Material& m) {
    return m.albedo_texture != kNoTexture || m.emission_texture != kNoTexture;
  };
  std::vector<Feature> features;
  if (any_light(LightType::point)) features.push_back(Feature::point_light);
  if (any_light(LightType::spot)) features.push_back(Feature::spot_light);
  if (any_surface([](const Material& m) { return m.is_emissive(); })) {
    features.push_back(Feature::area_light);
  }
  if (any_surface([](const Material& m) { return !m.emission_profile.empty(); })) {
    features.push_back(Feature::emission_profile);
  }
  if (scene.environment) features.push_back(Feature::environment);
  if (any_surface(is_textured)) features.push_back(Feature::texture);
  if (any_surface([](const Material& m) { return m.is_glossy(); })) {
    features.push_back(Feature::glossy);
  }
  if (scene.is_animated) features.push_back(Feature::animation);
  return features;
}

glm::vec3 camera_ray_direction(const Camera& camera, int width_px, int height_px, float px,
                               float py) {
  const glm::vec3 forward = glm::normalize(camera.look_at - camera.position);
  const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::vec3 up = glm::cross(right, forward);
  const auto width = static_cast<float>(width_px);
  const auto height = static_cast<float>(height_px);
  const float half_height = std::tan(0.5F * camera.vertical_fov_deg * kPi / 180.0F);
  const float x = (2.0F * px - width) / height * half_height;
  const float y = (height - 2.0F * py) / height * half_height;
  return glm::normalize(forward + x * right + y * up);
}

}  // namespace renderers::scene
