#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/light_propagation/light_volume.h"
#include "renderers/light_propagation/surface_samples.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::light_propagation {

/// Flux that a surface sample reflects to either side, W.
struct ReflectedFlux {
  glm::vec3 front{0.0F};
  glm::vec3 back{0.0F};
};

struct GatheredLight {
  std::vector<ReflectedFlux> samples;
  std::uint64_t rays = 0;
};

/// Direct light of all lights at the samples: albedo x irradiance x area, both sides. Area lights
/// and environment by fixed points, point and spot lights by a ray each.
/// Source: Koa and Johan 2016, doi:10.1145/2949035.2949043, Sec. 3.2 (gathering rays).
/// @param light_points  of each light, a power of two from 4 on
GatheredLight light_samples(const ray_tracing::RayScene& rays,
                            const std::vector<SurfaceSample>& samples, int light_points);

/// Puts the reflected flux into the cells half a cell in front of the samples: flux / pi times the
/// cosine lobe, so that a cell holds the flux that its samples reflect.
/// Differs from the paper: nothing is divided by the number of samples, they have areas.
LightVolume inject(const Grid& grid, const std::vector<SurfaceSample>& samples,
                   const std::vector<ReflectedFlux>& flux);

/// Surfaces block light that comes against their front, by their exact areas around each node.
BlockingVolume block_by(const ray_tracing::RayScene& rays, const Grid& grid);

}  // namespace renderers::light_propagation
