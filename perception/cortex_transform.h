#pragma once

#include <complex>
#include <vector>

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
  ~CortexTransform();
  CortexTransform(const CortexTransform&) = delete;
  CortexTransform& operator=(const CortexTransform&) = delete;

  /// @param level        1 (finest) to kLevels
  /// @param orientation  0 to kOrientations - 1
  Image channel(int level, int orientation) const;
  Image baseband() const;

  /// Frequency of a level's unit response, cycles per pixel, at most 0.5.
  static double centre_cycles_px(int level);
  /// Direction of change the fan is centred on: 0 degrees are vertical bars, 90 horizontal ones.
  static double centre_deg(int orientation);

  /// Dom of a level at a radial frequency (cycles per pixel): mesa(k - 1) - mesa(k).
  static double dom(int level, double cycles_px);
  static double base(double cycles_px);
  /// Fan of an orientation at an angle (degrees).
  static double fan(int orientation, double angle_deg);

 private:
  /// A place of the spectrum.
  struct Polar {
    float cycles_px;
    float angle_deg;
  };
  template <class Response>
  Image filtered(const Response& response) const;

  int width_px_;
  int height_px_;
  int padded_width_px_;
  int padded_height_px_;
  std::vector<std::complex<float>> spectrum_;  ///< padded, rows of full width
  std::vector<Polar> polar_;                   ///< of every value of the spectrum
};

/// Smallest angle between two orientations, degrees, 0 to 90.
double orientation_difference_deg(double a_deg, double b_deg);

}  // namespace perception
