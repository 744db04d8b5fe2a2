// Local contrast of frequency channels. |G_i - G_(i+1)| / G_(i+2) as in Yee 2004 (see
// visual_masking.cpp), after Lubin 1995's contrast pyramid; oriented channels after Daly 1993 (see
// cortex_transform.cpp).

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "perception/base/parallel.h"
#include "perception/cortex_transform.h"
#include "perception/image_pyramid.h"
#include "perception/visual_masking.h"

namespace perception {
namespace {

constexpr std::size_t kGrainPixels = 1 << 14;

/// Least luminance to divide by, cd/m2 (Yee's code).
constexpr float kDarkest_cd_m2 = 1e-5F;

LowPassStack::Kind stack_kind(const MaskingSettings& settings) {
  return settings.bands == MaskingBands::repeated_kernel ? LowPassStack::Kind::repeated_kernel
                                                         : LowPassStack::Kind::octaves;
}

/// |a - b| / max(c, darkest) for every pixel.
Image contrast_image(const Image& finer, const Image& coarser, const Image& surround) {
  Image contrast = make_gray_image(finer.width_px, finer.height_px, "C", finer.encoding);
  base::parallel_for(contrast.pixels.size(), kGrainPixels, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      contrast.pixels[i] = std::abs(finer.pixels[i] - coarser.pixels[i]) /
                           std::max(surround.pixels[i], kDarkest_cd_m2);
    }
  });
  return contrast;
}

/// Takes the adapting luminance out of the stack when it comes by.
class AdaptationTap {
 public:
  AdaptationTap(const Image& luminance, double ppd, const MaskingSettings& settings)
      : is_yee_(settings.is_yee_adaptation), sigma_px_(settings.adaptation_sigma_deg * ppd) {
    // The first level i with 2^i above the picture's width in degrees, as in Yee's code, where the
    // name says pixels per degree.
    const double width_deg = luminance.width_px / ppd;
    while (yee_level_ < kMostYeeLevels - 1 && std::exp2(yee_level_) <= width_deg) ++yee_level_;
  }

  /// True if the level that adaptation is made from is still to come.
  bool is_waiting() const { return !adaptation_.has_value(); }

  void look_at(const LowPassStack& stack) {
    if (!is_waiting()) return;
    if (is_yee_) {
      if (stack.level() == yee_level_) adaptation_ = stack.current();
    } else if (is_last_level_below(stack, sigma_px_)) {
      adaptation_ = gaussian_average(stack, sigma_px_);
    }
  }

  Image take() { return std::move(*adaptation_); }

 private:
  static constexpr int kMostYeeLevels = 8;

  bool is_yee_;
  double sigma_px_;
  int yee_level_ = 0;
  std::optional<Image> adaptation_;
};

/// Where the channels of the unoriented stacks lie, cycles per degree.
double band_frequency_cpd(const MaskingSettings& settings, int band, double ppd) {
  if (settings.bands == MaskingBands::repeated_kernel) return ppd / std::exp2(band + 1);
  return ppd * band_peak_cycles_px(LowPassStack::Kind::octaves, band);
}

bool is_wanted(const MaskingSettings& settings, int band, double frequency_cpd) {
  return band < settings.band_count && frequency_cpd >= settings.lowest_frequency_cpd;
}

LocalContrasts contrasts_of_stack(const Image& luminance, double ppd,
                                  const MaskingSettings& settings) {
  LocalContrasts result;
  AdaptationTap tap(luminance, ppd, settings);
  LowPassStack stack(luminance, stack_kind(settings));
  tap.look_at(stack);
  for (int band = 0;; ++band) {
    const double frequency_cpd = band_frequency_cpd(settings, band, ppd);
    const bool has_band = is_wanted(settings, band, frequency_cpd);
    if (!has_band && !tap.is_waiting()) break;
    while (stack.level() < band + 2) {
      stack.advance();
      tap.look_at(stack);
    }
    if (!has_band) continue;
    result.bands.push_back(
        {frequency_cpd, std::nullopt,
         contrast_image(stack.before_previous(), stack.previous(), stack.current())});
  }
  result.adaptation_cd_m2 = tap.take();
  return result;
}

LocalContrasts contrasts_of_cortex(const Image& luminance, double ppd,
                                   const MaskingSettings& settings) {
  LocalContrasts result;
  const CortexTransform cortex(luminance);
  const Image nothing =
      make_gray_image(luminance.width_px, luminance.height_px, "Y", luminance.encoding);
  AdaptationTap tap(luminance, ppd, settings);
  LowPassStack stack(luminance, LowPassStack::Kind::octaves);
  tap.look_at(stack);
  for (int level = 1; tap.is_waiting() || level <= CortexTransform::kLevels; ++level) {
    stack.advance();
    tap.look_at(stack);
    if (level > CortexTransform::kLevels) continue;
    const double frequency_cpd = ppd * CortexTransform::centre_cycles_px(level);
    if (!is_wanted(settings, level - 1, frequency_cpd)) continue;
    // The stack's level k averages over about two octaves more than the cortex's level k.
    for (int o = 0; o < CortexTransform::kOrientations; ++o) {
      result.bands.push_back({frequency_cpd, CortexTransform::centre_deg(o),
                              contrast_image(cortex.channel(level, o), nothing, stack.current())});
    }
  }
  result.adaptation_cd_m2 = tap.take();
  return result;
}

}  // namespace

LocalContrasts local_contrasts(const Image& luminance, double pixels_per_degree,
                               const MaskingSettings& settings) {
  check(settings);
  return settings.bands == MaskingBands::oriented_octaves
             ? contrasts_of_cortex(luminance, pixels_per_degree, settings)
             : contrasts_of_stack(luminance, pixels_per_degree, settings);
}

LocalContrasts joined(LocalContrasts a, const LocalContrasts& b, PairContrast pair) {
  for (std::size_t band = 0; band < a.bands.size(); ++band) {
    std::vector<float>& pixels = a.bands[band].contrast.pixels;
    const std::vector<float>& others = b.bands[band].contrast.pixels;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      pixels[i] = pair == PairContrast::minimum ? std::min(pixels[i], others[i])
                                                : std::max(pixels[i], others[i]);
    }
  }
  for (std::size_t i = 0; i < a.adaptation_cd_m2.pixels.size(); ++i) {
    a.adaptation_cd_m2.pixels[i] =
        0.5F * (a.adaptation_cd_m2.pixels[i] + b.adaptation_cd_m2.pixels[i]);
  }
  return a;
}

}  // namespace perception
