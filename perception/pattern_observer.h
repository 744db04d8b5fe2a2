#pragma once

#include <string>

#include "perception/base/errors.h"
#include "perception/stimuli.h"

namespace perception {

/// Predicts the threshold of any pattern on a plain field from a contrast sensitivity function: the
/// pattern's contrast is filtered by the CSF, weighted by an aperture around the fovea, and pooled
/// by a Minkowski sum. There is no masking.
struct PatternObserver {
  std::string csf = "castle-achromatic";  ///< a name of `csf_list`, achromatic
  /// Exponent of the sum over space, >= 1; about 2.5 in the paper (recalled).
  double pooling_exponent = 2.5;
  /// Standard deviation of the Gaussian aperture, > 0; about 0.6 degrees (recalled).
  double aperture_deg = 0.6;
};

/// @throws base::InputError naming the first setting out of range
void check(const PatternObserver& observer, const base::Place& place = {});

/// Contrast at which the pattern is just seen.
///
/// Response r = (sum |w (c * csf)|^beta a)^(1/beta), a being a pixel's area in deg^2, in units of
/// the response to a Gabor patch of 4 cpd and sigma 0.5 degrees, which is thereby seen at 1 / CSF.
/// @param mean_cd_m2, pixels_per_degree  > 0 @return > 0; infinite if nothing is left to see
/// @throws base::InputError as `check`
/// Source: Watson, Ahumada 2005, "A standard model for foveal detection of spatial contrast",
///   doi:10.1167/5.9.6 (its structure by the abstract; the formula and both constants recalled).
double pattern_threshold(const Stimulus& stimulus, double mean_cd_m2, double pixels_per_degree,
                         const PatternObserver& observer);

/// 1 / CSF of a Gabor patch's frequency, orientation and area pi sigma_along sigma_across.
/// @param csf  an achromatic name of `csf_list`
double gabor_threshold(const GaborPatch& patch, double mean_cd_m2, const std::string& csf,
                       double eccentricity_deg = 0.0);

}  // namespace perception
