#pragma once

#include "renderers/area_shadows/discontinuity_pyramid.h"
#include "renderers/area_shadows/fragments.h"
#include "renderers/area_shadows/shadow_tracer.h"

namespace renderers::area_shadows {

struct NeighbourSettings {
  int coarsest_level = 5;
  int bit_threshold = 1;          ///< so many differing bits of all points refine
  SurfaceTolerance same_surface;  ///< which neighbours are compared
};

/// Splits the picture into fragments by what neighbours see: all points of the lights are tested at
/// the middle of a fragment and of the eight blocks of its size around it; if the bits of one
/// differ from the fragment's own, it is split into four. Middles are traced once, whoever asks.
///
/// Source: Nichols, Penmatsa, Wyman 2010, "Interactive, Multiresolution Image-Space Rendering for
/// Dynamic Area Lighting", doi:10.1111/j.1467-8659.2010.01723.x, as Koa and Johan 2016,
/// doi:10.1145/2949035.2949043, Sec. 3.1.2 describe it; its full text was not at hand. Differs from
/// that description: neighbours on other surfaces are not asked.
FragmentSet refine_by_neighbours(ShadowTracer& tracer, const DiscontinuityPyramid& discontinuities,
                                 const NeighbourSettings& settings);

}  // namespace renderers::area_shadows
