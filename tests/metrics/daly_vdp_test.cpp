#include "metrics/daly_vdp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "metrics/daly_channels.h"
#include "perception/contrast_sensitivity.h"
#include "perception/cortex_transform.h"
#include "perception/stimuli.h"
#include "perception/visual_masking.h"
#include "tests/expect_input_error.h"
#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;
using metrics::daly_detection_map;
using metrics::DalySettings;
using perception::CortexTransform;

constexpr double kMean_cd_m2 = 30.0;
constexpr int kSize_px = 128;

/// A square of light mean (1 + contrast(x, y)), x and y in pixels from the centre.
template <typename Contrast>
Image light(const Contrast& contrast, double mean_cd_m2 = kMean_cd_m2) {
  Image image = perception::make_gray_image(kSize_px, kSize_px, "Y", Encoding::luminance_cd_m2);
  for (int y = 0; y < kSize_px; ++y) {
    for (int x = 0; x < kSize_px; ++x) {
      image.at(x, y) =
          static_cast<float>(mean_cd_m2 * (1.0 + contrast(x - kSize_px / 2, y - kSize_px / 2)));
    }
  }
  return image;
}

Image plain(double mean_cd_m2 = kMean_cd_m2) {
  return light([](int, int) { return 0.0; }, mean_cd_m2);
}

/// cos(2 pi f d + phase) along an orientation; 0 degrees are vertical bars.
auto grating(double cycles_px, double orientation_deg, double phase_deg = 0.0) {
  const double angle = orientation_deg * std::numbers::pi / 180.0;
  return [=](int x, int y) {
    const double d = x * std::cos(angle) + y * std::sin(angle);
    return std::cos(2.0 * std::numbers::pi * cycles_px * d + phase_deg * std::numbers::pi / 180.0);
  };
}

/// Largest probability away from the borders.
double largest(const Image& map) {
  float result = 0.0F;
  for (int y = kSize_px / 4; y < 3 * kSize_px / 4; ++y) {
    for (int x = kSize_px / 4; x < 3 * kSize_px / 4; ++x) result = std::max(result, map.at(x, y));
  }
  return result;
}

double mean(const Image& map) {
  double sum = 0.0;
  for (const float value : map.pixels) sum += double{value};
  return sum / static_cast<double>(map.pixels.size());
}

/// The difference over its threshold of 63 % that one channel would need for the probability.
double thresholds_of(double probability) { return std::pow(-std::log1p(-probability), 1.0 / 3.5); }

double daly_csf(double frequency_cpd, double orientation_deg = 0.0) {
  perception::StimulusConditions conditions;
  conditions.orientation_deg = orientation_deg;
  return perception::contrast_sensitivity(perception::find_csf("daly"), frequency_cpd, kMean_cd_m2,
                                          conditions);
}

TEST(DalyResponse, ClosedForms) {
  EXPECT_EQ(metrics::daly_response(0.0), 0.0);
  // L / (L + 12.6 L^0.63), 10^0.63 = 4.2657951880.
  EXPECT_NEAR(metrics::daly_response(10.0), 10.0 / (10.0 + 12.6 * 4.2657951880), 1e-10);
  EXPECT_NEAR(metrics::daly_response(1.0), 1.0 / 13.6, 1e-12);
  // 12.6 L^-0.37 = 1.
  EXPECT_NEAR(metrics::daly_response(std::pow(12.6, 1.0 / 0.37)), 0.5, 1e-12);
  for (const double luminance : {0.1, 30.0, 1000.0}) {
    const double step = 1e-4;
    const double derivative = (metrics::daly_response(luminance * (1.0 + step)) -
                               metrics::daly_response(luminance * (1.0 - step))) /
                              (2.0 * step);
    EXPECT_NEAR(metrics::daly_response_slope(luminance), derivative, 1e-8);
  }
}

TEST(DalyVdp, AGratingAtAChannelsCentreHasTheClosedForm) {
  // Level 3 has unit response at 1/6 cycle per pixel, and its fan at every multiple of 30 degrees.
  const double cycles_px = CortexTransform::centre_cycles_px(3);
  for (const double frequency_cpd : {2.0, 10.0}) {
    for (const double orientation_deg : {0.0, 90.0, 30.0}) {
      const double sensitivity = daly_csf(frequency_cpd, orientation_deg);
      for (const double thresholds : {0.7, 1.3}) {
        const double contrast = thresholds / sensitivity;
        const auto wave = grating(cycles_px, orientation_deg);
        const Image test = light([&](int x, int y) { return contrast * wave(x, y); });
        const double p = largest(daly_detection_map(plain(), test, frequency_cpd / cycles_px, {}));
        EXPECT_NEAR(thresholds_of(p), thresholds, 0.03 * thresholds)
            << frequency_cpd << " cpd, " << orientation_deg << " degrees";
      }
    }
  }
}

