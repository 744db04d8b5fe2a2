#include "renderers/path_tracing/path_integrator.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace renderers::path_tracing {

namespace {

using ray_tracing::Hit;
using ray_tracing::LightSample;
using ray_tracing::Lobes;
using ray_tracing::power_heuristic;
using ray_tracing::Ray;
using ray_tracing::RayScene;
using ray_tracing::SampleSequence;
using ray_tracing::SurfaceBrdf;
using ray_tracing::SurfacePoint;

/// Roulette lets at most this share of the paths survive a surface, so that a scene that absorbs
/// nothing ends, too; the weight grows by the inverse and the mean stays. Ours.
constexpr float kGreatestSurvival = 0.95F;

float largest(const glm::vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }

}  // namespace

PathIntegrator::PathIntegrator(const RayScene& rays, const ray_tracing::LightSampler& lights,
                               const PathSettings& settings)
    : rays_(rays),
      lights_(lights),
      settings_(settings),
      surface_limit_(settings.surface_limit()),
      reflection_limit_(surface_limit_),
      geometry_clamp_(static_cast<float>(settings.claims.geometry_clamp.value_or(0.0))) {
  // After the last surface a reflected ray can only find emission, if that is looked for at all.
  const bool finds_emission = settings.sampling != Sampling::nee && lights.can_be_hit();
  if (!finds_emission) reflection_limit_ = surface_limit_ - 1;
}

bool PathIntegrator::is_wanted(int surfaces) const {
  return surfaces >= 2 || settings_.claims.part == Part::all;
}

void PathIntegrator::add(const State& path, const glm::vec3& radiance, PathSample& sample) const {
  (path.surfaces >= 2 ? sample.indirect : sample.direct) += path.throughput * radiance;
}

float PathIntegrator::hit_weight(float hit_pdf, float light_pdf) const {
  if (settings_.sampling == Sampling::bsdf) return 1.0F;
  if (settings_.sampling == Sampling::nee) return 0.0F;
  return power_heuristic(hit_pdf, light_pdf);
}

float PathIntegrator::light_weight(const LightSample& light, float hit_pdf) const {
  if (light.is_delta || settings_.sampling == Sampling::nee) return 1.0F;
  if (settings_.sampling == Sampling::bsdf) return 0.0F;
  return power_heuristic(light.pdf, hit_pdf);
}

void PathIntegrator::add_environment(const State& path, PathSample& sample) const {
  if (!is_wanted(path.surfaces)) return;
  const glm::vec3& direction = path.ray.direction;
  float weight = 1.0F;
  if (path.surfaces > 0) weight = hit_weight(path.pdf, lights_.pdf_of_environment(direction));
  if (weight > 0.0F) add(path, weight * lights_.environment(direction), sample);
}

void PathIntegrator::add_emission(const State& path, const Hit& hit, PathSample& sample) const {
  if (!is_wanted(path.surfaces)) return;
  const glm::vec3& direction = path.ray.direction;
  const glm::vec3 radiance = lights_.emission(hit, -direction);
  if (radiance == glm::vec3(0.0F)) return;
  float weight = 1.0F;
  if (path.surfaces > 0) {
    weight = hit_weight(path.pdf, lights_.pdf_of_emission(hit, direction, hit.t));
  }
  if (weight > 0.0F) add(path, weight * radiance, sample);
}

SurfaceBrdf PathIntegrator::meet_surface(State& path, const Hit& hit, PathSample& sample) const {
  path.surfaces += 1;
  const glm::vec3 to_viewer = -path.ray.direction;
  const bool is_first = path.surfaces == 1;
  const bool is_whole = is_first || settings_.claims.transport == Transport::full;
  const SurfaceBrdf brdf =
      make_brdf(rays_.scene(), hit, to_viewer, is_whole ? Lobes::all : Lobes::diffuse);
  if (is_first) {
    sample.albedo = brdf.diffuse + brdf.glossy.lobe.albedo;
    sample.normal = brdf.normal;
    sample.depth_m = hit.t;
    sample.has_surface = true;
  } else if (path.surfaces == 2 && geometry_clamp_ > 0.0F) {
    // The segment is the one that a virtual point light's connection to the seen surface takes:
    // G = cos cos / d2 is bounded by scaling the path.
    const float cosine = std::fabs(glm::dot(brdf.normal, to_viewer));
    const float geometry = path.last_cosine * cosine / (hit.t * hit.t);
    if (geometry > geometry_clamp_) path.throughput *= geometry_clamp_ / geometry;
  }
  return brdf;
}

void PathIntegrator::add_lights(const State& path, const SurfacePoint& point,
                                const SurfaceBrdf& brdf, const glm::vec3& u, PathSample& sample,
                                RayCounts& counts) const {
  const std::optional<LightSample> light = lights_.sample(point, u);
  if (!light) return;
  const glm::vec3 reflected = evaluate(brdf, light->direction) * light->radiance;
  if (reflected == glm::vec3(0.0F)) return;
  const float weight = light_weight(*light, pdf(brdf, light->direction));
  if (weight <= 0.0F) return;
  counts.shadow += 1;
  if (rays_.is_occluded(light->shadow_ray)) return;
  add(path, reflected * (weight / light->pdf), sample);
}

bool PathIntegrator::reflect(State& path, const SurfacePoint& point, const SurfaceBrdf& brdf,
                             SampleSequence& numbers, float lobe_u) const {
  const glm::vec4 u = numbers.next();
  const ray_tracing::BrdfSample drawn = ray_tracing::sample(brdf, lobe_u, {u.x, u.y});
  if (drawn.value == glm::vec3(0.0F)) return false;
  path.throughput *= drawn.value / drawn.pdf;
  if (path.surfaces >= settings_.roulette_depth) {
    const float survival = std::min(kGreatestSurvival, largest(path.throughput));
    if (u.z >= survival) return false;
    path.throughput /= survival;
  }
  path.ray = ray_from(point, drawn.direction);
  path.pdf = drawn.pdf;
  path.last_cosine = glm::dot(brdf.normal, drawn.direction);
  return true;
}

PathSample PathIntegrator::trace(const Ray& camera_ray, SampleSequence& numbers,
                                 RayCounts& counts) const {
  PathSample sample;
  State path;
  path.ray = camera_ray;
  counts.camera += 1;
  Hit hit;
  for (;;) {
    if (!rays_.intersect(path.ray, hit)) {
      add_environment(path, sample);
      return sample;
    }
    add_emission(path, hit, sample);
    if (path.surfaces >= surface_limit_) return sample;
    const SurfaceBrdf brdf = meet_surface(path, hit, sample);
    if (is_black(brdf)) return sample;

    const glm::vec4 u = numbers.next();
    if (!lights_.is_empty() && is_wanted(path.surfaces)) {
      add_lights(path, hit, brdf, {u.x, u.y, u.z}, sample, counts);
    }
    if (path.surfaces > reflection_limit_) return sample;
    if (!reflect(path, hit, brdf, numbers, u.w)) return sample;
    counts.bounce += 1;
  }
}

}  // namespace renderers::path_tracing
