#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "perception/image.h"
#include "renderers/area_shadows/pixel_surfaces.h"
#include "renderers/area_shadows/point_visibility.h"
#include "renderers/ray_tracing/light_points.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::area_shadows {

/// Radiance that does not come from the irradiance of area lights and environment.
struct OtherLight {
  perception::Image radiance;  ///< R, G, B
  std::uint64_t rays = 0;
};

/// Light of point and spot lights by their whole BRDF, one shadow ray per pixel and light.
OtherLight add_point_lights(const ray_tracing::RayScene& rays, const PixelSurfaces& surfaces);

/// Glossy lobes at the pixels that have one: each light point is tested and weighed by the lobe.
/// Few points look like dots in a narrow lobe.
/// @param timer  what the rays' device takes is named below the open stage
OtherLight add_glossy_lobes(const scene::Scene& scene, const PixelSurfaces& surfaces,
                            const std::vector<ray_tracing::LightPointSet>& lights,
                            PointVisibility& visibility, StageTimer& timer);

/// Direct light: seen + others + irradiance x albedo / pi.
/// @param irradiance  one per pixel, W/m2
perception::Image compose(const PixelSurfaces& surfaces, const std::vector<glm::vec3>& irradiance,
                          const std::vector<const OtherLight*>& others);

/// Values per pixel as a picture of R, G, B.
perception::Image image_of(const PixelSurfaces& surfaces, const std::vector<glm::vec3>& values);

}  // namespace renderers::area_shadows
