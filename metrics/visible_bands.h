#pragma once

#include <string>
#include <vector>

#include "metrics/metric.h"
#include "perception/threshold_vs_intensity.h"
#include "perception/visual_masking.h"

namespace metrics {

/// How content hides a difference of two images.
enum class VisibilityModel {
  band_matched,  ///< every octave of the difference has the threshold of its own octave
  joint,         ///< one threshold per pixel, perception::MaskingCombination::joint
  separate,      ///< one threshold per pixel, perception::MaskingCombination::separate
  off            ///< as band_matched, without masking
};

struct VisibilitySettings {
  VisibilityModel model = VisibilityModel::band_matched;
  perception::ThresholdCurve curve = perception::ThresholdCurve::ward;
  /// Multiplies TVI, > 0. Of `matched_tvi_scale`, thresholds of gratings are those of the CSF.
  double tvi_scale = 1.0;
  perception::MaskingSettings masking;
};

/// Settings of a CSF and a curve by name. A CSF without a scale of its own gets the peak of `daly`.
/// @param tvi_scale  0: matched_tvi_scale for the models by bands, 1 for the others
/// @param csf_gain   multiplies sensitivity, > 0
/// @throws base::InputError listing the known names
VisibilitySettings visibility_settings(VisibilityModel model, const std::string& csf,
                                       const std::string& curve, double tvi_scale,
                                       double csf_gain = 1.0);

/// The parameters `csf`, `tvi` and `tvi_scale` (0: as above) that metrics of visibility share.
std::vector<base::ParameterSpec> visibility_parameters();

/// The factor k with k TVI(L) = L / S_peak at the luminance L of the CSF: TVI is measured with
/// large spots and far coarser than what gratings need.
double matched_tvi_scale(const VisibilitySettings& settings);

/// Maps of the size of the images, one channel each.
struct VisibilityMaps {
  Image spot_cd_m2;    ///< threshold of a large spot: max(tvi_scale, 1) TVI(L_a)
  Image step_jnd;      ///< |difference| / (tvi_scale TVI(L_a))
  Image unmasked_jnd;  ///< the same with CSF
  Image jnd;           ///< the same with CSF and masking
};

/// The difference of two images in just noticeable differences.
///
/// By bands (ours, from Ramasubramanian's factors and Daly's mutual masking): the difference D is
/// split into octaves D_b that add up to it, and
///     JND = |sum_b D_b / (F_csf,b F_mask,b)| / (k TVI(L_a)),
/// F_csf,b = S_peak / S(f_b), F_mask,b = T_e(min over the images of C_b x S(f_b)), at most
/// masking.largest_elevation, C_b averaged over half a period, so that a mask hides at its zeros,
/// too. What is coarser than the coarsest octave is a large spot: F = max(1 / k, 1), the published
/// TVI. S and F are taken at 100 cd/m2; luminance acts through TVI alone.
///
/// A grating at `daly`'s own threshold, 1 to 12 cpd, measures 0.7 to 1.5 JND at 100 cd/m2, where
/// the octaves' overlap shows; 0.6 to 0.9 at 10; 0.3 to 0.8 at 1: Ward's TVI is laxer there.
/// @param reference, test  one channel, cd/m2, finite and >= 0, of one size
VisibilityMaps visibility_maps(const Image& reference, const Image& test, double pixels_per_degree,
                               const VisibilitySettings& settings);

/// Luminance of light in cd/m2 (weights of ITU-R BT.709), negative values as 0.
Image luminance_of(const Image& light);

}  // namespace metrics
