#pragma once

#include <complex>
#include <functional>
#include <span>
#include <vector>

#include "perception/image.h"

namespace perception {

/// Gains of a filter for one column of a spectrum: of the frequencies (fx, fy[i]).
///
/// The gain of (-fx, -fy) is that of (fx, fy), so that a real image stays real.
/// @param fx     cycles per pixel, 0 to 0.5
/// @param fy     cycles per pixel, -0.5 to 0.5
/// @param gains  to be filled, as many as fy
/// @return false if all of them are 0; then they need not be filled
using FrequencyResponse =
    std::function<bool(float fx, std::span<const float> fy, std::span<float> gains)>;

/// Filters for one-channel images of one size, by their Fourier spectra, in parallel.
///
/// The image is continued by mirroring at every border; half-way round the mirrored sides fade into
/// each other, so that opposite borders do not meet and the continuation has no step.
class FourierFilter {
 public:
  /// Half the spectrum of an image: columns of rising fx >= 0, about 4 bytes per pixel.
  using Spectrum = std::vector<std::complex<float>>;

  /// @param width_px, height_px  of the images, at least 1
  FourierFilter(int width_px, int height_px);

  /// The same response, evaluated here once for all: for one that is slow and used repeatedly.
  /// Holds about 2 bytes per pixel; good for images of this size only.
  FrequencyResponse tabulated(const FrequencyResponse& response) const;

  /// @param response  what the spectrum is multiplied by; none: 1
  Spectrum spectrum_of(const Image& image, const FrequencyResponse& response = {}) const;
  /// The image of a filtered spectrum. @param out  one channel, of the right size, overwritten
  void filter(const Spectrum& spectrum, const FrequencyResponse& response, Image& out) const;
  /// Filters an image in place, without holding its spectrum.
  void filter(Image& image, const FrequencyResponse& response) const;

 private:
  class Work;

  /// What stands beyond the last pixel of a row or column: a mixture of two of its pixels.
  struct Continuation {
    int from_end;
    int from_begin;
    float share_of_begin;
  };
  static std::vector<Continuation> continuations(int size_px, int padded_px);

  std::size_t column_count() const { return static_cast<std::size_t>(padded_width_px_) / 2 + 1; }
  std::size_t column_length() const { return fy_.size(); }

  int width_px_;
  int height_px_;
  int padded_width_px_;
  std::vector<Continuation> beyond_rows_, beyond_columns_;
  std::vector<float> fy_;
};

}  // namespace perception
