#pragma once

#include <span>
#include <string>
#include <string_view>

#include "perception/base/errors.h"

namespace perception {

/// On which side of the line of sight a stimulus lies; the retina is better on the temporal field.
enum class VisualField { temporal, nasal };

/// What sensitivity depends on beside spatial frequency and luminance.
struct StimulusConditions {
  double area_deg2 = 1.0;         ///< > 0; of a patch: pi sigma^2 of a Gabor, side^2 of a square
  double orientation_deg = 0.0;   ///< of the grating; 0 and 90 alike, 45 is the least sensitive
  double eccentricity_deg = 0.0;  ///< >= 0, from the fovea
  VisualField field = VisualField::temporal;
  double temporal_frequency_hz = 0.0;  ///< >= 0
  double viewing_distance_m = 0.5;     ///< > 0
};

/// What 1.0 means.
enum class CsfNormalization {
  absolute,  ///< 1 / threshold contrast, (Lmax - Lmin) / (Lmax + Lmin), of the paper's observers
  cone,      ///< 1 / threshold cone contrast, along a chromatic direction
  relative   ///< a weight whose scale means nothing: mannos-sakrison peaks near 1, hdr-vdp2 is 20.8
             ///< dB below the thresholds it was fitted to
};

/// Which conditions a model has terms for; it is indifferent to the others.
struct CsfTerms {
  bool luminance = false;
  bool area = false;
  bool orientation = false;
  bool eccentricity = false;
  bool temporal_frequency = false;
  bool viewing_distance = false;
};

/// A contrast sensitivity function.
struct CsfInfo {
  std::string name;
  std::string summary;
  std::string source;
  CsfNormalization normalization = CsfNormalization::absolute;
  CsfTerms terms;
  bool is_recalled = false;  ///< the formula or a constant was not checked against a source
  double (*formula)(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&);
};

/// mannos-sakrison, daly, barten-1989, ..., castle-achromatic, hdr-vdp2, ...
std::span<const CsfInfo> csf_list();
/// @throws base::InputError listing the known names
const CsfInfo& find_csf(std::string_view name, const base::Place& place = {});

/// Sensitivity to a sine grating, in the units of the model's normalization.
///
/// @param frequency_cpd    >= 0, cycles per degree; 0 gives the model's limit
/// @param luminance_cd_m2  >= 0 and finite, of adaptation; 0 gives 0 for models with a luminance
/// term
/// @return >= 0; 0 for an infinite frequency; NaN if any argument is NaN or out of its range
double contrast_sensitivity(const CsfInfo& csf, double frequency_cpd, double luminance_cd_m2,
                            const StimulusConditions& conditions = {});

/// The most visible frequency, and how visible it is.
struct CsfPeak {
  double frequency_cpd = 0.0;
  double sensitivity = 0.0;
};

/// The peak between 1/64 and 64 cycles per degree, the frequency to 1e-6 of itself.
CsfPeak csf_peak(const CsfInfo& csf, double luminance_cd_m2,
                 const StimulusConditions& conditions = {});

}  // namespace perception
