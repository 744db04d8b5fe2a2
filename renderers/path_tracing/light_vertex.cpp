#include "renderers/path_tracing/light_vertex.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/light_cone.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::path_tracing {

using ray_tracing::solid_angle_sr;

LightVertexSampler::LightVertexSampler(const ray_tracing::RayScene& rays,
                                       const ray_tracing::LightSampler& lights)
    : rays_(&rays) {
  const std::vector<scene::Light>& all = rays.scene().lights;
  if (lights.is_empty()) return;
  std::vector<double> powers;
  for (const scene::Light& light : all) {
    powers.push_back(
        static_cast<double>(solid_angle_sr(light) * ray_tracing::luminance(light.intensity)));
  }
  choice_ = ray_tracing::PiecewiseDistribution(powers);
  if (is_empty()) return;
  for (std::uint32_t light = 0; light < all.size(); ++light) {
    ray_pdf_.push_back(choice_.probability(light) / solid_angle_sr(all[light]));
    light_probability_.push_back(lights.probability_of(light));
  }
}

std::optional<LightVertex> LightVertexSampler::sample(const glm::vec3& u) const {
  const std::size_t chosen = choice_.choose(u.z).index;
  const scene::Light& light = rays_->scene().lights[chosen];
  const ray_tracing::Ray ray{light.position, ray_tracing::direction_in_cone(light, {u.x, u.y})};
  const glm::vec3 intensity = scene::intensity_towards(light, ray.direction);
  if (intensity == glm::vec3(0.0F)) return std::nullopt;
  ray_tracing::Hit hit;
  if (!rays_->intersect(ray, hit)) return std::nullopt;
  LightVertex vertex;
  vertex.point = hit;
  vertex.to_light = -ray.direction;
  vertex.power = intensity / ray_pdf_[chosen];
  vertex.cosine = std::fabs(glm::dot(hit.geometric_normal, ray.direction));
  vertex.pdf = ray_pdf_[chosen] * vertex.cosine / (hit.t * hit.t);
  vertex.light_probability = light_probability_[chosen];
  // A surface seen along itself, or one that touches the lamp, takes no light that a float holds.
  if (!(vertex.pdf > 0.0F) || !std::isfinite(vertex.pdf)) return std::nullopt;
  return vertex;
}

float LightVertexSampler::pdf(std::uint32_t light, const ray_tracing::SurfacePoint& point,
                              const glm::vec3& to_light) const {
  const glm::vec3 way = rays_->scene().lights[light].position - point.position;
  return ray_pdf_[light] * std::fabs(glm::dot(point.geometric_normal, to_light)) /
         glm::dot(way, way);
}

}  // namespace renderers::path_tracing