TEST(DalyVdp, ThresholdsOfGratingsAreTheCsfs) {
  // Between the channels' centres two or four of them share the grating; probability summation
  // gives back less than their sum.
  constexpr double kPpd = 67.0;
  for (const double frequency_cpd : {1.0, 2.0, 4.0, 6.0, 8.0, 16.0}) {
    for (const double orientation_deg : {0.0, 45.0}) {
      const double contrast = 1.0 / daly_csf(frequency_cpd, orientation_deg);
      const auto wave = grating(frequency_cpd / kPpd, orientation_deg);
      const auto p = [&](double scale) {
        const Image test = light([&](int x, int y) { return scale * contrast * wave(x, y); });
        return largest(daly_detection_map(plain(), test, kPpd, {}));
      };
      const double ratio = 1.0 / thresholds_of(p(1.0));
      EXPECT_GT(ratio, 0.95) << frequency_cpd << " " << orientation_deg;
      EXPECT_LT(ratio, 2.8) << frequency_cpd << " " << orientation_deg;
      EXPECT_LT(p(0.5), 0.1) << frequency_cpd << " " << orientation_deg;
      EXPECT_GT(p(4.0), 0.95) << frequency_cpd << " " << orientation_deg;
    }
  }
}

TEST(DalyVdp, AMaskHidesATargetOfItsOwnOrientation) {
  constexpr double kPpd = 24.0;  // 4 cpd at a channel's centre
  const auto wave = grating(4.0 / kPpd, 0.0);
  const auto seen = [&](double mask_orientation_deg, double mask_contrast) {
    const auto mask = grating(4.0 / kPpd, mask_orientation_deg);
    const auto masked = [&](double target) {
      return light(
          [&, target](int x, int y) { return mask_contrast * mask(x, y) + target * wave(x, y); });
    };
    return thresholds_of(
        std::min(0.999999, largest(daly_detection_map(masked(0.0), masked(0.02), kPpd, {}))));
  };
  const double alone = seen(0.0, 0.0);
  EXPECT_GT(alone, 1.5);
  EXPECT_LT(seen(0.0, 0.2), 0.3 * alone);
  EXPECT_GT(seen(90.0, 0.2), 0.8 * alone);
  // A fan away the mask still touches the target's channel; two away it does not.
  EXPECT_LT(seen(0.0, 0.2), seen(20.0, 0.2));
  EXPECT_LT(seen(20.0, 0.2), seen(60.0, 0.2));
}

TEST(DalyVdp, MaskingIsMutual) {
  // A grating in the test image alone, however strong, does not hide itself.
  constexpr double kPpd = 24.0;
  const auto wave = grating(4.0 / kPpd, 0.0);
  const auto of_contrast = [&](double contrast) {
    return light([&, contrast](int x, int y) { return contrast * wave(x, y); });
  };
  const double contrast = 1.0 / daly_csf(4.0);
  const double weak = largest(daly_detection_map(plain(), of_contrast(contrast), kPpd, {}));
  const double strong =
      largest(daly_detection_map(plain(), of_contrast(20.0 * contrast), kPpd, {}));
  EXPECT_NEAR(weak, 1.0 - std::exp(-1.0), 0.03);
  EXPECT_EQ(strong, 1.0);
  // The same increase on a pedestal that both show is hidden.
  const double on_pedestal = largest(
      daly_detection_map(of_contrast(20.0 * contrast), of_contrast(22.0 * contrast), kPpd, {}));
  EXPECT_LT(on_pedestal, weak);
}

TEST(DalyVdp, MasksHideAtTheirZerosByPhaseUncertainty) {
  constexpr double kPpd = 24.0;
  const auto mask = grating(4.0 / kPpd, 0.0, 90.0);
  const auto target = grating(4.0 / kPpd, 0.0);  // largest where the mask is 0
  const auto masked = [&](double contrast) {
    return light(
        [&, contrast](int x, int y) { return 0.3 * mask(x, y) + contrast * target(x, y); });
  };
  const auto seen = [&](bool is_phase_uncertain) {
    DalySettings settings;
    settings.is_phase_uncertain = is_phase_uncertain;
    return largest(daly_detection_map(masked(0.0), masked(0.03), kPpd, settings));
  };
  EXPECT_LT(seen(true), 0.5);
  EXPECT_GT(seen(false), 0.9);
}

