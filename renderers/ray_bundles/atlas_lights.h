#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/ray_bundles/soft_direct_light.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/texel_atlas/texel_atlas.h"

namespace renderers::ray_bundles {

struct AtlasLightSettings {
  /// Area lights and environment too; otherwise point and spot lights alone, which no bundle meets.
  bool with_areas = true;
  int light_samples = 4;                  ///< of area lights and environment, per side
  const SoftDirectLight* soft = nullptr;  ///< not null: area lights by it, instead of samples
  bool has_back_sides = true;
  std::uint64_t seed = 1;
};

struct AtlasLight {
  std::vector<glm::vec3> incident;  ///< J = E / pi per side, W/(m2 sr)
  std::uint64_t shadow_rays = 0;
};

/// Direct light at the points of the texels by next-event estimation: one shadow ray per point and
/// spot light, `light_samples` by power for the rest.
///
/// Source: Shirley, Wang, Zimmerman 1996, doi:10.1145/226150.226151, by
/// `ray_tracing::LightSampler`; or area lights by `SoftDirectLight`.
AtlasLight light_atlas(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
                       const AtlasLightSettings& settings);

}  // namespace renderers::ray_bundles
