#include "renderers/path_tracing/path_integrator.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <glm/common.hpp>
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
using ray_tracing::RayOrder;
using ray_tracing::RayScene;
using ray_tracing::SampleSequence;
using ray_tracing::SurfaceBrdf;
using ray_tracing::SurfacePoint;

/// Roulette lets at most this share of the paths survive a surface, so that a scene that absorbs
/// nothing ends, too; the weight grows by the inverse and the mean stays. Ours.
constexpr float kGreatestSurvival = 0.95F;

/// Fewer rays than this are cast one by one: a packet costs as much as a few. Measured.
constexpr std::size_t kFewRays = 8;

float largest(const glm::vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }

/// False for a way along the surface's plane, or one so short that rounding decides on which side
/// of it the other end lies: the light of a lamp behind a wall would come through it there.
/// @param error  bound of the way's error, per coordinate
bool leaves_plane(const SurfacePoint& surface, const glm::vec3& way, const glm::vec3& error) {
  return std::fabs(glm::dot(surface.geometric_normal, way)) >
         glm::dot(glm::abs(surface.geometric_normal), error);
}

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
  if (settings.light_rays) {
    light_vertices_.emplace(rays, lights);
    if (light_vertices_->is_empty()) light_vertices_.reset();
  }
}

void PathIntegrator::Connections::add(const Ray& ray, const glm::vec3& light, glm::vec3& sum) {
  assert(count < kPacketRays);
  rays[count] = ray;
  radiance[count] = light;
  sums[count] = &sum;
  count += 1;
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

float PathIntegrator::light_weight(const State& path, const Hit& hit, const LightSample& light,
                                   float hit_pdf) const {
  if (light.is_delta && light_vertices_ && path.surfaces >= 2) {
    // The ray that came here, or one from the lamp: densities of this surface point, 1/m2.
    const float cosine = std::fabs(glm::dot(hit.geometric_normal, path.ray.direction));
    return power_heuristic(light.pdf * path.pdf * cosine / (hit.t * hit.t),
                           light_vertices_->pdf(light.light, hit, light.direction));
  }
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

Lobes PathIntegrator::lobes_at(int surface) const {
  return surface == 1 || settings_.claims.transport == Transport::full ? Lobes::all
                                                                       : Lobes::diffuse;
}

/// What bounds G = cos cos / d2 of the segment between the surface seen and the next one, the
/// segment that a virtual point light's connection to the seen surface takes.
float PathIntegrator::clamp_factor(float cosine, float other_cosine, float distance2_m2) const {
  if (geometry_clamp_ <= 0.0F) return 1.0F;
  const float geometry = cosine * other_cosine / distance2_m2;
  return geometry > geometry_clamp_ ? geometry_clamp_ / geometry : 1.0F;
}

SurfaceBrdf PathIntegrator::meet_surface(State& path, const Hit& hit, PathSample& sample) const {
  path.surfaces += 1;
  const glm::vec3 to_viewer = -path.ray.direction;
  const SurfaceBrdf brdf = make_brdf(rays_.scene(), hit, to_viewer, lobes_at(path.surfaces));
  if (path.surfaces == 1) {
    sample.albedo = brdf.diffuse + brdf.glossy.lobe.albedo;
    sample.normal = brdf.normal;
    sample.depth_m = hit.t;
    sample.has_surface = true;
  } else if (path.surfaces == 2) {
    path.throughput *=
        clamp_factor(path.last_cosine, std::fabs(glm::dot(brdf.normal, to_viewer)), hit.t * hit.t);
  }
  return brdf;
}

void PathIntegrator::choose_light(const State& path, const Hit& hit, const SurfaceBrdf& brdf,
                                  const glm::vec3& u, PathSample& sample,
                                  Connections& connections) const {
  const std::optional<LightSample> light = lights_.sample(hit, u);
  if (!light) return;
  const glm::vec3 reflected = evaluate(brdf, light->direction) * light->radiance;
  if (reflected == glm::vec3(0.0F)) return;
  const float weight = light_weight(path, hit, *light, pdf(brdf, light->direction));
  if (weight <= 0.0F) return;
  connections.add(light->shadow_ray, path.throughput * (reflected * (weight / light->pdf)),
                  sum_of(path, sample));
}

/// Light of the path's light vertex at a surface: one more surface on the way from the lamp.
void PathIntegrator::choose_light_vertex(const State& path, const SurfacePoint& point,
                                         const SurfaceBrdf& brdf, PathSample& sample,
                                         Connections& connections) const {
  if (!path.light_vertex || path.surfaces >= surface_limit_) return;
  const LightVertex& vertex = *path.light_vertex;
  const glm::vec3 way = vertex.point.position - point.position;
  const glm::vec3 error = point.position_error + vertex.point.position_error;
  if (!leaves_plane(point, way, error) || !leaves_plane(vertex.point, way, error)) return;
  const float distance2 = glm::dot(way, way);
  const glm::vec3 direction = way / std::sqrt(distance2);
  const glm::vec3 here = evaluate(brdf, direction);
  if (here == glm::vec3(0.0F)) return;
  const SurfaceBrdf there_brdf =
      make_brdf(rays_.scene(), vertex.point, -direction, lobes_at(path.surfaces + 1));
  const glm::vec3 there = evaluate(there_brdf, vertex.to_light);
  if (there == glm::vec3(0.0F)) return;
  const float per_area = std::fabs(glm::dot(vertex.point.geometric_normal, direction)) / distance2;
  const float weight =
      power_heuristic(vertex.pdf, vertex.light_probability * pdf(brdf, direction) * per_area);
  glm::vec3 light = here * there * vertex.power * (weight * per_area / vertex.cosine);
  if (path.surfaces == 1) {
    light *= clamp_factor(glm::dot(brdf.normal, direction),
                          std::fabs(glm::dot(there_brdf.normal, direction)), distance2);
  }
  connections.add(segment_to(point, vertex.point), path.throughput * light, sample.indirect);
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
                             PathSample& sample, Senders& senders) const {
  add_emission(path, hit, sample);
  if (path.surfaces >= surface_limit_) return false;
  const SurfaceBrdf brdf = meet_surface(path, hit, sample);
  if (is_black(brdf)) return false;
  glm::vec4 u(0.0F);
  if (lights_.has_choice() || brdf.glossy_share > 0.0F) {
    u = numbers.next();
  } else {
    numbers.skip();
  }
  if (!lights_.is_empty() && is_wanted(path.surfaces)) {
    choose_light(path, hit, brdf, {u.x, u.y, u.z}, sample, senders.lights);
  }
  choose_light_vertex(path, hit, brdf, sample, senders.light_vertices);
  if (path.surfaces > reflection_limit_) return false;
  return reflect(path, hit, brdf, numbers, u.w);
}

/// Reflected rays' hits, bit i of the result for ray i.
std::uint32_t PathIntegrator::find_nearest(std::span<const Ray> rays,
                                           std::span<LineHit> found) const {
  if (rays.size() >= kFewRays) return rays_.nearest(rays, found, RayOrder::scattered);
  std::uint32_t mask = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays_.nearest(rays[i], found[i])) mask |= 1U << i;
  }
  return mask;
}

