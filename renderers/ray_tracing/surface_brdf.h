#pragma once

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/glossy_lobe.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/scene/emission_profile.h"

/// Lambert plus a glossy lobe: f(wo, wi) = rho_d / pi + rho_s f_s(wo, wi), f_s of `glossy_lobe.h`.
namespace renderers::ray_tracing {

/// Relative luminance of linear Rec.709 (ITU-R BT.709-6, item 3.2).
inline float luminance(const glm::vec3& color) {
  return 0.2126F * color.r + 0.7152F * color.g + 0.0722F * color.b;
}

/// The BRDF at a point, seen from one direction. Normals are on the viewer's side: both sides of a
/// surface reflect alike.
struct SurfaceBrdf {
  glm::vec3 geometric_normal{0.0F};
  glm::vec3 normal{0.0F};     ///< shading normal
  glm::vec3 diffuse{0.0F};    ///< rho_d
  SeenLobe glossy;            ///< its albedo is rho_s
  float glossy_share = 0.0F;  ///< probability that a sample is drawn from the lobe
};

struct BrdfSample {
  glm::vec3 direction{0.0F};
  glm::vec3 value{0.0F};  ///< f cos, 1/sr; zero if the sample fell below the surface
  float pdf = 0.0F;       ///< 1/sr
};

/// Which lobes of a material reflect.
enum class Lobes { all, diffuse };

/// Albedo of the material at a point, texture included.
inline glm::vec3 diffuse_albedo(const scene::Scene& scene, const SurfacePoint& point) {
  const scene::Material& material = scene.materials[static_cast<std::size_t>(point.material)];
  if (material.albedo_texture == scene::kNoTexture) return material.albedo;
  const auto texture = static_cast<std::size_t>(material.albedo_texture);
  return material.albedo * scene::sample_texture(scene.textures[texture], point.uv);
}

/// Radiance of the material at a point of its front side where its emission profile is 1, texture
/// included, W/(m2 sr).
inline glm::vec3 unshaped_emission(const scene::Scene& scene, const SurfacePoint& point) {
  const scene::Material& material = scene.materials[static_cast<std::size_t>(point.material)];
  if (material.emission_texture == scene::kNoTexture) return material.emission;
  const auto texture = static_cast<std::size_t>(material.emission_texture);
  return material.emission * scene::sample_texture(scene.textures[texture], point.uv);
}

/// Radiance that the material emits at a point of its front side, W/(m2 sr).
/// @param cosine  of the angle between the direction and the geometric normal
inline glm::vec3 emitted_radiance(const scene::Scene& scene, const SurfacePoint& point,
                                  float cosine) {
  const scene::Material& material = scene.materials[static_cast<std::size_t>(point.material)];
  return scene::emission_factor(material.emission_profile, cosine) *
         unshaped_emission(scene, point);
}

/// Adds a material's lobe to a BRDF that has its normals and `diffuse`.
/// @param to_viewer  unit length
inline void add_glossy_lobe(const scene::Material& material, const glm::vec3& to_viewer,
                            SurfaceBrdf& brdf) {
  brdf.glossy = see_lobe(material.lobe, brdf.normal, to_viewer);
  const float glossy = luminance(material.lobe.albedo);
  brdf.glossy_share = glossy / (glossy + luminance(brdf.diffuse));
}

/// @param to_viewer  unit length
inline SurfaceBrdf make_brdf(const scene::Scene& scene, const SurfacePoint& point,
                             const glm::vec3& to_viewer, Lobes lobes) {
  const scene::Material& material = scene.materials[static_cast<std::size_t>(point.material)];
  const float side = glm::dot(point.geometric_normal, to_viewer) < 0.0F ? -1.0F : 1.0F;
  SurfaceBrdf brdf;
  brdf.geometric_normal = side * point.geometric_normal;
  brdf.normal = side * point.shading_normal;
  brdf.diffuse = diffuse_albedo(scene, point);
  if (lobes == Lobes::all && material.is_glossy()) add_glossy_lobe(material, to_viewer, brdf);
  return brdf;
}

/// True if the surface reflects nothing.
inline bool is_black(const SurfaceBrdf& brdf) {
  return brdf.diffuse == glm::vec3(0.0F) && brdf.glossy.lobe.albedo == glm::vec3(0.0F);
}

/// f cos of light arriving from a direction, 1/sr; zero from below the surface, by either normal.
/// @param to_light  unit length
inline glm::vec3 evaluate(const SurfaceBrdf& brdf, const glm::vec3& to_light) {
  const float cosine = glm::dot(brdf.normal, to_light);
  if (cosine <= 0.0F || glm::dot(brdf.geometric_normal, to_light) <= 0.0F) return glm::vec3(0.0F);
  glm::vec3 value = brdf.diffuse * (1.0F / kPi);
  if (brdf.glossy_share > 0.0F) {
    value += brdf.glossy.lobe.albedo * lobe_value(brdf.glossy, to_light);
  }
  return value * cosine;
}

/// Density of `sample` for a direction, 1/sr: (1 - s) cos / pi + s `lobe_density`.
inline float pdf(const SurfaceBrdf& brdf, const glm::vec3& to_light) {
  const float cosine = std::max(0.0F, glm::dot(brdf.normal, to_light));
  float density = (1.0F - brdf.glossy_share) * cosine / kPi;
  if (brdf.glossy_share > 0.0F) {
    density += brdf.glossy_share * lobe_density(brdf.glossy, to_light);
  }
  return density;
}

/// Draws a direction from one of the lobes.
/// @param lobe_u  in [0, 1), picks the lobe  @param u  in [0, 1)^2
inline BrdfSample sample(const SurfaceBrdf& brdf, float lobe_u, const glm::vec2& u) {
  BrdfSample drawn;
  drawn.direction = lobe_u < brdf.glossy_share
                        ? sample_lobe(brdf.glossy, u)
                        : glm::normalize(frame_around(brdf.normal).to_world(cosine_hemisphere(u)));
  drawn.pdf = pdf(brdf, drawn.direction);
  if (drawn.pdf > 0.0F) drawn.value = evaluate(brdf, drawn.direction);
  return drawn;
}

}  // namespace renderers::ray_tracing
