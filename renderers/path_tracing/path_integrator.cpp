#include "renderers/path_tracing/path_integrator.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <glm/geometric.hpp>

namespace renderers::path_tracing {

namespace {

using ray_tracing::Hit;
using ray_tracing::kPacketRays;
using ray_tracing::LightSample;
using ray_tracing::LineHit;
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

/// Fewer shadow rays than this are cast one by one: a packet costs as much as a few. Measured.
constexpr std::size_t kFewRays = 8;

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

glm::vec3& PathIntegrator::sum_of(const State& path, PathSample& sample) {
  return path.surfaces >= 2 ? sample.indirect : sample.direct;
}

void PathIntegrator::add(const State& path, const glm::vec3& radiance, PathSample& sample) {
  sum_of(path, sample) += path.throughput * radiance;
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

void PathIntegrator::choose_light(const State& path, const SurfacePoint& point,
                                  const SurfaceBrdf& brdf, const glm::vec3& u, PathSample& sample,
                                  Connections& connections) const {
  const std::optional<LightSample> light = lights_.sample(point, u);
  if (!light) return;
  const glm::vec3 reflected = evaluate(brdf, light->direction) * light->radiance;
  if (reflected == glm::vec3(0.0F)) return;
  const float weight = light_weight(*light, pdf(brdf, light->direction));
  if (weight <= 0.0F) return;
  const std::size_t at = connections.count++;
  connections.rays[at] = light->shadow_ray;
  connections.radiance[at] = path.throughput * (reflected * (weight / light->pdf));
  connections.sums[at] = &sum_of(path, sample);
}

/// Casts the shadow rays and adds the light of those that nothing occludes.
void PathIntegrator::connect(Connections& connections, RayCounts& counts) const {
  if (connections.count == 0) return;
  const std::span rays(connections.rays.data(), connections.count);
  counts.shadow += rays.size();
  std::uint32_t occluded = 0;
  if (rays.size() < kFewRays) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (rays_.is_occluded(rays[i])) occluded |= 1U << i;
    }
  } else {
    occluded = rays_.occluded_mask(rays);
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if ((occluded >> i & 1U) == 0) *connections.sums[i] += connections.radiance[i];
  }
  connections.count = 0;
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

/// Meets a surface: its emission, a light, a reflected ray. @return true if the path has one
bool PathIntegrator::advance(State& path, const Hit& hit, SampleSequence& numbers,
                             PathSample& sample, Connections& connections) const {
  add_emission(path, hit, sample);
  if (path.surfaces >= surface_limit_) return false;
  const SurfaceBrdf brdf = meet_surface(path, hit, sample);
  if (is_black(brdf)) return false;
  const glm::vec4 u = numbers.next();
  if (!lights_.is_empty() && is_wanted(path.surfaces)) {
    choose_light(path, hit, brdf, {u.x, u.y, u.z}, sample, connections);
  }
  if (path.surfaces > reflection_limit_) return false;
  return reflect(path, hit, brdf, numbers, u.w);
}

void PathIntegrator::trace(std::span<const Ray> camera_rays, std::span<SampleSequence> numbers,
                           std::span<PathSample> samples, RayCounts& counts) const {
  assert(camera_rays.size() <= kPacketRays && numbers.size() == camera_rays.size() &&
         samples.size() == camera_rays.size());
  std::array<State, kPacketRays> paths;
  std::array<LineHit, kPacketRays> found;
  std::array<std::size_t, kPacketRays> going{};  // paths that have a ray
  std::size_t count = 0;
  Connections connections;
  const std::uint32_t mask = rays_.nearest(camera_rays, found);
  counts.camera += camera_rays.size();
  for (std::size_t i = 0; i < camera_rays.size(); ++i) {
    paths[i].ray = camera_rays[i];
    if ((mask >> i & 1U) == 0) {
      add_environment(paths[i], samples[i]);
    } else if (advance(paths[i], rays_.hit_at(found[i]), numbers[i], samples[i], connections)) {
      going[count++] = i;
    }
  }
  connect(connections, counts);
  Hit hit;
  while (count > 0) {
    counts.bounce += count;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = going[k];
      if (!rays_.intersect(paths[i].ray, hit)) {
        add_environment(paths[i], samples[i]);
      } else if (advance(paths[i], hit, numbers[i], samples[i], connections)) {
        going[kept++] = i;
      }
    }
    connect(connections, counts);
    count = kept;
  }
}

}  // namespace renderers::path_tracing
