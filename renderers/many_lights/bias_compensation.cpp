#include "renderers/many_lights/bias_compensation.h"

#include <atomic>
#include <cmath>
#include <optional>
#include <string>

#include <glm/geometric.hpp>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::many_lights {

namespace {

using ray_tracing::Hit;
using ray_tracing::LightSample;
using ray_tracing::SampleSequence;
using ray_tracing::SurfaceBrdf;

struct Counts {
  std::uint64_t short_rays = 0;
  std::uint64_t kept_hits = 0;
  std::uint64_t shadow_rays = 0;
};

void check(const BiasCompensationSettings& settings) {
  if (settings.rays < 1) {
    throw base::InputError("bias compensation: rays is " + std::to_string(settings.rays) +
                           "; accepted: 1 and more");
  }
  if (!(settings.geometry_clamp >= 0.0F)) {
    throw base::InputError("bias compensation: geometry_clamp is " +
                           std::to_string(settings.geometry_clamp) +
                           "; accepted: 0 (none) and more, 1/m2");
  }
}

/// Compensates one image; shared by all threads.
class Compensator {
 public:
  Compensator(const ray_tracing::RayScene& rays, const ray_tracing::LightSampler& lights,
              const SurfaceImage& surfaces, const BiasCompensationSettings& settings)
      : rays_(rays),
        lights_(lights),
        surfaces_(surfaces),
        settings_(settings),
        margin_m_(settings.epsilon * glm::distance(rays.box_min(), rays.box_max())) {}

  /// @return mean over the rays of a pixel with a surface, W/(m2 sr)
  glm::vec3 estimate(std::size_t pixel, Counts& counts) const;

 private:
  SurfaceBrdf brdf_at(std::size_t pixel) const;
  glm::vec3 follow(const glm::vec3& origin, const SurfaceBrdf& brdf, SampleSequence& numbers,
                   Counts& counts) const;
  glm::vec3 reflected_light(const Hit& hit, const SurfaceBrdf& brdf, const glm::vec3& u,
                            Counts& counts) const;

