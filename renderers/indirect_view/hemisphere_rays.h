#pragma once

#include <cstdint>
#include <functional>

#include <glm/vec2.hpp>

#include "renderers/indirect_view/indirect_light.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::indirect_view {

/// How the directions of a hemisphere are spread.
enum class HemisphereSequence {
  random,  ///< independent
  strata,  ///< one in each cell of a grid that is as square as the count allows
  sobol    ///< Owen-scrambled Sobol' points, going on from sample to sample of a pixel
};

struct HemisphereRays {
  int rays = 256;  ///< per point, >= 1
  HemisphereSequence sequence = HemisphereSequence::sobol;
};

/// Point of the unit square for a ray of a hemisphere. @param ray  in [0, settings.rays)
glm::vec2 hemisphere_sample(const HemisphereRays& settings, const ViewedPoint& point, int ray);

/// What a ray found: the surface, and how far away it is.
using RayRadiance = std::function<glm::vec3(const ViewedPoint& seen, float distance_m)>;

/// Irradiance by cosine-distributed rays: pi / N times the sum of what they find; rays that leave
/// the scene or the point's side of its triangle find nothing.
///
/// @param radiance  called for each surface met; its random numbers are those of the ray
/// @param cast      counts the rays
/// Source: Reichert 1992, "A Two-Pass Radiosity Method Driven by Lights and Viewer Position",
/// M.S. thesis, Cornell University (final gather; recalled); Jensen 1996, "Global Illumination
/// using Photon Maps", doi:10.1007/978-3-7091-7484-5_3, Sec. 3.
glm::vec3 gather_irradiance(const ray_tracing::RayScene& rays, const ViewedPoint& point,
                            const HemisphereRays& settings, const RayRadiance& radiance,
                            std::uint64_t& cast);

}  // namespace renderers::indirect_view
