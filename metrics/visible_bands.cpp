// Ramasubramanian, Pattanaik, Greenberg 1999, doi:10.1145/311535.311543 (threshold = TVI x
// elevation); Daly 1993, "The Visible Differences Predictor" (mutual masking, elevation curve).
// Differs from both: the difference itself is split into octaves, see visible_bands.h.

#include "metrics/visible_bands.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "metrics/separable_filter.h"
#include "perception/base/names.h"
#include "perception/color_conversion.h"
#include "perception/contrast_sensitivity.h"
#include "perception/image_pyramid.h"
#include "perception/tabulated_curve.h"

namespace metrics {
namespace {

using perception::LowPassStack;
using perception::TabulatedCurve;

/// Least luminance to divide by and to adapt to, cd/m2 (Yee's code).
constexpr float kDarkest_cd_m2 = 1e-5F;

Image make_map(const Image& like, const char* channel) {
  return perception::make_gray_image(like.width_px, like.height_px, channel, like.encoding);
}

double peak_sensitivity(const perception::MaskingSettings& masking) {
  return masking.csf_gain *
         perception::csf_peak(perception::find_csf(masking.csf), masking.csf_luminance_cd_m2)
             .sensitivity;
}

bool is_by_bands(VisibilityModel model) {
  return model == VisibilityModel::band_matched || model == VisibilityModel::off;
}

/// Both images' low-passed levels, from which octaves of their difference are weighed and added.
class BandSum {
 public:
  BandSum(const Image& reference, const Image& test, double ppd, const VisibilitySettings& settings)
      : settings_(settings),
        ppd_(ppd),
        reference_(reference, LowPassStack::Kind::octaves),
        test_(test, LowPassStack::Kind::octaves),
        masked_(make_map(reference, "jnd")),
        unmasked_(make_map(reference, "jnd")) {
    if (settings.model == VisibilityModel::band_matched) {
      mask_.emplace([curve = settings.masking.curve](double m) {
        return perception::threshold_elevation(m, curve);
      });
    }
    tap_adaptation();
  }

  /// Adds all octaves and what is coarser.
  void run() {
    int band = 0;
    for (; is_wanted(band); ++band) {
      while (reference_.level() < band + 2) advance();
      add_band(frequency_cpd(band));
    }
    const bool has_bands = band > 0;
    add_rest(has_bands ? reference_.previous() : reference_.current(),
             has_bands ? test_.previous() : test_.current());
    while (!adaptation_) advance();
  }

  Image& masked() { return masked_; }
  Image& unmasked() { return unmasked_; }
  const Image& adaptation_cd_m2() const { return *adaptation_; }

 private:
  double frequency_cpd(int band) const {
    return ppd_ * perception::band_peak_cycles_px(LowPassStack::Kind::octaves, band);
  }

  bool is_wanted(int band) const {
    return band < settings_.masking.band_count &&
           frequency_cpd(band) >= settings_.masking.lowest_frequency_cpd;
  }

  void advance() {
    reference_.advance();
    test_.advance();
    tap_adaptation();
  }

  /// The mean of both images' averages, as soon as the levels are coarse enough.
  void tap_adaptation() {
    const double sigma_px = settings_.masking.adaptation_sigma_deg * ppd_;
    if (adaptation_ || !perception::is_last_level_below(reference_, sigma_px)) return;
    adaptation_ = perception::gaussian_average(reference_, sigma_px);
    const Image other = perception::gaussian_average(test_, sigma_px);
    for_each_pixel(other, [&](std::size_t i) {
      adaptation_->pixels[i] = 0.5F * (adaptation_->pixels[i] + other.pixels[i]);
    });
  }

  /// The contrast both images have in the octave, averaged over half a period.
  const Image& mutual_contrast() {
    if (contrast_.is_empty()) contrast_ = make_map(masked_, "C");
    const auto contrast = [](const LowPassStack& stack, std::size_t i) {
      const float band = stack.before_previous().pixels[i] - stack.previous().pixels[i];
      return std::abs(band) / std::max(stack.current().pixels[i], kDarkest_cd_m2);
    };
    for_each_pixel(contrast_, [&](std::size_t i) {
      contrast_.pixels[i] = std::min(contrast(reference_, i), contrast(test_, i));
    });
    // The kernel's taps reach over 4 x 2^b px; half a period at the octave's peak is 1.5 x 2^b px.
    const int spacing_px = 1 << (reference_.level() - 2);
    perception::smooth(contrast_, perception::burt_adelson_kernel(spacing_px),
                       perception::Border::replicate, scratch_, smoothed_);
    return smoothed_;
  }