TEST(DalyVdp, ExchangeOfTheImagesChangesNoByte) {
  const Image a = light(grating(0.11, 30.0)), b = light(grating(0.12, 20.0, 50.0));
  EXPECT_EQ(daly_detection_map(a, b, 40.0, {}).pixels, daly_detection_map(b, a, 40.0, {}).pixels);
}

TEST(DalyVdp, DarkerPicturesAreSeenWorse) {
  const auto p_mean = [](double mean_cd_m2) {
    const auto wave = grating(0.1, 0.0);
    return mean(daly_detection_map(
        plain(mean_cd_m2), light([&](int x, int y) { return 0.01 * wave(x, y); }, mean_cd_m2), 40.0,
        {}));
  };
  EXPECT_GT(p_mean(30.0), p_mean(3.0));
  EXPECT_GT(p_mean(3.0), p_mean(0.3));
}

TEST(DalyVdp, UniformChangesAreSeenFromTheirOwnThresholdOn) {
  const auto p = [](double change, double sensitivity) {
    DalySettings settings;
    settings.uniform_sensitivity = sensitivity;
    return mean(daly_detection_map(plain(), plain(kMean_cd_m2 * (1.0 + change)), 40.0, settings));
  };
  EXPECT_NEAR(p(0.01, 14.0), 1.0 - std::exp(-std::pow(0.14, 3.5)), 1e-4);
  EXPECT_GT(p(0.15, 14.0), 0.95);
  EXPECT_LT(p(0.15, 0.0), 1e-6);
}

TEST(DalyVdp, MoreNoiseIsSeenByMorePixelsUntilAllDo) {
  const Image reference = wavy_picture(96, 64, Encoding::display);
  double last = 0.0;
  for (const float amplitude : {0.005F, 0.01F, 0.02F, 0.04F, 0.08F}) {
    const auto score = score_of("daly-vdp", reference, with_noise(reference, amplitude));
    EXPECT_GT(detail(score, "p_mean"), last) << amplitude;
    last = detail(score, "p_mean");
  }
  EXPECT_GT(last, 0.9);
}

TEST(DalyVdp, SharesAreThoseOfTheMap) {
  const Image reference = wavy_picture(96, 64, Encoding::display);
  const Image test = with_noise(reference, 0.03F);
  const auto score = score_of("daly-vdp", reference, test);
  const auto share = [&](float at_least) {
    const auto& p = score.map->pixels;
    const auto seen = std::count_if(p.begin(), p.end(), [&](float v) { return v >= at_least; });
    return static_cast<double>(seen) / (96.0 * 64.0);
  };
  EXPECT_EQ(score.value, share(0.75F));
  EXPECT_EQ(detail(score, "share_50"), share(0.5F));
  EXPECT_EQ(detail(score, "share_75"), score.value);
  EXPECT_GT(detail(score, "share_50"), detail(score, "share_75"));
  EXPECT_GT(detail(score, "share_75"), detail(score, "share_95"));
  EXPECT_NEAR(detail(score, "p_mean"), mean(*score.map), 1e-6);
  EXPECT_EQ(score_of("daly-vdp,p_threshold=0.5", reference, test).value, share(0.5F));
  for (const float p : score.map->pixels) {
    EXPECT_GE(p, 0.0F);
    EXPECT_LE(p, 1.0F);
  }
}

TEST(DalyVdp, FindsASquareWhereItIs) {
  const auto wall = [](float square) {
    return picture(128, 96, Encoding::luminance_cd_m2, [=](int x, int y) -> std::array<float, 3> {
      const bool is_inside = x >= 30 && x < 50 && y >= 40 && y < 60;
      const float value = is_inside ? square : 50.0F;
      return {value, value, value};
    });
  };
  const auto score = score_of("daly-vdp", wall(50.0F), wall(65.0F));
  ASSERT_EQ(score.regions.size(), 1U);
  const auto& region = score.regions[0];
  EXPECT_NEAR(region.x_px + 0.5 * region.width_px, 40.0, 2.0);
  EXPECT_NEAR(region.y_px + 0.5 * region.height_px, 50.0, 2.0);
  EXPECT_GT(score.map->at(40, 40), 0.99F);
  EXPECT_LT(score.map->at(100, 20), 0.01F);
}

