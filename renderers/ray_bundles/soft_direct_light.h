#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/ray_tracing/direct_light_pass.h"
#include "renderers/ray_tracing/light_points.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/ray_tracing/surface_brdf.h"
#include "renderers/soft_shadows/percentage_closer.h"

namespace renderers::ray_bundles {

struct SoftLightSettings {
  soft_shadows::PcssSettings shadows;
  int light_points = 64;  ///< of each light, a power of two from 4 on
};

/// Direct light of area lights by percentage-closer soft shadows: the light of fixed points on each
/// lamp as if nothing stood before it, times the share of the lamp that a shadow map from its
/// middle says is visible.
///
/// Source: Hermes et al. 2010, Sec. 6.5 and Fig. 11; Fernando 2005, "Percentage-Closer Soft
/// Shadows", doi:10.1145/1187112.1187153, by `soft_shadows`.
class SoftDirectLight {
 public:
  /// @param rays  must live as long as this
  /// @throws base::InputError if the maps would take too much memory
  /// @throws UnsupportedError if a light is not flat, or there is an environment: it has no middle
  SoftDirectLight(const ray_tracing::RayScene& rays, const SoftLightSettings& settings);
  SoftDirectLight(const SoftDirectLight&) = delete;
  SoftDirectLight& operator=(const SoftDirectLight&) = delete;

  /// Radiance that a point reflects of all area lights, W/(m2 sr). Any thread.
  glm::vec3 reflected(const ray_tracing::SurfacePoint& point,
                      const ray_tracing::SurfaceBrdf& brdf) const;
  /// Rays that made the maps.
  std::uint64_t map_rays() const { return map_rays_; }
  std::int64_t memory_bytes() const { return memory_bytes_; }

 private:
  SoftLightSettings settings_;
  std::vector<ray_tracing::LightPointSet> points_;
  std::vector<soft_shadows::MappedLight> lights_;  ///< of `points_`
  std::uint64_t map_rays_ = 0;
  std::int64_t memory_bytes_ = 0;
};

/// What `ray_tracing::DirectLightPass` makes with its rays spread over the pixels, the area lights
/// by `SoftDirectLight` instead of samples.
/// @param camera_rays  per pixel, >= 1
ray_tracing::DirectLight render_soft_direct(const ray_tracing::RayScene& rays,
                                            const SoftDirectLight& soft,
                                            const ray_tracing::DirectLightJob& job,
                                            int camera_rays);

}  // namespace renderers::ray_bundles