  void add_band(double frequency_cpd) {
    const auto& masking = settings_.masking;
    const auto gain = static_cast<float>(1.0 / perception::csf_elevation(masking, frequency_cpd));
    const float* r0 = reference_.before_previous().pixels.data();
    const float* r1 = reference_.previous().pixels.data();
    const float* t0 = test_.before_previous().pixels.data();
    const float* t1 = test_.previous().pixels.data();
    if (!mask_) {
      for_each_pixel(unmasked_, [&](std::size_t i) {
        unmasked_.pixels[i] += gain * ((t0[i] - t1[i]) - (r0[i] - r1[i]));
      });
      return;
    }
    const Image& contrast = mutual_contrast();
    const auto sensitivity =
        static_cast<float>(masking.csf_gain * perception::contrast_sensitivity(
                                                  perception::find_csf(masking.csf), frequency_cpd,
                                                  masking.csf_luminance_cd_m2));
    const auto largest = static_cast<float>(masking.largest_elevation);
    for_each_pixel(unmasked_, [&](std::size_t i) {
      const float difference = gain * ((t0[i] - t1[i]) - (r0[i] - r1[i]));
      unmasked_.pixels[i] += difference;
      masked_.pixels[i] +=
          difference / std::clamp((*mask_)(contrast.pixels[i] * sensitivity), 1.0F, largest);
    });
  }

  void add_rest(const Image& reference, const Image& test) {
    const auto gain = static_cast<float>(std::min(settings_.tvi_scale, 1.0));
    for_each_pixel(unmasked_, [&](std::size_t i) {
      const float difference = gain * (test.pixels[i] - reference.pixels[i]);
      unmasked_.pixels[i] += difference;
      masked_.pixels[i] += difference;
    });
    if (!mask_) masked_ = unmasked_;
  }

