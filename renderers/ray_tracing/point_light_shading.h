#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::ray_tracing {

/// Radiance that a point reflects of all point and spot lights, W/(m2 sr): one shadow ray to each
/// that the BRDF would reflect.
/// @param lights  of the scene  @param shadow_rays  counts them
glm::vec3 reflected_point_lights(const RayScene& rays, const LightSampler& lights,
                                 const SurfacePoint& point, const SurfaceBrdf& brdf,
                                 std::uint64_t& shadow_rays);

}  // namespace renderers::ray_tracing
