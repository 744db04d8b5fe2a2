#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "renderers/many_lights/ray_gather.h"
#include "renderers/many_lights/surface_image.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::many_lights {

struct BiasCompensationSettings {
  float geometry_clamp = 0.0F;  ///< b of the gather, 1/m2; 0: none, nothing is lost
  int rays = 1;                 ///< per pixel and pass, >= 1
  glm::vec3 camera_position{0.0F};
  std::uint64_t seed = 1;
  std::uint32_t pass = 0;           ///< passes of one seed continue the same sequences of samples
  float epsilon = kDefaultEpsilon;  ///< see `kDefaultEpsilon`
};

struct CompensatedLight {
  /// rgb, W/(m2 sr), to be added to the picture's radiance; w: 1 on a surface, else 0 and black.
  std::vector<glm::vec4> radiance;
  std::uint64_t short_rays = 0;   ///< from the receivers
  std::uint64_t kept_hits = 0;    ///< of the short rays, with G > b
  std::uint64_t shadow_rays = 0;  ///< from the hits
};

/// The light that the bound b of the geometry term takes away from one bounce: the same integral
/// with the weight max(0, (G - b) / G), so that a clamped gather plus this is the unclamped one in
/// expectation. G = cos cos / d2 by shading normals, as in virtual_light.h.
///
/// From every receiver, rays are drawn by its BRDF (cosine-distributed on Lambert surfaces). Only
/// hits with G > b count; as G <= cos / d2 at the receiver's cosine, rays end after sqrt(cos / b).
/// A hit reflects its direct light (one light chosen by power, one shadow ray) by its Lambert lobe
/// alone.
///
/// The image does not depend on the number of threads.
///
/// @param lights  of the same rays
/// @throws base::InputError if `rays` is below 1 or the clamp below 0
/// Source: Kollig and Keller 2004, "Illumination in the Presence of Weak Singularities",
/// doi:10.1007/3-540-31186-6_15, Sec. 3 (recalled).
CompensatedLight compensate_bias(const ray_tracing::RayScene& rays,
                                 const ray_tracing::LightSampler& lights,
                                 const SurfaceImage& surfaces,
                                 const BiasCompensationSettings& settings);

}  // namespace renderers::many_lights
