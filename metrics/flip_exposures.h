#pragma once

#include <optional>

#include "metrics/flip_ldr.h"
#include "metrics/metric.h"

/// The exposures and tone curves under which FLIP compares pictures of high dynamic range.
///
/// Source: Andersson, Nilsson, Shirley, Akenine-Moller 2021, Visualizing Errors in Rendered High
/// Dynamic Range Images, Eurographics 2021 Short Papers, doi:10.2312/egs.20211015.
/// Section numbers are recalled from memory; the formulas were checked against the authors'
/// program.
namespace metrics {

enum class ToneMapper { aces, hable, reinhard };

/// A rational tone curve (k[0] x^2 + k[1] x + k[2]) / (k[3] x^2 + k[4] x + k[5]) of x >= 0.
struct ToneCurve {
  double k[6];
};

/// aces: Narkowicz's fit with inputs times 0.6; hable: Hable's filmic curve, scaled to its white;
/// reinhard: x / (1 + x) (applied to the luminance). Coefficients as in the authors' program.
ToneCurve tone_curve(ToneMapper mapper);

/// The x that the curve maps to a display value. @param display_value  in (0, 1)
double inverse_tone_curve(const ToneCurve& curve, double display_value);

/// Why the automatic exposures do not rest on the reference's median luminance.
enum class ExposureFallback {
  none = 0,
  positive_reference_median = 1,  ///< that median is 0: the median of its positive luminances
  positive_test_median = 2,       ///< the reference is black: maximum and median of the test
  black = 3                       ///< both are black: exposure 0
};

/// Exposures in stops, equally spaced from start to stop.
struct ExposureRange {
  double start_ev = 0.0;
  double stop_ev = 0.0;
  int count = 2;
  ExposureFallback fallback = ExposureFallback::none;

  double exposure_ev(int index) const;
};

/// What the user fixed; the rest is automatic.
struct ExposureChoice {
  std::optional<double> start_ev;
  std::optional<double> stop_ev;
  int count = 0;  ///< 0: automatic
};

/// The automatic exposures of one reference: start brings its largest, stop its median luminance
/// (of its positive ones if that is 0) to a display value of 0.85.
struct ReferenceExposures {
  double start_ev = 0.0;
  double stop_ev = 0.0;
};

/// @param reference  linear R, G, B
/// @param mask  as in choose_exposures
/// @return nothing for a black reference, which says nothing of exposures
std::optional<ReferenceExposures> reference_exposures(const Image& reference, ToneMapper mapper,
                                                      const Image* mask = nullptr);

/// Automatic exposures bring the reference's largest and median luminance to a display value of
/// 0.85; max(2, ceil(stop - start)) of them.
/// @param reference, test  linear R, G, B
/// @param mask  one channel, of the same size: pixels of 0 have no say in the exposures, at least
///              one is not 0; null: all pixels have
/// @throws base::InputError if start is above stop
ExposureRange choose_exposures(const Image& reference, const Image& test, ToneMapper mapper,
                               const ExposureChoice& choice, const Image* mask = nullptr);

/// A row of linear R, G, B through exposure and tone curve, bounded to [0, 1].
/// @param rgb  interleaved, finite; values below 0 count as 0
void tone_map_row(ToneMapper mapper, double exposure_ev, const float* rgb, int width_px,
                  const RowOfThree& out);

}  // namespace metrics
