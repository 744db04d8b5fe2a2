#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "perception/image.h"

namespace perception {

/// A sine grating under an elliptical Gaussian:
/// cos(2 pi f u + phase) exp(-(u^2 / sigma_along^2 + v^2 / sigma_across^2) / 2), u along the
/// change.
struct GaborPatch {
  double frequency_cpd = 4.0;
  double sigma_along_deg = 0.5;
  double sigma_across_deg = 0.5;
  double orientation_deg = 0.0;  ///< of the change: 0 are vertical bars, 90 horizontal ones
  double phase_deg = 0.0;
  double x_deg = 0.0;  ///< centre
  double y_deg = 0.0;
};
double gabor_value(const GaborPatch& patch, double x_deg, double y_deg);

/// A pattern of vision research, a contrast for every direction of view: luminance is
/// mean (1 + contrast x pattern(x, y)).
struct Stimulus {
  std::string name;
  std::string description;
  double width_deg = 0.0;
  double height_deg = 0.0;
  /// In [-1, 1]; degrees to the right and down from the centre.
  std::function<double(double x_deg, double y_deg)> pattern;
  /// Sharp-edged patterns are averaged over this many samples along each side of a pixel.
  int samples_per_side = 1;
  /// The patch, where the pattern is a single one: what a contrast sensitivity function knows.
  std::optional<GaborPatch> gabor = std::nullopt;
};

/// The stimulus as light: one channel Y, cd/m2, round(size x ppd) pixels, at least one.
/// @param contrast  peak contrast, 0 to 1 @param mean_cd_m2, pixels_per_degree  > 0
/// @throws base::InputError for a value out of range
Image stimulus_image(const Stimulus& stimulus, double contrast, double mean_cd_m2,
                     double pixels_per_degree);

Stimulus gabor_stimulus(const GaborPatch& patch, double size_deg);

/// A sine grating that fills a square.
Stimulus grating_stimulus(double frequency_cpd, double orientation_deg, double size_deg);

/// A uniform disc on a larger square field. @param diameter_deg  > 0
Stimulus disc_stimulus(double diameter_deg, double size_deg);

/// One of the ModelFest stimuli, 256 x 256 pixels of 1/120 degree at 30 cd/m2.
///
/// Carney et al. 1999, doi:10.1117/12.348473; Watson, Ahumada 2005, doi:10.1167/5.9.6. Numbers 35
/// (a noise sample) and 43 (a photograph) need image files and are left out. The order of the
/// dipole's lines (32) and the phase of the checkerboard (42) are ours.
struct ModelFestStimulus {
  int number = 0;
  Stimulus stimulus;
};
constexpr double kModelFestMean_cd_m2 = 30.0;
constexpr double kModelFestPixelsPerDegree = 120.0;
/// All 41, by number.
std::span<const ModelFestStimulus> modelfest_stimuli();
/// @throws base::InputError saying which numbers there are
const Stimulus& modelfest_stimulus(int number);

/// Spectra of masking noise.
enum class NoiseKind {
  none,
  white,
  pink,        ///< amplitude 1 / f
  brown,       ///< amplitude 1 / f^2
  narrow_band  ///< one octave wide: log-Gaussian amplitude, half its height 0.5 octave away
};

/// Random noise with mean 0 and root mean square 1, the same for a seed on every machine.
/// @param centre_cpd  of narrow_band, > 0
Image noise_pattern(NoiseKind kind, int size_px, double pixels_per_degree, double centre_cpd,
                    std::uint64_t seed);

/// A horizontal Cornsweet edge in noise, after Schmittwilken, Wichmann, Maertens 2024,
/// doi:10.1016/j.visres.2024.108450: 4 x 4 degrees, 44 pixels per degree, 100 cd/m2.
///
/// Profile, before it is brought to unit root mean square: +-(1 - |y| / ramp) up to the ramp's
/// width, 0 beyond. The noise's spectra are ours where the paper's differ in detail.
struct EdgeInNoise {
  double ramp_deg = 0.15;  ///< 0.048, 0.15 and 0.95 in the paper
  double edge_rms = 0.0;   ///< root mean square contrast of the edge over the image
  NoiseKind noise = NoiseKind::none;
  double noise_centre_cpd = 3.0;  ///< of narrow_band: 0.5, 3, 9 in the paper
  double noise_rms = 0.2;
  std::uint64_t seed = 1;
  double size_deg = 4.0;
  double mean_cd_m2 = 100.0;
  double pixels_per_degree = 44.0;
};

/// What an observer compares: without and with the thing to be seen.
struct StimulusPair {
  Image reference;
  Image test;
};
/// Luminance may fall below 0 in strong noise; it is not clipped.
/// @throws base::InputError for a value out of range
StimulusPair edge_in_noise(const EdgeInNoise& parameters);

/// A dipper experiment: the pedestal, and the pedestal with the increment added in phase.
/// @param pattern  shared by both @param pedestal, increment  peak contrasts, their sum at most 1
/// @throws base::InputError for a value out of range
StimulusPair pedestal_pair(const Stimulus& pattern, double pedestal, double increment,
                           double mean_cd_m2, double pixels_per_degree);

/// A target on a masker of another pattern: masker alone, masker and target.
/// @throws base::InputError for a value out of range, or if the stimuli differ in size
StimulusPair masked_pair(const Stimulus& target, double target_contrast, const Stimulus& masker,
                         double masker_contrast, double mean_cd_m2, double pixels_per_degree);

}  // namespace perception
