#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "perception/color_management.h"
#include "perception/image.h"
#include "perception/threshold_vs_intensity.h"
#include "perception/viewing_conditions.h"

namespace perception {

/// Range of light that a display sends to the eye, reflected room light included.
struct DisplayRange {
  double black_cd_m2 = 0.0;
  double peak_cd_m2 = 0.0;
};
DisplayRange display_range(const ViewingConditions& viewing);

/// A global tone curve from world to display luminance: monotone, computed once, then the same for
/// every picture that is to be compared. Straight pieces in log-log; the ends' values beyond.
class ToneCurve {
 public:
  /// A point of the curve, both > 0, cd/m2.
  struct Point {
    double world_cd_m2;
    double display_cd_m2;
  };
  /// @param points  rising in world luminance, not falling in display luminance; at least one
  /// @throws base::InputError if not
  explicit ToneCurve(std::vector<Point> points);

  /// Display luminance; NaN gives NaN, 0 and below the darkest value.
  double operator()(double world_cd_m2) const;
  /// Derivative of display by world luminance: what a small error becomes; 0 beyond the ends.
  double slope(double world_cd_m2) const;
  const std::vector<Point>& points() const { return points_; }

 private:
  std::size_t piece_at(double log_world) const;

  std::vector<Point> points_;
  std::vector<double> log_world_;
  std::vector<double> log_display_;
};

/// Display = scale x world within the display's range: for tests and comparisons.
/// @param scale  > 0
ToneCurve linear_tone_curve(const DisplayRange& range, double scale);

/// Settings of the histogram adjustment.
struct HistogramSettings {
  int bins = 100;
  bool limits_contrast =
      true;  ///< no more contrast than an eye at the scene would see; else linear
  ThresholdCurve curve = ThresholdCurve::ward;
  double fovea_deg = 1.0;  ///< side of the samples' squares
};

/// Histogram adjustment of Ward Larson et al. 1997: equalizes the histogram of log luminance of
/// foveal samples under a ceiling, so that no contrast is shown that was not visible in the scene.
/// A scene whose range fits the display is scaled by one factor; one whose occupied luminances
/// cannot fill it so is compressed evenly in log luminance.
///
/// @param light  world light, encoding luminance_cd_m2, Y or R, G, B; non-finite pixels and those
///        below 1e-4 cd/m2 do not count
/// @throws base::InputError for another encoding, fewer than 2 bins, or no pixel that counts
ToneCurve histogram_adjustment(const Image& light, const ViewingConditions& viewing,
                               const HistogramSettings& settings = {});

/// Settings of the photographic operator.
struct ReinhardSettings {
  double key = 0.18;         ///< a: the scene's log average becomes this share of the display
  double white_cd_m2 = 0.0;  ///< least world luminance shown as the display's peak; 0: the largest
};

/// The photographic tone reproduction of Reinhard et al. 2002, global operator.
/// @param light  as above @throws base::InputError as above, or for a setting out of range
ToneCurve photographic_curve(const Image& light, const ViewingConditions& viewing,
                             const ReinhardSettings& settings = {});

/// World light to display light: every pixel's colour scaled by display / world luminance, the
/// reflected room light part of it. Non-finite pixels stay.
/// @param light  encoding luminance_cd_m2, Y or R, G, B
/// @throws base::InputError for another encoding
Image tone_mapped(const Image& light, const ToneCurve& curve);

/// Scene-linear radiance as the light of the ACES output transform that suits the display: "ACES
/// SDR" for srgb; for pq the HDR transform whose peak, 1000, 2000 or 4000 cd/m2, is the largest not
/// above the display's, or 1000. exposure_ev is applied before.
/// @throws base::InputError for other display transfers, other encodings, or if the configuration
///         lacks the view
Image aces_tone_mapped(const Image& scene_linear, const ColorManagement& colors,
                       const ViewingConditions& viewing);

}  // namespace perception
