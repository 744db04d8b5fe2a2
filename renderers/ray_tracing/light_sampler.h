#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/ray_tracing/environment_sampler.h"
#include "renderers/ray_tracing/piecewise_distribution.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::ray_tracing {

/// One light as seen from a surface point.
struct LightSample {
  glm::vec3 direction{0.0F};  ///< unit length, from the surface to the light
  glm::vec3 radiance{0.0F};   ///< radiance; irradiance per cosine (I / d2) of a point or spot light
  float pdf = 0.0F;           ///< 1/sr; the probability of the choice if `is_delta`
  bool is_delta = false;      ///< a point or spot light: no ray can hit it
  std::uint32_t light = 0;    ///< index into Scene::lights if `sample` chose such a light
  Ray shadow_ray;             ///< the light is seen if nothing occludes it
};

/// Weight of a sample drawn with density p when another strategy has density q there; p > 0.
/// Power heuristic with exponent 2, Veach and Guibas 1995, "Optimally Combining Sampling Techniques
/// for Monte Carlo Rendering", doi:10.1145/218380.218498, Sec. 4.1 (number recalled):
/// p^2 / (p^2 + q^2), as a ratio that cannot overflow.
inline float power_heuristic(float p, float q) {
  const float ratio = q / p;
  return 1.0F / (1.0F + ratio * ratio);
}

/// Which lights a sampler chooses among.
enum class LightSet {
  all,
  hittable  ///< those that rays can meet: emissive triangles and the environment
};

/// Chooses among the lights of a scene by power: point and spot lights, emissive triangles (one
/// by one; textured emission counts with the texture's mean), and the environment.
///
/// Source: Shirley, Wang, Zimmerman 1996, "Monte Carlo Techniques for Direct Lighting
/// Calculations", doi:10.1145/226150.226151 (one light per sample, any positive probabilities).
class LightSampler {
 public:
  /// @param rays  must live as long as this, with its scene
  explicit LightSampler(const RayScene& rays, LightSet set = LightSet::all);

  /// True if there is no light in the set.
  bool is_empty() const { return choice_.total() <= 0.0; }
  /// False if `sample` finds the same whatever the numbers: there is one light, and it is a point.
  bool has_choice() const { return choice_.size() != 1 || can_be_hit_; }
  /// True if rays can find light: emissive triangles or an environment.
  bool can_be_hit() const { return can_be_hit_; }

  /// @param u  in [0, 1)^3: the choice, and a position on the light
  /// @return nothing if the light cannot light the point
  std::optional<LightSample> sample(const SurfacePoint& from, const glm::vec3& u) const;

  /// Probability with which `sample` chooses a point or spot light.
  /// @param light  index into Scene::lights
  float probability_of(std::uint32_t light) const { return choice_.probability(light); }

  /// One given point or spot light, chosen for certain.
  /// @return nothing if the point lies on the light
  std::optional<LightSample> sample_point_light(const scene::Light& light,
                                                const SurfacePoint& from) const;

  /// Radiance leaving a surface point; the front side only. @param direction  unit length, away
  glm::vec3 emission(const SurfacePoint& point, const glm::vec3& direction) const;
  /// Radiance from outside the scene. @param direction  unit length
  glm::vec3 environment(const glm::vec3& direction) const;

  /// Density with which `sample` finds a point of a triangle, 1/sr.
  /// @param direction  unit length, to the light  @param distance_m  from the lit point
  float pdf_of_emission(const SurfacePoint& light, const glm::vec3& direction,
                        float distance_m) const;
  /// Density with which `sample` finds a direction in the environment, 1/sr.
  float pdf_of_environment(const glm::vec3& direction) const;

 private:
  struct EmissiveTriangle {
    std::uint32_t object;
    std::uint32_t triangle;
  };

  void add_triangles(std::uint32_t object, std::vector<double>& powers);
  std::optional<LightSample> sample_triangle(const EmissiveTriangle& light,
                                             const SurfacePoint& from, const glm::vec2& u) const;
  std::optional<LightSample> sample_environment(const SurfacePoint& from, const glm::vec2& u) const;

  const RayScene* rays_;
  PiecewiseDistribution choice_;  ///< point and spot lights, triangles, environment, in this order
  std::vector<EmissiveTriangle> triangles_;
  std::vector<std::vector<float>> area_pdf_;  ///< [object][triangle], 1/m2; empty: not emissive
  std::optional<EnvironmentSampler> environment_;
  float environment_probability_ = 0.0F;
  bool can_be_hit_ = false;
};

}  // namespace renderers::ray_tracing
