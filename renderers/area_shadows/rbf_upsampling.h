#pragma once

#include <cstdint>
#include <vector>

#include "renderers/area_shadows/fragment_upsampling.h"
#include "renderers/area_shadows/pixel_surfaces.h"
#include "renderers/area_shadows/rbf_interpolation.h"

namespace renderers::area_shadows {

struct RbfUpsamplingSettings {
  RbfSettings rbf;
  int copied_level = 2;  ///< fragments up to this level give all of their pixels their value
  SurfaceTolerance same_surface;
};

/// Irradiance of all pixels in one pass: each pixel of a coarse fragment is interpolated from the
/// centre and the extra samples of its fragment and of those that touch it, if they are of the same
/// surface. Needs no pictures of levels.
///
/// Source: Koa and Johan 2016, doi:10.1145/2949035.2949043, Sec. 3.1.5. Which samples may be chosen
/// the paper shows in its Fig. 5; that they be of the same surface is ours.
PixelIrradiance upsample_by_rbf(const PixelSurfaces& surfaces, const FragmentSet& set,
                                const FragmentLight& light, const RbfUpsamplingSettings& settings);

/// How a pixel gets its value.
enum class RbfPlace : std::uint8_t {
  copied,       ///< its fragment's, or there is no fragment
  enclosed,     ///< its bases lie around it
  extrapolated  ///< all of them lie on one side of it
};

/// The places of all pixels under the same settings; the fragments' light chooses nothing but
/// which of them are uniform and need no interpolation.
std::vector<RbfPlace> rbf_places(const PixelSurfaces& surfaces, const FragmentSet& set,
                                 const FragmentLight& light, const RbfUpsamplingSettings& settings);

}  // namespace renderers::area_shadows
