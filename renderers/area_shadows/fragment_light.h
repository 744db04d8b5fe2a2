#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/area_shadows/fragments.h"
#include "renderers/area_shadows/shadow_tracer.h"

namespace renderers::area_shadows {

/// How visibility bits of a coarse fragment become irradiance.
enum class IrradianceEstimate {
  sum,    ///< sum of power x factor over visible points, at each quadrant
  ratio,  ///< by all points as if unoccluded, times the share of `sum` that is not in shadow
  pixel   ///< by all points at the first of the fragment's pixels
};

/// Whether no light can shine on any of the fragment's pixels.
bool is_dark(const Fragment& fragment, const FragmentSet& set, const ShadowTracer& tracer);

struct FragmentLightSettings {
  IrradianceEstimate estimate = IrradianceEstimate::ratio;
  bool has_rotated_points = false;  ///< each quadrant tested its own points
  bool has_extra_samples = true;
  int extra_from_level = 3;  ///< least level of a fragment with extra samples
};

/// Irradiance at one place of the picture.
struct LightSample {
  glm::vec2 position_px{0.0F};
  glm::vec3 irradiance{0.0F};  ///< W/m2
  glm::vec3 open{0.0F};        ///< W/m2, what it would be if nothing stood between
  std::int32_t pixel = kNone;  ///< whose surface it belongs to
};

/// Irradiance of final fragments, and of the samples added to coarse ones.
struct FragmentLight {
  std::vector<LightSample> centres;  ///< per fragment; of those that are not final undefined
  std::vector<LightSample> extras;
  std::vector<std::uint32_t> first_extra;  ///< per fragment + 1: its first in `extras`
  std::uint64_t gather_rays = 0;           ///< for what bits of fragments were missing
  std::uint64_t coarse_gather_rays = 0;    ///< of these, for fragments larger than a pixel
  std::uint64_t extra_rays = 0;

  std::span<const LightSample> extras_of(std::size_t fragment) const {
    return std::span(extras).subspan(first_extra[fragment],
                                     first_extra[fragment + 1] - first_extra[fragment]);
  }
};

/// Lights final fragments: a pixel by all points, rays for those that have not been traced; a
/// coarser one by the bits of its quadrants and no further ray; a culled one with 0. From
/// `extra_from_level` on each gets three pixels as samples of their own: its top left one, the
/// one in the middle of its top row and the one in the middle of its left column.
///
/// Source: Koa and Johan 2016, doi:10.1145/2949035.2949043, Sec. 3.1.2 (bits are used again) and
/// 3.1.4 (additional samples above level 2). Differs from the paper: culled fragments have no
/// extra samples, they are known to be dark; `ratio` is ours.
FragmentLight light_fragments(ShadowTracer& tracer, const FragmentSet& set,
                              const FragmentLightSettings& settings);

/// The pixels of a fragment's extra samples that lie in the image.
std::vector<std::int32_t> extra_pixels(const Fragment& fragment, const FragmentSet& set);

}  // namespace renderers::area_shadows