  const ray_tracing::RayScene& rays_;
  const ray_tracing::LightSampler& lights_;
  const SurfaceImage& surfaces_;
  const BiasCompensationSettings& settings_;
  float margin_m_;
};

SurfaceBrdf Compensator::brdf_at(std::size_t pixel) const {
  const auto index = static_cast<std::size_t>(surfaces_.geometric_normal[pixel].w);
  const scene::Material& material = rays_.scene().materials[index];
  SurfaceBrdf brdf;
  brdf.geometric_normal = glm::vec3(surfaces_.geometric_normal[pixel]);
  brdf.normal = glm::vec3(surfaces_.shading_normal[pixel]);
  brdf.diffuse = glm::vec3(surfaces_.albedo[pixel]);
  if (material.is_glossy()) {
    const glm::vec3 position(surfaces_.position[pixel]);
    const glm::vec3 to_viewer = glm::normalize(settings_.camera_position - position);
    add_glossy_lobe(material, to_viewer, brdf);
  }
  return brdf;
}

glm::vec3 Compensator::estimate(std::size_t pixel, Counts& counts) const {
  const SurfaceBrdf brdf = brdf_at(pixel);
  if (is_black(brdf)) return glm::vec3(0.0F);
  const glm::vec3 origin = glm::vec3(surfaces_.position[pixel]) + margin_m_ * brdf.geometric_normal;
  const std::uint64_t seed = ray_tracing::hash_combine(settings_.seed, pixel);
  const auto count = static_cast<std::uint32_t>(settings_.rays);
  glm::vec3 sum(0.0F);
  for (std::uint32_t i = settings_.pass * count; i < (settings_.pass + 1) * count; ++i) {
    SampleSequence numbers(ray_tracing::SequenceKind::sobol, seed, i);
    sum += follow(origin, brdf, numbers, counts);
  }
  return sum / static_cast<float>(count);
}

glm::vec3 Compensator::follow(const glm::vec3& origin, const SurfaceBrdf& brdf,
                              SampleSequence& numbers, Counts& counts) const {
  const glm::vec4 u = numbers.next();
  const ray_tracing::BrdfSample drawn = ray_tracing::sample(brdf, u.z, {u.x, u.y});
  if (drawn.value == glm::vec3(0.0F)) return glm::vec3(0.0F);
  const float cosine = glm::dot(brdf.normal, drawn.direction);
  counts.short_rays += 1;
  Hit hit;
  const float t_max = std::sqrt(cosine / settings_.geometry_clamp);
  if (!rays_.intersect({origin, drawn.direction, t_max}, hit)) return glm::vec3(0.0F);

  const SurfaceBrdf other =
      make_brdf(rays_.scene(), hit, -drawn.direction, ray_tracing::Lobes::diffuse);
  const float other_cosine = std::fabs(glm::dot(other.normal, drawn.direction));
  const float geometry = cosine * other_cosine / (hit.t * hit.t);
  if (geometry <= settings_.geometry_clamp || is_black(other)) return glm::vec3(0.0F);
  counts.kept_hits += 1;
  // Kollig and Keller 2004 (recalled): what min(G, b) leaves out of G.
  const float weight = 1.0F - settings_.geometry_clamp / geometry;
  return drawn.value * (weight / drawn.pdf) *
         reflected_light(hit, other, glm::vec3(numbers.next()), counts);
}

glm::vec3 Compensator::reflected_light(const Hit& hit, const SurfaceBrdf& brdf, const glm::vec3& u,
                                       Counts& counts) const {
  const std::optional<LightSample> light = lights_.sample(hit, u);
  if (!light) return glm::vec3(0.0F);
  const glm::vec3 reflected = evaluate(brdf, light->direction) * light->radiance;
  if (reflected == glm::vec3(0.0F)) return glm::vec3(0.0F);
  counts.shadow_rays += 1;
  if (rays_.is_occluded(light->shadow_ray)) return glm::vec3(0.0F);
  return reflected / light->pdf;
}

}  // namespace

CompensatedLight compensate_bias(const ray_tracing::RayScene& rays,
                                 const ray_tracing::LightSampler& lights,
                                 const SurfaceImage& surfaces,
                                 const BiasCompensationSettings& settings) {
  check(settings);
  CompensatedLight result;
  result.radiance.resize(surfaces.position.size(), glm::vec4(0.0F));
  for (std::size_t i = 0; i < surfaces.position.size(); ++i) {
    result.radiance[i].w = surfaces.position[i].w == 0.0F ? 0.0F : 1.0F;
  }
  if (settings.geometry_clamp == 0.0F || lights.is_empty()) return result;

  const Compensator compensator(rays, lights, surfaces, settings);
  std::atomic<std::uint64_t> short_rays = 0;
  std::atomic<std::uint64_t> kept_hits = 0;
  std::atomic<std::uint64_t> shadow_rays = 0;
  constexpr std::size_t kPixelsPerPiece = 256;
  base::parallel_for(surfaces.position.size(), kPixelsPerPiece,
                     [&](std::size_t begin, std::size_t end) {
                       Counts counts;
                       for (std::size_t pixel = begin; pixel < end; ++pixel) {
                         glm::vec4& radiance = result.radiance[pixel];
                         if (radiance.w > 0.0F)
                           radiance = {compensator.estimate(pixel, counts), 1.0F};
                       }
                       short_rays.fetch_add(counts.short_rays, std::memory_order_relaxed);
                       kept_hits.fetch_add(counts.kept_hits, std::memory_order_relaxed);
                       shadow_rays.fetch_add(counts.shadow_rays, std::memory_order_relaxed);
                     });
  result.short_rays = short_rays;
  result.kept_hits = kept_hits;
  result.shadow_rays = shadow_rays;
  return result;
}

}  // namespace renderers::many_lights
