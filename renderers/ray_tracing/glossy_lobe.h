#pragma once

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/scene/scene.h"

/// Glossy lobes of surfaces, for a reflectance of 1. All are reciprocal and give back no more than
/// they get. n: shading normal; o, i: unit vectors to the viewer and to the light; e: exponent; a:
/// width alpha.
///
/// Phong, the normalised modified one:
///   f(o, i) = (e + 2) / (2 pi) cos^e t
/// t is the angle between i and the mirror direction of o about n; cos^e t is 0 beyond 90 degrees.
/// At normal incidence all light is reflected, less at others.
/// Source: Lafortune and Willems 1994, "Using the modified Phong reflectance model for physically
/// based rendering", report CW 197, K.U. Leuven, Eqs. 2 and 3 (numbers recalled).
///
/// GGX, microfacets that reflect all light at every angle, masking and shadowing correlated:
///   f(o, i) = D(h) G2(o, i) / (4 (n.o) (n.i)),  h = (o + i) / |o + i|
///   D(h)    = a^2 / (pi ((n.h)^2 (a^2 - 1) + 1)^2)
///   G2 / (4 (n.o) (n.i)) = 1 / (2 ((n.i) s(n.o) + (n.o) s(n.i)))
///   s(c)    = sqrt(a^2 + (1 - a^2) c^2)
/// Light that meets several facets is lost: 1 % at alpha 0.1, 69 % at 1 (normal incidence).
/// Source: Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", EGSR,
/// Eqs. 20 and 33; Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based
/// BRDFs", JCGT 3(2), Eqs. 72 and 99 (numbers recalled).
namespace renderers::ray_tracing {

/// A lobe at a point, seen from one direction. Normals are on the viewer's side.
struct SeenLobe {
  scene::GlossyLobe lobe;
  glm::vec3 normal{0.0F};     ///< shading normal
  glm::vec3 to_viewer{0.0F};  ///< unit length
  glm::vec3 mirror{0.0F};     ///< mirror direction of the viewer
};

/// @param normal, to_viewer  unit length
inline SeenLobe see_lobe(const scene::GlossyLobe& lobe, const glm::vec3& normal,
                         const glm::vec3& to_viewer) {
  return {lobe, normal, to_viewer, 2.0F * glm::dot(normal, to_viewer) * normal - to_viewer};
}

/// Exponent of the Phong lobe that is as high in its middle at normal incidence as a lobe of GGX:
/// 1 / (4 pi alpha^2) = (e + 2) / (2 pi). Of a Phong lobe: its own.
inline float equivalent_exponent(const scene::GlossyLobe& lobe) {
  if (lobe.shape == scene::LobeShape::phong) return lobe.exponent;
  return std::max(0.0F, 0.5F / (lobe.alpha * lobe.alpha) - 2.0F);
}

/// GGX's distribution of facet normals, 1/sr. @param h  unit length
inline float ggx_distribution(float alpha, const glm::vec3& normal, const glm::vec3& h) {
  const float cosine = glm::dot(normal, h);
  if (cosine <= 0.0F) return 0.0F;
  // 1 - cos^2 without its cancellation, which sharp lobes would show.
  const glm::vec3 aside = h - cosine * normal;
  const float a2 = alpha * alpha;
  const float term = a2 * cosine * cosine + glm::dot(aside, aside);
  return a2 / (kPi * term * term);
}

/// s(c) of GGX's masking. @param cosine  with the normal, above 0
inline float ggx_slope(float alpha, float cosine) {
  const float a2 = alpha * alpha;
  return std::sqrt(a2 + (1.0F - a2) * cosine * cosine);
}

/// f for an albedo of 1, 1/sr. @param to_light  unit length
inline float lobe_value(const SeenLobe& seen, const glm::vec3& to_light) {
  if (seen.lobe.shape == scene::LobeShape::phong) {
    const float cos_alpha = glm::dot(seen.mirror, to_light);
    if (cos_alpha <= 0.0F) return 0.0F;
    return (seen.lobe.exponent + 2.0F) / (2.0F * kPi) * std::pow(cos_alpha, seen.lobe.exponent);
  }
  const float out = glm::dot(seen.normal, seen.to_viewer);
  const float in = glm::dot(seen.normal, to_light);
  if (out <= 0.0F || in <= 0.0F) return 0.0F;
  const float alpha = seen.lobe.alpha;
  const glm::vec3 h = glm::normalize(seen.to_viewer + to_light);
  return ggx_distribution(alpha, seen.normal, h) /
         (2.0F * (in * ggx_slope(alpha, out) + out * ggx_slope(alpha, in)));
}

/// Density of `sample_lobe` for a direction, 1/sr.
///
/// Phong: (e + 1) / (2 pi) cos^e t. GGX, of facets that the viewer sees:
/// D(h) / (2 ((n.o) + s(n.o))) (Heitz 2018, "Sampling the GGX Distribution of Visible Normals",
/// JCGT 7(4), Eqs. 2, 3 and 17; numbers recalled).
inline float lobe_density(const SeenLobe& seen, const glm::vec3& to_light) {
  if (seen.lobe.shape == scene::LobeShape::phong) {
    const float cos_alpha = glm::dot(seen.mirror, to_light);
    if (cos_alpha <= 0.0F) return 0.0F;
    return (seen.lobe.exponent + 1.0F) / (2.0F * kPi) * std::pow(cos_alpha, seen.lobe.exponent);
  }
  const float out = glm::dot(seen.normal, seen.to_viewer);
  const glm::vec3 sum = seen.to_viewer + to_light;
  if (out <= 0.0F || sum == glm::vec3(0.0F)) return 0.0F;
  const float alpha = seen.lobe.alpha;
  return ggx_distribution(alpha, seen.normal, glm::normalize(sum)) /
         (2.0F * (out + ggx_slope(alpha, out)));
}

/// Facet normal of GGX around +z, drawn from those that a direction sees.
/// @param out  to the viewer, unit length, z above 0  @param u  in [0, 1)^2
/// Source: Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", CGF 42(8),
/// Listing 3 (number recalled).
inline glm::vec3 ggx_visible_normal(float alpha, const glm::vec3& out, const glm::vec2& u) {
  const glm::vec3 stretched = glm::normalize(glm::vec3(alpha * out.x, alpha * out.y, out.z));
  const float azimuth_rad = 2.0F * kPi * u.x;
  const float z = (1.0F - u.y) * (1.0F + stretched.z) - stretched.z;
  const float sine = std::sqrt(std::clamp(1.0F - z * z, 0.0F, 1.0F));
  const glm::vec3 cap(sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), z);
  const glm::vec3 h = cap + stretched;
  return glm::normalize(glm::vec3(alpha * h.x, alpha * h.y, h.z));
}

/// Draws a direction, unit length; it may lie below the surface.
/// @param u  in [0, 1)^2
inline glm::vec3 sample_lobe(const SeenLobe& seen, const glm::vec2& u) {
  if (seen.lobe.shape == scene::LobeShape::phong) {
    const glm::vec3 local = cosine_power_lobe(u, seen.lobe.exponent);
    return glm::normalize(frame_around(seen.mirror).to_world(local));
  }
  const Frame3 frame = frame_around(seen.normal);
  // A viewer below the shading normal's plane sees no facet; the density is 0 there.
  constexpr float kLeastCosine = 1e-6F;
  const glm::vec3 out(glm::dot(frame.tangent, seen.to_viewer),
                      glm::dot(frame.bitangent, seen.to_viewer),
                      std::max(kLeastCosine, glm::dot(frame.normal, seen.to_viewer)));
  const glm::vec3 h = frame.to_world(ggx_visible_normal(seen.lobe.alpha, out, u));
  return glm::normalize(2.0F * glm::dot(seen.to_viewer, h) * h - seen.to_viewer);
}

}  // namespace renderers::ray_tracing
