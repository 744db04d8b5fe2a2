// Daly 1993, "The Visible Differences Predictor: An Algorithm for the Assessment of Image
//   Fidelity", in Watson (ed.), Digital Images and Human Vision, MIT Press, 179-206.
// The chapter's text and equation numbers are not at hand: every formula and constant was checked
// against a public re-implementation of the predictor (jterrace/hdrvdp, option --ldr), which takes
// phase uncertainty and the slopes of masking from Daly's patent.
//
// Differs from that program: contrasts about the CSF's luminance keep their size, where it scales
// responses by 100 and says that this needs calibration; the CSF's area is 1 deg^2 (its --ldr mode:
// the whole display); images are mirrored at their borders; uniform changes are seen.

#include "metrics/daly_channels.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "metrics/separable_filter.h"
#include "metrics/vector_math.h"
#include "perception/contrast_sensitivity.h"
#include "perception/cortex_transform.h"
#include "perception/visual_masking.h"

namespace metrics {
namespace {

using perception::CortexTransform;
using perception::FourierFilter;
using perception::FrequencyResponse;

constexpr double kSemiSaturation = 12.6;
constexpr double kSaturationPower = 0.63;

Image make_plane(const Image& like, const char* channel) {
  return perception::make_gray_image(like.width_px, like.height_px, channel,
                                     perception::Encoding::scene_linear);
}

/// Mean of both images' responses, and the test's less the reference's, in units of contrast.
///
/// All that follows is linear up to masking, so that these two carry both images, with a
/// difference that is exactly 0 where the images agree.
struct Responses {
  Image mean;
  Image difference;
};

Responses responses_of(Image reference, Image test, double luminance_cd_m2) {
  constexpr float kDarkest_cd_m2 = 1e-30F;
  constexpr auto kScale = static_cast<float>(kSemiSaturation);
  constexpr auto kPower = static_cast<float>(kSaturationPower - 1.0);
  const double slope = daly_response_slope(luminance_cd_m2);
  const auto gain = static_cast<float>(1.0 / slope);
  const auto offset = static_cast<float>(daly_response(luminance_cd_m2) / slope);
  // L / (L + a L^b) = 1 / (1 + a L^(b - 1)); what is common to all pixels plays no part.
  const auto response = [=](float luminance) {
    const float bounded = luminance < kDarkest_cd_m2 ? kDarkest_cd_m2 : luminance;
    return gain / (1.0F + kScale * power_of(bounded, kPower)) - offset;
  };
  for_each_pixel(reference, [&](std::size_t i) {
    const float r = response(reference.pixels[i]), t = response(test.pixels[i]);
    reference.pixels[i] = 0.5F * (r + t);
    test.pixels[i] = t - r;
  });
  return {std::move(reference), std::move(test)};
}

/// Daly's CSF over the spectrum.
FrequencyResponse csf_response(double pixels_per_degree, const DalySettings& settings) {
  return
      [&settings, pixels_per_degree](float fx, std::span<const float> fy, std::span<float> gains) {
        static const perception::CsfInfo& csf = perception::find_csf("daly");
        perception::StimulusConditions conditions;
        conditions.area_deg2 = settings.area_deg2;
        conditions.viewing_distance_m = settings.distance_m;
        for (std::size_t i = 0; i < fy.size(); ++i) {
          // The CSF is the same for fy and -fy, which stands at the other end.
          if (fy[i] < 0.0F) {
            gains[i] = gains[fy.size() - i];
            continue;
          }
          const double x{fx}, y{fy[i]};
          conditions.orientation_deg = std::atan2(y, x) * 180.0 / std::numbers::pi;
          gains[i] = static_cast<float>(perception::contrast_sensitivity(
              csf, pixels_per_degree * std::hypot(x, y), settings.luminance_cd_m2, conditions));
        }
        return true;
      };
}

/// |x|^3.5: the exponent of the psychometric function.
inline float psychometric_power(float x) {
  const float magnitude = std::abs(x);
  return magnitude * magnitude * magnitude * std::sqrt(magnitude);
}

/// T_e = (1 + (k1 (k2 |m|)^s)^b)^(1/b), b = 4.
class ThresholdElevation {
 public:
  explicit ThresholdElevation(double slope)
      : slope_(static_cast<float>(slope)), scale_(scale_of(slope)) {}

  /// Elevations by the channel in two images, mean - half and mean + half the difference.
  void apply(const float* difference, std::size_t count, float* __restrict mean_to_first,
             float* __restrict second) const {
    const auto run = [&](const auto& mask_of) {
      for (std::size_t i = 0; i < count; ++i) {
        const float mean = mean_to_first[i], half = 0.5F * difference[i];
        mean_to_first[i] = elevation(mask_of(std::abs(mean - half)));
        second[i] = elevation(mask_of(std::abs(mean + half)));
      }
    };
    if (slope_ == 1.0F) {
      run([scale = scale_](float magnitude) { return scale * magnitude; });
    } else {
      run([scale = scale_, slope = slope_](float magnitude) {
        constexpr float kLeast = 1e-12F;  // no elevation, and a logarithm
        return scale * power_of(magnitude < kLeast ? kLeast : magnitude, slope);
      });
    }
  }

