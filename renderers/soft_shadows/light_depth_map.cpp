#include "renderers/soft_shadows/light_depth_map.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/contract/devices.h"

namespace renderers::soft_shadows {

namespace {

constexpr std::size_t kRowGrain = 8;
constexpr float kNothing = std::numeric_limits<float>::infinity();
/// Length of the mean of normals that spread by 60 degrees.
constexpr float kLeastMeanNormal = 0.5F;
/// Start of the rays in front of the light, by its distance from the world's origin and its width:
/// above rounding, below what casts a shadow.
constexpr float kLift = 1e-4F;

/// The direction that a place of the map shows. @param at  in the unit disk
glm::vec3 direction_at(const glm::vec2& at) {
  const float square = glm::dot(at, at);
  return glm::vec3(2.0F * at, 1.0F - square) / (1.0F + square);
}

/// The middle of a texel in the unit disk's square.
glm::vec2 middle_of(int x, int y, int side_px) {
  const glm::vec2 middle(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
  return 2.0F * middle / static_cast<float>(side_px) - 1.0F;
}

}  // namespace

glm::vec3 FlatLight::to_light(const glm::vec3& position) const {
  const glm::vec3 step = position - centre;
  return {glm::dot(step, tangent), glm::dot(step, bitangent), glm::dot(step, normal)};
}

FlatLight flat_light(const ray_tracing::LightPointSet& light) {
  const auto count = static_cast<float>(light.points.size());
  FlatLight flat;
  glm::vec3 normal(0.0F);
  for (const auto& point : light.points) {
    flat.centre += point.position / count;
    normal += point.normal / count;
  }
  if (glm::length(normal) < kLeastMeanNormal) {
    throw UnsupportedError(
        "pcss: a light's normals point everywhere; a shadow map looks one way, lights must be "
        "flat");
  }
  flat.normal = glm::normalize(normal);
  const glm::vec3 aside = std::abs(flat.normal.y) < 0.9F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  flat.tangent = glm::normalize(glm::cross(aside, flat.normal));
  flat.bitangent = glm::cross(flat.normal, flat.tangent);
  float variance = 0.0F;
  for (const auto& point : light.points) {
    const glm::vec3 place = flat.to_light(point.position);
    variance += (place.x * place.x + place.y * place.y) / (2.0F * count);
  }
  flat.width_m = std::sqrt(12.0F * variance);
  return flat;
}

LightDepthMap::LightDepthMap(const ray_tracing::RayScene& rays, const FlatLight& light, int side_px)
    : side_px_(side_px),
      heights_(static_cast<std::size_t>(side_px) * static_cast<std::size_t>(side_px), kNothing) {
  const float lift = kLift * (light.width_m + glm::length(light.centre));
  std::atomic<std::size_t> cast = 0;
  base::parallel_for(
      static_cast<std::size_t>(side_px), kRowGrain, [&](std::size_t begin, std::size_t end) {
        std::size_t own_cast = 0;
        for (std::size_t y = begin; y < end; ++y) {
          for (std::size_t x = 0; x < static_cast<std::size_t>(side_px); ++x) {
            const glm::vec2 at = middle_of(static_cast<int>(x), static_cast<int>(y), side_px);
            if (glm::dot(at, at) >= 1.0F) continue;
            const glm::vec3 own = direction_at(at);
            ray_tracing::Ray ray;
            ray.origin = light.centre + lift * light.normal;
            ray.direction = own.x * light.tangent + own.y * light.bitangent + own.z * light.normal;
            ++own_cast;
            ray_tracing::Hit hit;
            if (!rays.intersect(ray, hit)) continue;
            heights_[y * static_cast<std::size_t>(side_px) + x] = light.to_light(hit.position).z;
          }
        }
        cast.fetch_add(own_cast, std::memory_order_relaxed);
      });
  ray_count_ = cast;
}

glm::vec3 LightDepthMap::surface_towards(const glm::vec3& place) const {
  const glm::vec3 direction = glm::normalize(place);
  const glm::vec2 at = glm::vec2(direction) / (1.0F + direction.z);
  const auto texel = [&](float value) {
    const float scaled = 0.5F * (value + 1.0F) * static_cast<float>(side_px_);
    return std::clamp(static_cast<int>(scaled), 0, side_px_ - 1);
  };
  const int x = texel(at.x);
  const int y = texel(at.y);
  const float height = heights_[static_cast<std::size_t>(y) * static_cast<std::size_t>(side_px_) +
                                static_cast<std::size_t>(x)];
  if (height == kNothing) return {0.0F, 0.0F, kNothing};
  const glm::vec3 seen = direction_at(middle_of(x, y, side_px_));
  return height / seen.z * seen;
}

}  // namespace renderers::soft_shadows