  const VisibilitySettings& settings_;
  double ppd_;
  LowPassStack reference_, test_;
  Image masked_, unmasked_;
  Image contrast_, scratch_, smoothed_;
  std::optional<TabulatedCurve> mask_;
  std::optional<Image> adaptation_;
};

/// Differences in cd/m2 become JNDs; fills `spot_cd_m2` and `step_jnd`.
void divide_by_tvi(const Image& reference, const Image& test, const Image& adaptation_cd_m2,
                   const VisibilitySettings& settings, VisibilityMaps& maps) {
  const TabulatedCurve tvi([curve = settings.curve](double luminance) {
    return perception::threshold_cd_m2(curve, luminance);
  });
  maps.spot_cd_m2 = make_map(reference, "threshold");
  maps.step_jnd = make_map(reference, "jnd");
  const auto scale = static_cast<float>(settings.tvi_scale);
  for_each_pixel(reference, [&](std::size_t i) {
    const float threshold = tvi(std::max(adaptation_cd_m2.pixels[i], kDarkest_cd_m2));
    const float per_jnd = 1.0F / (scale * threshold);
    maps.spot_cd_m2.pixels[i] = std::max(scale, 1.0F) * threshold;
    maps.step_jnd.pixels[i] = per_jnd * std::abs(test.pixels[i] - reference.pixels[i]);
    maps.unmasked_jnd.pixels[i] = per_jnd * std::abs(maps.unmasked_jnd.pixels[i]);
    maps.jnd.pixels[i] = per_jnd * std::abs(maps.jnd.pixels[i]);
  });
}

VisibilityMaps maps_by_bands(const Image& reference, const Image& test, double ppd,
                             const VisibilitySettings& settings) {
  BandSum bands(reference, test, ppd, settings);
  bands.run();
  VisibilityMaps maps;
  maps.unmasked_jnd = std::move(bands.unmasked());
  maps.jnd = std::move(bands.masked());
  divide_by_tvi(reference, test, bands.adaptation_cd_m2(), settings, maps);
  return maps;
}

Image divided(const Image& reference, const Image& test, const Image& elevation) {
  Image quotient = make_map(reference, "jnd");
  for_each_pixel(quotient, [&](std::size_t i) {
    quotient.pixels[i] = (test.pixels[i] - reference.pixels[i]) / elevation.pixels[i];
  });
  return quotient;
}

VisibilityMaps maps_by_pixels(const Image& reference, const Image& test, double ppd,
                              const VisibilitySettings& settings) {
  perception::MaskingSettings masking = settings.masking;
  const perception::LocalContrasts contrasts =
      perception::joined(perception::local_contrasts(reference, ppd, masking),
                         perception::local_contrasts(test, ppd, masking), masking.pair);
  VisibilityMaps maps;
  maps.jnd = divided(reference, test, perception::elevation_map(contrasts, masking));
  masking.curve.k1 = 0.0;  // T_e = 1
  maps.unmasked_jnd = divided(reference, test, perception::elevation_map(contrasts, masking));
  divide_by_tvi(reference, test, contrasts.adaptation_cd_m2, settings, maps);
  return maps;
}

}  // namespace

VisibilitySettings visibility_settings(VisibilityModel model, const std::string& csf,
                                       const std::string& curve, double tvi_scale,
                                       double csf_gain) {
  VisibilitySettings settings;
  settings.model = model;
  settings.curve = perception::threshold_curve_from_text(curve);
  settings.masking.csf = csf;
  if (model == VisibilityModel::separate) {
    settings.masking.combination = perception::MaskingCombination::separate;
  }
  if (perception::find_csf(csf).normalization == perception::CsfNormalization::relative) {
    perception::MaskingSettings daly = settings.masking;
    daly.csf = "daly";
    settings.masking.csf_gain = peak_sensitivity(daly) / peak_sensitivity(settings.masking);
  }
  settings.masking.csf_gain *= csf_gain;
  perception::check(settings.masking);
  settings.tvi_scale = tvi_scale > 0.0      ? tvi_scale
                       : is_by_bands(model) ? matched_tvi_scale(settings)
                                            : 1.0;
  return settings;
}

std::vector<base::ParameterSpec> visibility_parameters() {
  std::vector<std::string> csfs;
  for (const perception::CsfInfo& csf : perception::csf_list()) {
    if (csf.normalization != perception::CsfNormalization::cone) {
      csfs.push_back(base::snake_case(csf.name));
    }
  }
  return {
      base::choice_parameter("csf", csfs, "daly",
                             "Contrast sensitivity; ours: of the models with a scale of their own "
                             "one that needs no gain to meet gratings of one degree (ModelFest)."),
      base::choice_parameter("tvi", perception::threshold_curve_names(), "ward",
                             "Threshold against luminance; the rods and cones of Ferwerda et al. "
                             "1996 joined by Ward Larson et al. 1997."),
      base::real_parameter("tvi_scale", 0.0, {0.0, 100.0}, "",
                           "Multiplies TVI; 0: so that gratings have the CSF's thresholds at 100 "
                           "cd/m2 where octaves are weighed, else 1; ours."),
  };
}

double matched_tvi_scale(const VisibilitySettings& settings) {
  const double luminance = settings.masking.csf_luminance_cd_m2;
  return luminance / (peak_sensitivity(settings.masking) *
                      perception::threshold_cd_m2(settings.curve, luminance));
}

VisibilityMaps visibility_maps(const Image& reference, const Image& test, double pixels_per_degree,
                               const VisibilitySettings& settings) {
  return is_by_bands(settings.model) ? maps_by_bands(reference, test, pixels_per_degree, settings)
                                     : maps_by_pixels(reference, test, pixels_per_degree, settings);
}

Image luminance_of(const Image& light) {
  Image luminance = perception::make_gray_image(light.width_px, light.height_px, "Y",
                                                perception::Encoding::luminance_cd_m2);
  for_each_pixel(luminance, [&](std::size_t i) {
    const float* rgb = &light.pixels[3 * i];
    const auto& weights = perception::kRec709Luma;
    luminance.pixels[i] =
        std::max(weights[0] * rgb[0] + weights[1] * rgb[1] + weights[2] * rgb[2], 0.0F);
  });
  return luminance;
}

}  // namespace metrics