 private:
  static float scale_of(double slope) {
    const perception::MaskingCurve curve = perception::daly_masking_curve(slope);
    return static_cast<float>(curve.k1 * std::pow(curve.k2, slope));
  }

  static float elevation(float mask) {
    const float squared = mask * mask;
    return std::sqrt(std::sqrt(1.0F + squared * squared));
  }

  float slope_;
  float scale_;
};

/// Adds up the channels' exponents: 1 - prod (1 - P_b) with P_b = 1 - exp(-e_b) is
/// 1 - exp(-sum e_b).
class DetectionSum {
 public:
  DetectionSum(Responses responses, double pixels_per_degree, const DalySettings& settings)
      : settings_(settings),
        filter_(responses.mean.width_px, responses.mean.height_px),
        exponent_(make_plane(responses.mean, "P")) {
    const FrequencyResponse csf = filter_.tabulated(csf_response(pixels_per_degree, settings));
    mean_spectrum_ = filter_.spectrum_of(responses.mean, csf);
    difference_spectrum_ = filter_.spectrum_of(responses.difference, csf);
    reference_ = std::move(responses.mean);
    difference_ = std::move(responses.difference);
    add_uniform_changes();
    test_ = make_plane(reference_, "T");
  }

  /// Adds a channel. @param smoothing  of its threshold elevation; none: not smoothed
  void add(const FrequencyResponse& channel, const FrequencyResponse& smoothing, double slope) {
    filter_.filter(mean_spectrum_, channel, reference_);
    filter_.filter(difference_spectrum_, channel, difference_);
    elevate(ThresholdElevation(slope));
    if (smoothing && settings_.is_phase_uncertain) {
      filter_.filter(reference_, smoothing);
      filter_.filter(test_, smoothing);
    }
    for_each_pixel(exponent_, [&](std::size_t i) {
      // Mutual masking: only what both images show hides the difference.
      const float elevation = std::min(reference_.pixels[i], test_.pixels[i]);
      exponent_.pixels[i] += psychometric_power(difference_.pixels[i] / std::max(elevation, 1.0F));
    });
  }

  /// The map of probabilities.
  Image take() {
    for_each_pixel(exponent_,
                   [&](std::size_t i) { exponent_.pixels[i] = -std::expm1(-exponent_.pixels[i]); });
    return std::move(exponent_);
  }

 private:
  /// Ours: Daly's CSF is 0 at frequency 0. What the base filter leaves of the unweighted difference
  /// is seen with a sensitivity of its own, and nothing hides it.
  void add_uniform_changes() {
    if (settings_.uniform_sensitivity == 0.0) return;
    const auto sensitivity = static_cast<float>(settings_.uniform_sensitivity);
    filter_.filter(difference_, CortexTransform::base_response());
    for_each_pixel(exponent_, [&](std::size_t i) {
      exponent_.pixels[i] += psychometric_power(sensitivity * difference_.pixels[i]);
    });
  }

  /// Turns the mean of the channel in both images into the two images' threshold elevations.
  void elevate(const ThresholdElevation& elevation) {
    for_each_row(exponent_.height_px, [&](int y) {
      const std::size_t begin = exponent_.offset(0, y);
      elevation.apply(&difference_.pixels[begin], static_cast<std::size_t>(exponent_.width_px),
                      &reference_.pixels[begin], &test_.pixels[begin]);
    });
  }

  const DalySettings& settings_;
  FourierFilter filter_;
  FourierFilter::Spectrum mean_spectrum_, difference_spectrum_;
  Image exponent_;
  Image reference_, test_, difference_;  ///< of the channel at hand
};

}  // namespace

double daly_response(double luminance_cd_m2) {
  return 1.0 / (1.0 + kSemiSaturation * std::pow(luminance_cd_m2, kSaturationPower - 1.0));
}

double daly_response_slope(double luminance_cd_m2) {
  const double response = daly_response(luminance_cd_m2);
  return (1.0 - kSaturationPower) * response * (1.0 - response);
}

double daly_masking_slope(int level) {
  constexpr double kSlopes[] = {1.0, 1.0, 1.0, 0.8, 0.8, 0.7};
  return kSlopes[level - 1];
}

Image daly_detection_map(Image reference, Image test, double pixels_per_degree,
                         const DalySettings& settings) {
  DetectionSum sum(responses_of(std::move(reference), std::move(test), settings.luminance_cd_m2),
                   pixels_per_degree, settings);
  const auto slope = [&](int level) { return settings.slope.value_or(daly_masking_slope(level)); };
  for (int level = 1; level <= CortexTransform::kLevels; ++level) {
    // Mesa 0 is above 0.99 throughout the spectrum: smoothing by it would change nothing.
    const FrequencyResponse smoothing =
        level == 1 ? FrequencyResponse() : CortexTransform::mesa_response(level - 1);
    for (int orientation = 0; orientation < CortexTransform::kOrientations; ++orientation) {
      sum.add(CortexTransform::channel_response(level, orientation), smoothing, slope(level));
    }
  }
  const FrequencyResponse base = CortexTransform::base_response();
  sum.add(base, base, slope(CortexTransform::kLevels + 1));
  return sum.take();
}

}  // namespace metrics
