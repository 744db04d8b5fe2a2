#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/area_shadows/fragment_light.h"
#include "renderers/area_shadows/fragments.h"

namespace renderers::area_shadows {

/// Irradiance per pixel, W/m2; 0 where no fragment is.
using PixelIrradiance = std::vector<glm::vec3>;

/// Each pixel has the value of its fragment.
PixelIrradiance upsample_nearest(const FragmentSet& set, const FragmentLight& light);

struct MultiPass {
  PixelIrradiance irradiance;
  std::int64_t bytes = 0;  ///< of the pictures of all levels
};

/// Level by level from the coarsest on: a fragment's value where one of the level is final, else
/// where a coarser one lies the bilinear mean of the four nearest values of the next coarser level,
/// as far as they are known. Fine fragments never reach coarse ones.
///
/// Source: Nichols, Shopf, Wyman 2009, "Hierarchical Image-Space Radiosity for Interactive Global
/// Illumination", doi:10.1111/j.1467-8659.2009.01519.x (recalled), as Koa and Johan 2016,
/// doi:10.1145/2949035.2949043, Sec. 3.1.5 describe it.
MultiPass upsample_multi_pass(const FragmentSet& set, const FragmentLight& light,
                              int coarsest_level);

/// Replaces irradiance by its share of the unoccluded one, per channel: 0 where there is none.
void take_visible_share(FragmentLight& light);

/// Makes irradiance of upsampled shares: those times the pixel's own unoccluded irradiance; pixels
/// that are fragments keep the irradiance they were given. Shading by lights and normals is then
/// exact at every pixel, and only shadows are interpolated. Ours.
/// @param light  with irradiance, as it was before `take_visible_share`
void restore_irradiance(const ShadowTracer& tracer, const FragmentSet& set,
                        const FragmentLight& light, PixelIrradiance& shares);

}  // namespace renderers::area_shadows
