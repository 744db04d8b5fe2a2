#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "renderers/indirect_view/indirect_light.h"
#include "renderers/ray_tracing/light_sampler.h"

namespace renderers::indirect_view {

/// Irradiance from all lights, by one sample on them and a shadow ray, W/m2. @param u  in [0, 1)^3
/// @param cast  counts the rays
glm::vec3 sampled_light(const ray_tracing::RayScene& rays, const ray_tracing::LightSampler& lights,
                        const ViewedPoint& point, const glm::vec3& u, std::uint64_t& cast);

/// Lambert's albedo / pi at a point, 1/sr.
glm::vec3 reflectance_of(const ray_tracing::RayScene& rays, const ViewedPoint& point);

}  // namespace renderers::indirect_view
