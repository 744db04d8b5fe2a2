#pragma once

#include <vector>

#include "renderers/light_propagation/sample_light.h"
#include "renderers/light_propagation/surface_samples.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::light_propagation {

/// What point and spot lights shine on, with the flux that it reflects.
struct ReflectiveMap {
  std::vector<SurfaceSample> samples;  ///< of no area: their flux is known without
  GatheredLight light;
};

/// The reflective shadow maps of all point and spot lights: rays of equal solid angle from each,
/// along a spiral over the sphere or a spot's cone; where one meets a surface it leaves intensity x
/// solid angle x albedo on the side it came to.
///
/// Source: Kaplanyan and Dachsbacher 2010, doi:10.1145/1730804.1730821 (recalled), after
/// Dachsbacher and Stamminger 2005, doi:10.1145/1053427.1053460. Differs from both: texels are rays
/// of equal solid angle instead of pixels of a projection.
///
/// @param rays_per_light  >= 1
/// @throws UnsupportedError if the scene has area lights or an environment, which have no such map
ReflectiveMap reflective_map(const ray_tracing::RayScene& rays, int rays_per_light);

}  // namespace renderers::light_propagation
