#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "perception/base/errors.h"
#include "perception/contrast_sensitivity.h"
#include "perception/image.h"
#include "perception/tabulated_curve.h"

namespace perception {

/// Threshold elevation against masking contrast, T_e(m) = (1 + (k1 (k2 m)^s)^b)^(1/b).
struct MaskingCurve {
  double k1 = 0.0;
  double k2 = 0.0;
  double slope = 0.7;  ///< s: 0.65 for learnt, 1.0 for unlearnt noise
  double knee = 4.0;   ///< b: 2 to 4, how sharply masking sets in
};

/// Daly 1993 with W = 6, Q = 0.7: k1 = W^(1 - 1/(1 - Q)), k2 = W^(1/(1 - Q)).
MaskingCurve daly_masking_curve(double slope = 0.7, double knee = 4.0);
/// Yee 2004, the same rounded: k1 = 0.0153, k2 = 392.498.
MaskingCurve yee_masking_curve();

/// @param normalized_contrast  contrast x sensitivity, in thresholds; NaN gives NaN, below 0 as 0
/// @return >= 1; the curve has no facilitation: a weak mask never makes a target easier to see
double threshold_elevation(double normalized_contrast, const MaskingCurve& curve);

/// Which filters split the image into frequency channels.
enum class MaskingBands {
  octaves,           ///< undecimated Laplacian bands, one octave each
  oriented_octaves,  ///< Daly's cortex transform: five octaves times six orientations
  repeated_kernel    ///< Yee's: the labels are octaves, the filters are not
};

/// How frequency and contrast elevate together, over the bands i of contrast C_i.
enum class MaskingCombination {
  joint,    ///< sum C_i F_csf,i F_mask,i / sum C_i
  separate  ///< (sum C_i F_csf,i / sum C_i) (sum C_i F_mask,i / sum C_i)
};

/// Which of two images' contrasts mask their difference.
enum class PairContrast {
  minimum,  ///< mutual masking (Daly 1993): noise in one image alone does not hide itself
  maximum   ///< Yee 2004
};

/// Everything the spatial part of the threshold model can be told.
struct MaskingSettings {
  std::string csf = "barten-1989";     ///< a name of `csf_list`
  double csf_gain = 1.0;               ///< multiplies sensitivity where contrast masks, not F_csf
  double csf_luminance_cd_m2 = 100.0;  ///< at which the spatial part is taken
  MaskingCurve curve = daly_masking_curve();
  MaskingBands bands = MaskingBands::octaves;
  int band_count = 6;                 ///< at most; oriented: at most 5
  double lowest_frequency_cpd = 0.2;  ///< coarser bands are left out
  MaskingCombination combination = MaskingCombination::joint;
  PairContrast pair = PairContrast::minimum;
  double largest_elevation = 10.0;  ///< >= 1
  /// Contrast of content that hides nothing, added to the mean over the bands: F = (sum C_i F_i +
  /// C_n) / (sum C_i + C_n), so that F goes to 1 with contrast. 0: the least residual noise counts
  /// as a texture would.
  double neutral_contrast = 0.0;
  double adaptation_sigma_deg = 0.5;  ///< of the Gaussian that averages to adaptation
  /// The mask term's sensitivity at each pixel's adaptation, and adaptation from the level of the
  /// stack that Yee takes for one degree, instead of the two settings above.
  bool is_yee_adaptation = false;
};

/// Named settings: "rama99", the model of Ramasubramanian, Pattanaik and Greenberg 1999 as far as
/// it is known; "rama99_calibrated", the same with clamp and neutral contrast that bring it near
/// people's thresholds (suites/catalog/psychophysics/calibration.yaml); "yee_compat", what Yee's
/// perceptualdiff computes.
/// @throws base::InputError listing the known names
MaskingSettings masking_profile(std::string_view name, const base::Place& place = {});
std::vector<std::string> masking_profile_names();

/// @throws base::InputError naming the first setting out of range
void check(const MaskingSettings& settings);

/// Local contrast of one channel, >= 0.
struct BandContrast {
  double frequency_cpd = 0.0;             ///< where the channel's response peaks
  std::optional<double> orientation_deg;  ///< of the change: 0 = vertical bars; none = all
  Image contrast;
};

/// What an image does to the visibility of something else in it.
struct LocalContrasts {
  Image adaptation_cd_m2;
  std::vector<BandContrast> bands;  ///< finest first
};

/// |band| / mean of the surround two octaves coarser, and the luminance the eye adapts to.
/// @param luminance  one channel, cd/m2, finite and >= 0
LocalContrasts local_contrasts(const Image& luminance, double pixels_per_degree,
                               const MaskingSettings& settings);

/// Contrasts that mask the difference of two images, by settings.pair; adaptation is their mean.
LocalContrasts joined(LocalContrasts a, const LocalContrasts& b, PairContrast pair);

/// max over f of CSF(f) / CSF(frequency): how much less visible a frequency is than the best one;
/// at most 1e6, also where the CSF is 0.
double csf_elevation(const MaskingSettings& settings, double frequency_cpd);

/// Elevation of the threshold by the image's own content, 1 to settings.largest_elevation; 1 where
/// there is no contrast.
Image elevation_map(const LocalContrasts& contrasts, const MaskingSettings& settings);

/// Elevation F_csf,i F_mask,i of a single channel, >= 1.
Image band_elevation_map(const LocalContrasts& contrasts, std::size_t band,
                         const MaskingSettings& settings);

/// Something to be hidden, of known frequency.
struct MaskingTarget {
  double frequency_cpd = 0.0;             ///< > 0
  std::optional<double> orientation_deg;  ///< of the change; needs oriented bands
};

/// Elevation for targets of known frequency, at single pixels: what a renderer asks when it knows
/// the artefact it is about to make.
///
/// F_csf(frequency) times the mean of F_mask over the channels, weighted by their contrast and by
/// nearness: 1 at the target's frequency, falling to 0 one octave away; times, if the target has an
/// orientation, half a cosine falling to 0 at 30 degrees. Clamped as above.
///
/// Content of other frequencies does not hide the target: a soft shadow, for one, does not hide
/// its own bands. Where no channel is near, or none has contrast, F_csf alone counts.
///
/// Differs from the papers: the restriction to matching channels is ours.
class TargetElevation {
 public:
  /// @param contrasts  must outlive this object
  TargetElevation(const LocalContrasts& contrasts, const MaskingSettings& settings);
  /// @param pixel  index, row by row
  /// @throws base::InputError if the target's frequency is not above 0, or if it has an orientation
  ///         and the channels have none
  double at(std::size_t pixel, const MaskingTarget& target) const;
  /// The same of all pixels, to the bit. @throws as above
  Image map(const MaskingTarget& target) const;
  /// The same where nothing masks: F_csf of the target's frequency, clamped. @throws as above
  double unmasked(const MaskingTarget& target) const;

 private:
  double csf_elevation_of(const MaskingTarget& target) const;
  template <typename WeightOf>
  double elevation(std::size_t pixel, double csf_elevation, const WeightOf& weight_of) const;

  const LocalContrasts& contrasts_;
  double largest_elevation_;
  TabulatedCurve csf_elevation_;  ///< over frequency
  TabulatedCurve mask_;
  std::vector<float> sensitivities_;  ///< of each channel
};

}  // namespace perception
