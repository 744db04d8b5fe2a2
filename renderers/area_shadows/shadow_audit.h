#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "renderers/area_shadows/fragment_upsampling.h"
#include "renderers/area_shadows/rbf_upsampling.h"
#include "renderers/contract/renderer.h"

namespace renderers::area_shadows {

/// What a picture made of fragments is held against its own points at every pixel for.
struct AuditedPicture {
  const FragmentSet& set;
  const PixelIrradiance& irradiance;    ///< W/m2, one per pixel
  const std::vector<RbfPlace>& places;  ///< one per pixel; all `copied` if not upsampled by RBFs
  int coarsest_level = 5;
};

/// Lights every pixel by all points and counts what the fragments did not see. Rays are cast for
/// bits that are missing; the tracer keeps them.
///
/// Pixels that count are those with a surface that light would reach if nothing stood between.
///
/// `audit_rays`; `audit_crossed_blocks`, blocks of the coarsest size, those cut off by the image's
/// right and lower border included, whose pixels that count have visible shares that differ by more
/// than a tenth; `audit_missed_fragments`, final fragments of level 3 and above that do: borders of
/// shadows nobody split at; `audit_missed_blocks`, blocks with one of these;
/// `audit_culled_lit_pixels`, pixels of culled fragments with light; of the pixels that count
/// `extrapolated_pixels` and `enclosed_pixels`, by RBF upsampling, and `extrapolated_rmse`,
/// `enclosed_rmse`, root mean square errors of their irradiance over the mean irradiance of all
/// that count (0 if there are none).
std::vector<std::pair<std::string, CounterValue>> audit_counters(ShadowTracer& tracer,
                                                                 const AuditedPicture& picture);

}  // namespace renderers::area_shadows
