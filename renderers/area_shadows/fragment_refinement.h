#pragma once

#include <cstdint>

#include "renderers/area_shadows/discontinuity_pyramid.h"
#include "renderers/area_shadows/fragments.h"
#include "renderers/area_shadows/shadow_tracer.h"

namespace renderers::area_shadows {

/// Which light points a fragment's quadrants test.
enum class TestPoints {
  same,    ///< all the first quarter: bits can be compared, point by point
  rotated  ///< each another quarter: all points are seen once, numbers of bits are compared
};

struct RefinementSettings {
  int coarsest_level = 5;
  TestPoints test_points = TestPoints::same;
  int bit_threshold = 1;   ///< so many differing bits refine
  int bits_per_level = 0;  ///< fewer for each level above 1, but no fewer than 2 by that
  bool has_ring = true;    ///< compare with the quadrants around a fragment, too
  /// Difference of lit points of neighbouring quadrants, above which both are cut again at once,
  /// by the number of points; negative: never.
  float gradient_threshold = 0.25F;
  /// Fragments up to this level are not split for their geometry.
  int free_level = 0;
  /// Compare the points that both face: what lies between is asked for, not the angle of surfaces.
  bool compares_facing = false;
  /// Least level of a fragment whose extra pixels are tested before it is final; negative: none.
  int extra_from_level = 3;
  SurfaceTolerance same_surface;  ///< who is compared in the ring
};

/// Splits the picture into fragments: from blocks of 2^coarsest_level pixels down, those with a
/// geometric discontinuity, then those whose quadrants see different parts of the lights.
///
/// A round works off one list of fragments of a level: geometry and culling (no rays), visibility
/// at the quadrants' pixels, comparison. A culled fragment is final. With the ring, bits are also
/// compared with the eight neighbours of each quadrant where these have been tested, at whatever
/// level, on the same surface; the coarser one of two that differ is split again, later if must be.
/// Pixels that become extra samples of a coarse fragment can be compared with its quadrants, too.
/// Fragments are lists in a fixed order: the set does not depend on the number of threads.
///
/// Source: Koa and Johan 2016, doi:10.1145/2949035.2949043, Sec. 3.1.1 (culling), 3.1.2 (SFVT: four
/// quadrants, 16 rays each, one differing bit), 3.1.3 (GASS: a gradient above 4 cuts both).
/// Differs from the paper: ring and tests of extra pixels are ours. The paper compares neighbours'
/// bits without saying how a number relates to them; under `same` these are differing bits, under
/// `rotated` numbers.
///
/// @param tracer  keeps the bits; its lights' points are four sets of tests
FragmentSet refine_fragments(ShadowTracer& tracer, const DiscontinuityPyramid& discontinuities,
                             const RefinementSettings& settings);

}  // namespace renderers::area_shadows