TEST(DalyVdp, BlackPicturesDoNotDifferAndLightInThemIsSeen) {
  const Image black = gray_picture(40, 30, Encoding::luminance_cd_m2, 0.0F);
  EXPECT_EQ(score_of("daly-vdp", black, black).value, 0.0);
  EXPECT_EQ(
      score_of("daly-vdp", black, gray_picture(40, 30, Encoding::luminance_cd_m2, 10.0F)).value,
      1.0);
}

TEST(DalyVdp, FromFartherAwayFineNoiseIsUnseen) {
  const Image reference = gray_picture(128, 96, Encoding::luminance_cd_m2, 60.0F);
  const Image test = with_noise(reference, 2.0F);
  const auto choice = metrics::parse_metric_choice("daly-vdp", {});
  double last = 1.1;
  for (const double ppd : {30.0, 60.0, 120.0, 240.0}) {
    perception::ViewingConditions viewing;
    viewing.pixels_per_degree = ppd;
    const auto score = metrics::score(choice, {reference, test}, viewing);
    EXPECT_LT(detail(score, "p_mean"), last) << ppd;
    last = detail(score, "p_mean");
  }
  EXPECT_LT(last, 0.01);
}

TEST(DalyVdp, EdgesInNoiseAreSeenAtTheObserversThresholds) {
  // Schmittwilken et al. 2024 (see stimuli.h), edge of 0.048 degrees: root mean square contrast
  // seen in 75 % of two-alternative choices, pooled over six observers.
  struct Masker {
    perception::NoiseKind noise;
    double centre_cpd;
    double threshold;
  };
  using perception::NoiseKind;
  constexpr Masker kMaskers[] = {{NoiseKind::none, 3.0, 0.00204},
                                 {NoiseKind::white, 3.0, 0.00204 * 3.31},
                                 {NoiseKind::pink, 3.0, 0.00204 * 3.37},
                                 {NoiseKind::brown, 3.0, 0.00204 * 0.98},
                                 {NoiseKind::narrow_band, 0.5, 0.00204 * 0.82},
                                 {NoiseKind::narrow_band, 3.0, 0.00204 * 2.17},
                                 {NoiseKind::narrow_band, 9.0, 0.00204 * 3.49}};
  // Mean probability along the row where the edge is seen best.
  const auto seen = [](const Masker& masker, double edge_rms) {
    perception::EdgeInNoise stimulus;
    stimulus.ramp_deg = 0.048;
    stimulus.edge_rms = edge_rms;
    stimulus.noise = masker.noise;
    stimulus.noise_centre_cpd = masker.centre_cpd;
    perception::StimulusPair pair = perception::edge_in_noise(stimulus);
    for (float& value : pair.reference.pixels) value = std::max(value, 0.0F);
    for (float& value : pair.test.pixels) value = std::max(value, 0.0F);
    const Image map = daly_detection_map(pair.reference, pair.test, stimulus.pixels_per_degree, {});
    double best = 0.0;
    for (int y = map.height_px / 2 - 20; y < map.height_px / 2 + 20; ++y) {
      double sum = 0.0;
      for (int x = 20; x < map.width_px - 20; ++x) sum += double{map.at(x, y)};
      best = std::max(best, sum / (map.width_px - 40));
    }
    return best;
  };
  for (const Masker& masker : kMaskers) {
    EXPECT_LT(seen(masker, masker.threshold / 1.5), 0.5) << masker.centre_cpd;
    EXPECT_GT(seen(masker, masker.threshold * 1.5), 0.5) << masker.centre_cpd;
  }
}

TEST(DalyVdp, SteeperMaskingHidesMore) {
  const Image reference = with_noise(gray_picture(96, 64, Encoding::luminance_cd_m2, 60.0F), 20.0F);
  const Image test = with_noise(reference, 4.0F);
  const auto p_mean = [&](const std::string& metric) {
    return detail(score_of(metric, reference, test), "p_mean");
  };
  EXPECT_GT(p_mean("daly-vdp,slope=0.65"), p_mean("daly-vdp,slope=0.8"));
  EXPECT_GT(p_mean("daly-vdp,slope=0.8"), p_mean("daly-vdp,slope=1"));
}

TEST(DalyVdp, RefusesWhatIsNoProbability) {
  EXPECT_EQ(input_error_of([] { metrics::parse_metric_choice("daly-vdp,p_threshold=75", {}); }),
            "parameter \"p_threshold\" of metric \"daly-vdp\" cannot be \"75\"; accepted: a number "
            "from 0.001 to 0.999");
}

}  // namespace
