#pragma once

#include <nlohmann/json_fwd.hpp>

#include "suites/reference_rendering.h"

namespace suites {

/// Two independent estimates of one image: do they differ by more than their variances explain?
///
/// Per pixel z = |difference of luminance| / its standard deviation; over the image the z of the
/// mean difference, which finds a bias that no single pixel shows. Accepted: at most 2 % of the
/// pixels beyond 3 sigma (0.27 % if all were normal; pixels have heavy tails) and a mean z within
/// 4; both bounds are ours.
///
/// @param a, b  same size, both with variance
/// @return {"ok","pixels","outside_3_sigma","expected_outside","worst_pixel":[x,y],"worst_z",
///   "mean_z","samples":[of a, of b]}
nlohmann::ordered_json z_test(const ReferenceEstimate& a, const ReferenceEstimate& b);

}  // namespace suites
