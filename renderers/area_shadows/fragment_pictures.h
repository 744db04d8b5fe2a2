#pragma once

#include <string>
#include <utility>
#include <vector>

#include "perception/image_file.h"
#include "renderers/area_shadows/fragment_light.h"
#include "renderers/area_shadows/fragments.h"
#include "renderers/area_shadows/shadow_tracer.h"
#include "renderers/contract/renderer.h"

namespace renderers::area_shadows {

/// What a picture's fragments look like, one value per pixel, -1 where there is none:
/// `level` (of the fragment), `lit_points` (bits set of those known at the pixel), `pieces` (into
/// how many a visibility test cut the finest block that it cut here, else 0), `extra_samples` (1 at
/// the pixels that are one), `culled` (1 in culled fragments), and in three channels
/// `fragment_irradiance` (before upsampling).
std::vector<perception::NamedImage> fragment_pictures(const FragmentSet& set,
                                                      const FragmentLight& light,
                                                      const ShadowTracer& tracer);

/// `fragments` (final ones and extra samples), `final_fragments`, `extra_samples`,
/// `culled_fragments`, `dark_fragments` (seen to see no point, pixels left out),
/// `tested_fragments`, `rounds`, `reopened_fragments`, `visibility_rays`, `test_rays` (of these,
/// those for `tested_fragments`), `gather_rays`,
/// `coarse_gather_rays` (for fragments larger than a pixel), `extra_rays`, `coarse_fragments`
/// (final ones above level 2 that are not culled), `edged_fragments` (those of them with three or
/// more extra samples along their four edges, their neighbours' included), `pieces_4`, `pieces_10`,
/// `pieces_13`, `pieces_16` (splits by visibility of blocks whole in the image), `bit_bytes`, and
/// the series `level_fragments` (final ones, pixels first).
std::vector<std::pair<std::string, CounterValue>> fragment_counters(const FragmentSet& set,
                                                                    const FragmentLight& light,
                                                                    const ShadowTracer& tracer);

}  // namespace renderers::area_shadows
