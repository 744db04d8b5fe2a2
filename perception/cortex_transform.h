#pragma once

#include "perception/fourier_filter.h"
#include "perception/image.h"

namespace perception {

/// The cortex transform of Daly's Visible Differences Predictor: octave bands ("doms") times
/// orientation fans, and one baseband, by their Fourier spectra. All channels sum to the image, but
/// for frequencies above 0.667 cycles per pixel, in the corners of the spectrum.
///
/// The image is continued by mirroring, so that opposite borders do not meet.
class CortexTransform {
 public:
  static constexpr int kLevels = 5;
  static constexpr int kOrientations = 6;

  /// @param image  one channel, finite
  explicit CortexTransform(const Image& image);

  /// @param level        1 (finest) to kLevels
  /// @param orientation  0 to kOrientations - 1
  Image channel(int level, int orientation) const;
  Image baseband() const;

  /// Frequency of a level's unit response, cycles per pixel, at most 0.5.
  static double centre_cycles_px(int level);
  /// Direction of change the fan is centred on: 0 degrees are vertical bars, 90 horizontal ones.
  static double centre_deg(int orientation);

  /// 1 below the half-amplitude frequency 2^-k cycles per pixel, 0 above. @param k  0 to kLevels
  static double mesa(int k, double cycles_px);
  /// Dom of a level at a radial frequency (cycles per pixel): mesa(k - 1) - mesa(k).
  static double dom(int level, double cycles_px);
  static double base(double cycles_px);
  /// Fan of an orientation at an angle (degrees).
  static double fan(int orientation, double angle_deg);

  /// The same as filters: dom x fan, base, and mesa, in single precision.
  static FrequencyResponse channel_response(int level, int orientation);
  static FrequencyResponse base_response();
  static FrequencyResponse mesa_response(int k);

 private:
  Image filtered(const FrequencyResponse& response) const;

  int width_px_;
  int height_px_;
  FourierFilter filter_;
  FourierFilter::Spectrum spectrum_;
};

/// Smallest angle between two orientations, degrees, 0 to 90.
double orientation_difference_deg(double a_deg, double b_deg);

}  // namespace perception
