#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "perception/image.h"
#include "perception/threshold_vs_intensity.h"
#include "perception/viewing_conditions.h"
#include "perception/visual_masking.h"

namespace perception {

/// The least visible change of every pixel: dL_T = TVI(L_a) x F.
struct ThresholdSettings {
  ThresholdCurve curve = ThresholdCurve::ward;
  double threshold_scale = 1.0;  ///< > 0, multiplies TVI: the Ward curve is coarse
  MaskingSettings masking;
  bool keeps_bands = false;            ///< also return the elevation of every band
  std::vector<MaskingTarget> targets;  ///< also return the elevation for each of these
};

/// @throws base::InputError naming the first setting out of range
void check(const ThresholdSettings& settings);

/// A masking profile with its scale of TVI: a fifth for "rama99_calibrated", which makes thresholds
/// of spots those of patterns; 1 for the others. @throws base::InputError listing the known names
ThresholdSettings threshold_profile(std::string_view name, const base::Place& place = {});

/// Elevation F_csf F_mask of one frequency channel, >= 1.
struct BandElevation {
  double frequency_cpd = 0.0;
  std::optional<double> orientation_deg;
  Image elevation;
};

/// Elevation for an artefact of known frequency, 1 to masking.largest_elevation.
struct ArtefactElevation {
  MaskingTarget target;
  double unmasked = 1.0;  ///< by its frequency alone, on a uniform image
  Image elevation;
};

/// Maps of the size of the image, one channel each.
struct ThresholdMap {
  Image adaptation_cd_m2;                  ///< L_a, what the eye adapts to around the pixel
  Image tvi_cd_m2;                         ///< threshold_scale x TVI(L_a)
  std::vector<BandElevation> bands;        ///< finest first; empty unless asked for
  std::vector<ArtefactElevation> targets;  ///< in the order asked for
  Image elevation;                         ///< F, 1 to masking.largest_elevation
  Image threshold_cd_m2;                   ///< tvi x F
  NonFinite non_finite;             ///< NaN in every map; neighbours see their surround instead
  std::size_t negative_pixels = 0;  ///< counted as dark, e.g. colours outside the gamut
};

/// Thresholds for changes to an image, by its own luminance, frequencies and contrasts.
///
/// A pure function with the same result for any number of threads. A uniform image has F = 1 and
/// dL_T = TVI everywhere; F does not change when all luminances are scaled.
/// @param light  encoding luminance_cd_m2: one channel, or R, G, B with the luminance of Rec.709
/// @throws base::InputError for another encoding, channels that are no colour, or bad settings
/// Source: Ramasubramanian et al. 1999, doi:10.1145/311535.311543; see visual_masking.h.
ThresholdMap threshold_map(const Image& light, const ViewingConditions& viewing,
                           const ThresholdSettings& settings = {});

/// Thresholds for the difference of two images: adaptation to their mean, contrasts joined by
/// settings.masking.pair. @throws base::InputError as above, or if the sizes differ
ThresholdMap threshold_map(const Image& light_a, const Image& light_b,
                           const ViewingConditions& viewing,
                           const ThresholdSettings& settings = {});

/// What a difference of exactly one threshold means.
enum class OneThreshold {
  half_seen,  ///< seen half the time: P = 1 - exp(-ln 2 t^3.5), as HDR-VDP
  daly        ///< P = 1 - exp(-t^3.5), 0.632 (Daly 1993)
};

/// Probability of seeing a difference, from psychometric functions of slope 3.5.
/// @param thresholds  |difference| / threshold; the sign plays no part, NaN gives NaN
double detection_probability(double thresholds, OneThreshold meaning = OneThreshold::half_seen);

/// The same model in the form a renderer asks: computed once from a preview, then queried at any
/// place of the picture, for a changed adaptation or for an artefact of known frequency.
///
/// Coordinates are pixels with centres at whole numbers, 0 at the top left; between centres values
/// are bilinear, beyond the outermost centres the border's. Queries may come from many threads.
class ThresholdField {
 public:
  /// What is kept for later questions.
  enum class Keeps {
    elevation,  ///< 8 bytes per pixel
    bands       ///< 8 + 4 per channel: needed for targets
  };

  /// @param preview  finite light; as for threshold_map
  /// @throws base::InputError as threshold_map; also for non-finite pixels, naming the first
  ThresholdField(const Image& preview, const ViewingConditions& viewing,
                 const ThresholdSettings& settings = {}, Keeps keeps = Keeps::elevation);
  ~ThresholdField();
  ThresholdField(ThresholdField&&) noexcept;
  ThresholdField& operator=(ThresholdField&&) noexcept;

  int width_px() const;
  int height_px() const;
  double adaptation_cd_m2(double x_px, double y_px) const;
  double elevation(double x_px, double y_px) const;
  /// TVI of the preview's adaptation x elevation.
  double threshold_cd_m2(double x_px, double y_px) const;
  /// TVI of another adaptation x the preview's elevation: for an estimate that brightens.
  double threshold_cd_m2(double x_px, double y_px, double adaptation_cd_m2) const;
  /// TVI of the preview's adaptation x the elevation for a target, at the nearest pixel.
  /// @throws base::InputError if bands were not kept, or for an orientation without oriented bands
  double threshold_cd_m2(double x_px, double y_px, const MaskingTarget& target) const;
  /// TVI of the picture's mean luminance without elevation: for what no pixel shows.
  double mean_threshold_cd_m2() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace perception
