#include "renderers/many_lights/light_emitters.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "renderers/many_lights/emitter_views.h"
#include "renderers/many_lights/halton.h"
#include "renderers/many_lights/surface_emitters.h"
#include "renderers/ray_tracing/light_cone.h"

namespace renderers::many_lights {

namespace {

constexpr double kPi = std::numbers::pi;

/// The widest cone that one perspective map covers; a map's texels thin out towards its edge by
/// cos^3, 1/8 there.
constexpr double kWidestMapHalfAngle_rad = kPi / 3.0;

glm::dvec3 intensity(const scene::Light& light, const glm::dvec3& direction) {
  return glm::dvec3(scene::intensity_towards(light, glm::vec3(direction)));
}

std::vector<opengl::View> views_of(const scene::Light& light) {
  if (light.type == scene::LightType::point) {
    return cube_views(light.position, {0.0F, 0.0F, 1.0F});
  }
  if (static_cast<double>(light.outer_cone_rad) > kWidestMapHalfAngle_rad) {
    return cube_views(light.position, light.direction);
  }
  opengl::View view = view_along(light.position, light.direction);
  view.half_width = std::tan(light.outer_cone_rad);
  view.half_height = view.half_width;
  return {view};
}

EmittedSample map_sample_at(const scene::Light& light, const std::vector<opengl::View>& views,
                            int face, const glm::dvec2& point, double share) {
  const opengl::View& view = views[static_cast<std::size_t>(face)];
  const glm::dvec3 flux =
      intensity(light, direction_through(view, point)) * (map_solid_angle_sr(view, point) * share);
  return {face, point, flux};
}

/// Evenly over the maps of a light, its faces in turn.
EmittedSample map_sample(const scene::Light& light, const std::vector<opengl::View>& views,
                         int index, int count, int pass) {
  const int faces = static_cast<int>(views.size());
  if (count < faces) {
    // Too few for all faces: the passes go on where the last one ended, each sample for all faces.
    const std::int64_t number = index + static_cast<std::int64_t>(pass) * count;
    return map_sample_at(light, views, static_cast<int>(number % faces),
                         halton_point(static_cast<int>(number / faces), 1, 0),
                         static_cast<double>(faces) / count);
  }
  const int face = index % faces;
  const int most_per_face = (count + faces - 1) / faces;
  const int on_face = (count - face + faces - 1) / faces;
  return map_sample_at(light, views, face, halton_point(index / faces, most_per_face, pass),
                       1.0 / on_face);
}

/// Evenly over the cone (of a point light: the sphere) around the first view's axis.
EmittedSample solid_angle_sample(const scene::Light& light, const std::vector<opengl::View>& views,
                                 int index, int count, int pass) {
  const bool is_point = light.type == scene::LightType::point;
  const double height = is_point ? 2.0 : 1.0 - std::cos(static_cast<double>(light.outer_cone_rad));
  const auto u = halton_point(index, count, pass);
  const double cosine = 1.0 - height * u.x;
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double azimuth_rad = 2.0 * kPi * u.y;
  const opengl::View axes = view_along(light.position, light.direction);
  const glm::dvec3 towards = glm::dvec3(axes.right) * (sine * std::cos(azimuth_rad)) +
                             glm::dvec3(axes.up) * (sine * std::sin(azimuth_rad)) +
                             glm::dvec3(axes.forward) * cosine;
  const MapPlace place = place_of(views, towards);
  const double solid_angle_sr = 2.0 * kPi * height / count;
  return {place.view, place.position, intensity(light, towards) * solid_angle_sr};
}

Emitter light_emitter(const scene::Light& light, LightSampling sampling) {
  Emitter emitter;
  emitter.kind = light.type == scene::LightType::point ? EmitterKind::point : EmitterKind::spot;
  emitter.views = views_of(light);
  emitter.flux = ray_tracing::flux_solid_angle_sr(light) * glm::dvec3(light.intensity);
  emitter.sample = [light, views = emitter.views, sampling](int index, int count, int pass) {
    return sampling == LightSampling::map ? map_sample(light, views, index, count, pass)
                                          : solid_angle_sample(light, views, index, count, pass);
  };
  return emitter;
}

bool has_no_flux(const Emitter& emitter) { return luminance(emitter.flux) <= 0.0; }

}  // namespace

double luminance(const glm::dvec3& color) {
  return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722));
}

bool has_point_set(const Emitter& emitter) {
  return emitter.kind == EmitterKind::area || emitter.kind == EmitterKind::environment;
}

std::vector<Emitter> make_emitters(const scene::Scene& scene, const EmitterSettings& settings) {
  std::vector<Emitter> emitters;
  for (const scene::Light& light : scene.lights) {
    emitters.push_back(light_emitter(light, settings.sampling));
  }
  std::erase_if(emitters, has_no_flux);
  remake_point_sets(scene, settings, emitters);
  return emitters;
}

void remake_point_sets(const scene::Scene& scene, const EmitterSettings& settings,
                       std::vector<Emitter>& emitters) {
  std::erase_if(emitters, has_point_set);
  emitters.push_back(area_emitter(scene, settings));
  emitters.push_back(environment_emitter(scene, settings));
  std::erase_if(emitters, has_no_flux);
}

}  // namespace renderers::many_lights