void PathIntegrator::start(State& path, const Ray& camera_ray, SampleSequence& numbers,
                           RayCounts& counts) const {
  path.ray = camera_ray;
  if (!light_vertices_) return;
  if (surface_limit_ < 2) {
    numbers.skip();  // the next ones are those of longer paths
    return;
  }
  path.light_vertex = light_vertices_->sample(glm::vec3(numbers.next()));
  counts.light += 1;
}

void PathIntegrator::trace(std::span<const Ray> camera_rays, std::span<SampleSequence> numbers,
                           std::span<PathSample> samples, RayCounts& counts) const {
  assert(camera_rays.size() <= kPacketRays && numbers.size() == camera_rays.size() &&
         samples.size() == camera_rays.size());
  std::array<State, kPacketRays> paths;
  std::array<std::size_t, kPacketRays> going{};  // paths that have a ray
  std::array<Ray, kPacketRays> rays;             // theirs
  std::array<LineHit, kPacketRays> found;
  Senders senders;
  std::size_t count = camera_rays.size();
  for (std::size_t i = 0; i < count; ++i) {
    start(paths[i], camera_rays[i], numbers[i], counts);
    going[i] = i;
  }
  counts.camera += count;
  std::uint32_t mask = rays_.nearest(camera_rays, found, RayOrder::beside);
  while (count > 0) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = going[k];
      if ((mask >> k & 1U) == 0) {
        add_environment(paths[i], samples[i]);
      } else if (advance(paths[i], rays_.hit_at(found[k]), numbers[i], samples[i], senders)) {
        going[kept++] = i;
      }
    }
    connect(senders.lights, counts);
    connect(senders.light_vertices, counts);
    count = kept;
    counts.bounce += count;
    for (std::size_t k = 0; k < count; ++k) rays[k] = paths[going[k]].ray;
    mask = find_nearest(std::span(rays).first(count), found);
  }
}

}  // namespace renderers::path_tracing
