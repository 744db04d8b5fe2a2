#pragma once

#include <vector>

#include "perception/image.h"

namespace perception {

/// What a kernel reads beyond the border.
enum class Border {
  replicate,   ///< the outermost pixel
  yee_mirror,  ///< as Yee's perceptualdiff: pixel -x before the first, 2 w - x - 1 after the last
};

/// A symmetric kernel of five taps (outer, inner, centre, inner, outer), `spacing_px` apart, with
/// centre = 1 - 2 (outer + inner).
struct FiveTapKernel {
  int spacing_px = 1;
  float outer = 0.05F;
  float inner = 0.25F;

  /// Variance of the kernel along one axis, px^2.
  double variance_px2() const;
};

/// Burt and Adelson's kernel with a = 0.4, (0.05, 0.25, 0.4, 0.25, 0.05), spread to `spacing_px`.
FiveTapKernel burt_adelson_kernel(int spacing_px);

/// Filters a one-channel image along both axes; a uniform image stays bit for bit what it is, and a
/// mirrored image gives the mirrored result (Border::replicate).
/// @param scratch, result  resized as needed, so that they can be used again; neither is `image`
void smooth(const Image& image, const FiveTapKernel& kernel, Border border, Image& scratch,
            Image& result);

/// An image averaged with a Gaussian, one channel: a cascade of spread Burt-Adelson kernels, then
/// one with the variance that is left. Away from the border within 1 % of the Gaussian.
/// @param sigma_px  >= 0
Image gaussian_average(const Image& image, double sigma_px);

/// One step down: filtered by Burt and Adelson's kernel, every second pixel kept; ceil(w / 2) x
/// ceil(h / 2), borders replicated. @param image  one channel
/// Source: Burt, Adelson 1983, doi:10.1109/TCOM.1983.1095851, REDUCE.
Image reduce(const Image& image);
/// One step up to the given size, EXPAND of the same source; 2 w - 1 or 2 w px wide, likewise high.
Image expand(const Image& image, int width_px, int height_px);

/// Differences of successive levels, finest first, and the coarsest level.
struct LaplacianPyramid {
  std::vector<Image> bands;
  Image base;
};
/// @param bands  >= 0; fewer come back if a side shrinks to one pixel earlier
LaplacianPyramid laplacian_pyramid(const Image& image, int bands);
/// The image of a pyramid, up to rounding.
Image reconstructed(const LaplacianPyramid& pyramid);

/// Low-passed images at full size, each an octave coarser than the one before: the levels of an
/// undecimated pyramid. Band i is level i less level i + 1.
///
/// Unlike a decimated pyramid it has no aliasing, moves with the image, and mirrors with it.
class LowPassStack {
 public:
  enum class Kind {
    octaves,         ///< the kernel's taps 2^i px apart from level i to i + 1
    repeated_kernel  ///< 1 px apart throughout, as Yee's code: true octaves in its labels only
  };

  /// Starts at level 0, a copy of the image. @param image  one channel
  LowPassStack(const Image& image, Kind kind);
  void advance();
  int level() const { return level_; }
  /// The current level, and the ones one and two before it.
  const Image& current() const { return kept_[0]; }
  const Image& previous() const { return kept_[1]; }
  const Image& before_previous() const { return kept_[2]; }
  /// Variance of the current level's kernel along one axis, px^2.
  double variance_px2() const { return variance_px2_; }

 private:
  Kind kind_;
  int level_ = 0;
  double variance_px2_ = 0.0;
  std::vector<Image> kept_;
  Image scratch_;
};

/// True if no further level of octaves keeps within the Gaussian's variance.
bool is_last_level_below(const LowPassStack& stack, double sigma_px);
/// The Gaussian average of a stack's image, from its current level, which is the last one below.
Image gaussian_average(const LowPassStack& stack, double sigma_px);

/// Where the response of a band to gratings along an axis peaks, cycles per pixel (0 to 0.5),
/// from the response of the filters themselves.
double band_peak_cycles_px(LowPassStack::Kind kind, int band);

}  // namespace perception
