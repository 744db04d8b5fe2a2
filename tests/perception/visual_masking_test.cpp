#include "perception/visual_masking.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "tests/expect_error.h"
#include "tests/perception/luminance_patterns.h"

namespace perception {
namespace {

using tests::grating;
using tests::light_image;

constexpr double kPpd = 60.0;

Image one_pixel(double value) {
  return light_image(1, 1, [=](int, int) { return value; });
}

/// Bands at Yee's frequencies with given contrasts, one pixel each.
LocalContrasts yee_bands(double ppd, const std::vector<double>& contrasts) {
  LocalContrasts result;
  result.adaptation_cd_m2 = one_pixel(100.0);
  for (std::size_t i = 0; i < contrasts.size(); ++i) {
    const double frequency = ppd / std::exp2(static_cast<double>(i) + 1.0);
    result.bands.push_back({frequency, std::nullopt, one_pixel(contrasts[i])});
  }
  return result;
}

MaskingSettings unclamped() {
  MaskingSettings settings;
  settings.curve = yee_masking_curve();
  settings.largest_elevation = 1e6;
  return settings;
}

float middle(const Image& image) { return image.at(image.width_px / 2, image.height_px / 2); }

TEST(MaskingCurve, DalysConstants) {
  const MaskingCurve curve = daly_masking_curve();
  EXPECT_NEAR(curve.k1, 0.0152867, 5e-8);
  EXPECT_NEAR(curve.k2, 392.498, 5e-4);
}

TEST(MaskingCurve, PublishedElevations) {
  const double yee[][2] = {{0.1, 1.00040}, {0.5, 1.03422}, {1, 1.18972},   {2, 1.68120},
                           {3, 2.18395},   {5, 3.09631},   {6, 3.51397},   {10, 5.01821},
                           {20, 8.14936},  {50, 15.47599}, {100, 25.14073}};
  for (const auto& [m, t] : yee) EXPECT_NEAR(threshold_elevation(m, yee_masking_curve()), t, 6e-6);
  const double exact[][2] = {{1, 1.18921}, {10, 5.01386}, {100, 25.11888}};
  for (const auto& [m, t] : exact) {
    EXPECT_NEAR(threshold_elevation(m, daly_masking_curve()), t, 6e-6);
  }
  EXPECT_NEAR(threshold_elevation(1.0, daly_masking_curve(1.0)), 6.00116, 6e-6);
  EXPECT_NEAR(threshold_elevation(10.0, daly_masking_curve(1.0)), 60.0000, 6e-5);
}

TEST(MaskingCurve, IsMonotoneWithSlopeAndDefinedEverywhere) {
  const MaskingCurve curve = daly_masking_curve();
  double before = 1.0;
  for (double m = 1e-4; m < 1e6; m *= 1.3) {
    EXPECT_GE(threshold_elevation(m, curve), before);
    before = threshold_elevation(m, curve);
  }
  EXPECT_NEAR(std::log2(threshold_elevation(2e4, curve) / threshold_elevation(1e4, curve)), 0.7,
              1e-6);
  EXPECT_EQ(threshold_elevation(0.0, curve), 1.0);
  EXPECT_EQ(threshold_elevation(-3.0, curve), 1.0);
  EXPECT_TRUE(std::isnan(threshold_elevation(std::nan(""), curve)));
  EXPECT_TRUE(std::isinf(threshold_elevation(INFINITY, curve)));
  EXPECT_TRUE(std::isfinite(threshold_elevation(1e200, curve)));
}

TEST(CsfElevation, PublishedFactorsOfBarten1989) {
  const double at60[] = {23.963, 3.743, 1.472, 1.010, 1.128, 1.675};
  const double at32[] = {4.206, 1.571, 1.021, 1.100, 1.602, 2.728};
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(csf_elevation({}, 60.0 / std::exp2(i + 1)), at60[i], 6e-4) << i;
    EXPECT_NEAR(csf_elevation({}, 32.0 / std::exp2(i + 1)), at32[i], 6e-4) << i;
  }
  EXPECT_EQ(csf_elevation({}, 1e5), 1e6);
}

TEST(ElevationMap, PublishedScalarChecks) {
  const LocalContrasts even = yee_bands(60.0, {0.1, 0.1, 0.1, 0.1, 0.1, 0.1});
  MaskingSettings settings = unclamped();
  EXPECT_NEAR(elevation_map(even, settings).at(0, 0), 22.6331F, 1e-3F);
  settings.combination = MaskingCombination::separate;
  EXPECT_NEAR(elevation_map(even, settings).at(0, 0), 56.954F, 3e-3F);
  settings.combination = MaskingCombination::joint;
  const LocalContrasts single = yee_bands(60.0, {0.0, 0.0, 0.2, 0.0, 0.0, 0.0});
  EXPECT_NEAR(elevation_map(single, settings).at(0, 0), 29.217F, 2e-3F);
  EXPECT_NEAR(band_elevation_map(single, 2, settings).at(0, 0), 29.217F, 2e-3F);
  settings.largest_elevation = 10.0;
  EXPECT_EQ(elevation_map(even, settings).at(0, 0), 10.0F);
  EXPECT_EQ(elevation_map(yee_bands(60.0, {0, 0, 0, 0, 0, 0}), settings).at(0, 0), 1.0F);
}

TEST(ElevationMap, RisesWithContrastTowardsTheSlopeOfTheCurve) {
  MaskingSettings settings;
  settings.largest_elevation = 1e6;
  double before = 1.0;
  std::vector<double> elevations;
  for (double contrast = 0.001; contrast < 0.9; contrast *= 2.0) {
    const Image light = grating(240, 50.0, contrast, 2.0 / kPpd);
    elevations.push_back(static_cast<double>(
        middle(elevation_map(local_contrasts(light, kPpd, settings), settings))));
    EXPECT_GE(elevations.back(), before * (1.0 - 1e-6));
    before = elevations.back();
  }
  const double slope = std::log2(elevations.back() / elevations[elevations.size() - 2]);
  EXPECT_NEAR(slope, 0.7, 0.02);
}

TEST(ElevationMap, NeutralContrastTakesElevationToOneWithTheContent) {
  const auto elevation = [](double contrast, double neutral) {
    MaskingSettings settings;
    settings.largest_elevation = 1000.0;
    settings.neutral_contrast = neutral;
    LocalContrasts contrasts;
    contrasts.adaptation_cd_m2 = make_gray_image(1, 1, "Y", Encoding::luminance_cd_m2);
    contrasts.adaptation_cd_m2.pixels = {100.0F};
    Image band = contrasts.adaptation_cd_m2;
    band.pixels = {static_cast<float>(contrast)};
    contrasts.bands.push_back({16.0, std::nullopt, band});
    return static_cast<double>(elevation_map(contrasts, settings).pixels[0]);
  };
  const double alone = elevation(0.02, 0.0);
  // F = (C F_C + C_n) / (C + C_n).
  EXPECT_NEAR(elevation(0.02, 0.06), (0.02 * alone + 0.06) / 0.08, 1e-4 * alone);
  // Without it, content far below threshold elevates by the whole of its CSF factor.
  EXPECT_GT(elevation(1e-4, 0.0), 4.0);
  EXPECT_NEAR(elevation(1e-4, 0.05), 1.0, 1e-2);
  EXPECT_EQ(elevation(0.0, 0.05), 1.0);
}

TEST(LocalContrast, OctaveBandsHoldTheirOwnGratings) {
  const MaskingSettings settings;
  const LocalContrasts uniform =
      local_contrasts(light_image(64, 64, [](int, int) { return 5.0; }), kPpd, settings);
  ASSERT_EQ(uniform.bands.size(), 6U);
  EXPECT_EQ(uniform.bands[0].frequency_cpd, 30.0);
  for (std::size_t own : {1U, 2U, 3U}) {
    const double frequency = uniform.bands[own].frequency_cpd;
    const LocalContrasts contrasts =
        local_contrasts(grating(256, 50.0, 0.1, frequency / kPpd), kPpd, settings);
    const float own_contrast = middle(contrasts.bands[own].contrast);
    EXPECT_NEAR(own_contrast, own == 1 ? 0.0554F : 0.05F, 0.003F);
    for (std::size_t other = 0; other < 6; ++other) {
      if (other != own) {
        EXPECT_LT(middle(contrasts.bands[other].contrast), 0.8F * own_contrast) << own << other;
      }
    }
  }
}

TEST(LocalContrast, CoarseBandsAreLeftOut) {
  const Image light = light_image(32, 32, [](int, int) { return 5.0; });
  MaskingSettings settings;
  EXPECT_EQ(local_contrasts(light, 4.0, settings).bands.size(), 3U);  // 2, 0.59, 0.28 cpd
  settings.lowest_frequency_cpd = 1.0;
  EXPECT_EQ(local_contrasts(light, 4.0, settings).bands.size(), 1U);
  settings.band_count = 2;
  settings.lowest_frequency_cpd = 0.0;
  EXPECT_EQ(local_contrasts(light, 60.0, settings).bands.size(), 2U);
}

TEST(Joined, MutualMaskingTakesTheSmallerContrast) {
  const LocalContrasts a = yee_bands(60.0, {0.1, 0.5});
  LocalContrasts b = yee_bands(60.0, {0.3, 0.2});
  b.adaptation_cd_m2 = one_pixel(50.0);
  const LocalContrasts least = joined(a, b, PairContrast::minimum);
  EXPECT_EQ(least.bands[0].contrast.at(0, 0), 0.1F);
  EXPECT_EQ(least.bands[1].contrast.at(0, 0), 0.2F);
  EXPECT_EQ(least.adaptation_cd_m2.at(0, 0), 75.0F);
  EXPECT_EQ(joined(a, b, PairContrast::maximum).bands[0].contrast.at(0, 0), 0.3F);
}

/// A dip of 20 % with soft edges, a penumbra of one degree on each side.
Image soft_shadow(double ppd) {
  return light_image(256, 256, [=](int x, int) {
    const double distance_deg = std::abs(x - 128) / ppd;
    const double t = std::clamp(distance_deg - 1.0, 0.0, 1.0);
    return 50.0 * (0.8 + 0.2 * t * t * (3.0 - 2.0 * t));
  });
}

TEST(TargetElevation, ASoftShadowDoesNotHideItsBands) {
  constexpr double kShadowPpd = 30.0;
  const MaskingSettings settings;
  const LocalContrasts contrasts = local_contrasts(soft_shadow(kShadowPpd), kShadowPpd, settings);
  const Image all = elevation_map(contrasts, settings);
  const TargetElevation target(contrasts, settings);
  float most = 0.0F;
  double most_for_target = 0.0;
  for (std::size_t x = 64; x < 192; ++x) {
    const std::size_t pixel = 128 * 256 + x;
    most = std::max(most, all.pixels[pixel]);
    most_for_target = std::max(most_for_target, target.at(pixel, {8.0, std::nullopt}));
  }
  EXPECT_GT(most, 2.0F);  // the weighted mean lets the shadow hide everything
  EXPECT_LT(most_for_target, 1.3 * csf_elevation(settings, 8.0));
}

TEST(TargetElevation, TextureOfItsOwnFrequencyHidesIt) {
  const MaskingSettings settings;
  const LocalContrasts contrasts =
      local_contrasts(grating(256, 50.0, 0.05, 4.0 / kPpd), kPpd, settings);
  const TargetElevation target(contrasts, settings);
  const std::size_t pixel = 128 * 256 + 128;
  EXPECT_GT(target.at(pixel, {4.0, std::nullopt}), 3.0);
  // The map says the same of every pixel, and what the frequency alone does is less.
  const Image map = target.map({4.0, std::nullopt});
  for (std::size_t i = 0; i < map.pixels.size(); i += 37) {
    ASSERT_EQ(map.pixels[i], static_cast<float>(target.at(i, {4.0, std::nullopt})));
    ASSERT_GE(static_cast<double>(map.pixels[i]), target.unmasked({4.0, std::nullopt}) - 1e-6);
  }
  EXPECT_NEAR(target.unmasked({4.0, std::nullopt}), csf_elevation(settings, 4.0), 1e-4);
  EXPECT_EQ(target.unmasked({60.0, std::nullopt}), settings.largest_elevation);
  EXPECT_NEAR(target.at(pixel, {25.0, std::nullopt}), settings.largest_elevation, 1e-3);
  EXPECT_LT(target.at(pixel, {1.0, std::nullopt}), target.at(pixel, {4.0, std::nullopt}));
  // Without contrast near the target only the CSF counts.
  const LocalContrasts nothing =
      local_contrasts(light_image(8, 8, [](int, int) { return 9.0; }), kPpd, settings);
  EXPECT_NEAR(TargetElevation(nothing, settings).at(3, {1.0, std::nullopt}),
              csf_elevation(settings, 1.0), 1e-4);
}

TEST(TargetElevation, OrientationMattersWhenItIsOn) {
  MaskingSettings settings;
  settings.bands = MaskingBands::oriented_octaves;
  settings.csf = "daly";
  const std::size_t pixel = 128 * 256 + 128;
  const MaskingTarget vertical{4.0, 0.0};
  const LocalContrasts along =
      local_contrasts(grating(256, 50.0, 0.2, 4.0 / kPpd, 0.0), kPpd, settings);
  const LocalContrasts across =
      local_contrasts(grating(256, 50.0, 0.2, 4.0 / kPpd, 90.0), kPpd, settings);
  const double masked = TargetElevation(along, settings).at(pixel, vertical);
  const double free = TargetElevation(across, settings).at(pixel, vertical);
  EXPECT_GT(masked, 3.0);
  EXPECT_LT(free, 1.1);
  // Off, both maskers count alike.
  settings.bands = MaskingBands::octaves;
  const MaskingTarget any{4.0, std::nullopt};
  const LocalContrasts along_off =
      local_contrasts(grating(256, 50.0, 0.2, 4.0 / kPpd, 0.0), kPpd, settings);
  const LocalContrasts across_off =
      local_contrasts(grating(256, 50.0, 0.2, 4.0 / kPpd, 90.0), kPpd, settings);
  EXPECT_NEAR(TargetElevation(along_off, settings).at(pixel, any),
              TargetElevation(across_off, settings).at(pixel, any), 1e-4);
  tests::expect_error<base::InputError>(
      [&] { TargetElevation(along_off, settings).at(pixel, vertical); },
      "a masking target has an orientation, but the bands have none; accepted: bands of the kind "
      "oriented_octaves, or no orientation");
}

TEST(TargetElevation, NeedsAFrequency) {
  const MaskingSettings settings;
  const LocalContrasts contrasts = yee_bands(60.0, {0.1, 0.1});
  tests::expect_error<base::InputError>(
      [&] {
        TargetElevation(contrasts, settings).at(0, {0.0, std::nullopt});
      },
      "a masking target's frequency is 0 cpd; accepted: above 0");
}

TEST(MaskingProfile, NamesAndWhatTheyHold) {
  EXPECT_EQ(masking_profile("rama99").bands, MaskingBands::octaves);
  EXPECT_EQ(masking_profile("Yee-Compat").bands, MaskingBands::repeated_kernel);
  EXPECT_EQ(masking_profile("yee_compat").pair, PairContrast::maximum);
  EXPECT_EQ(masking_profile("rama99").neutral_contrast, 0.0);
  EXPECT_GT(masking_profile("rama99_calibrated").neutral_contrast, 0.0);
  tests::expect_error<base::InputError>(
      [] {
        masking_profile("rama9", {"s.yaml", 1, 2});
      },
      "s.yaml:1:2: unknown masking profile \"rama9\"; did you mean \"rama99\"? known: rama99, "
      "rama99_calibrated, yee_compat");
}

TEST(MaskingSettings, BadOnesAreNamed) {
  const auto refused = [](auto&& change, const std::string& message) {
    MaskingSettings settings;
    change(settings);
    tests::expect_error<base::InputError>([&] { check(settings); }, message);
  };
  refused([](MaskingSettings& s) { s.csf_gain = 0.0; },
          "masking setting csf_gain is 0; accepted: above 0");
  refused([](MaskingSettings& s) { s.band_count = 13; },
          "masking setting band_count is 13; accepted: 1 to 12");
  refused([](MaskingSettings& s) { s.largest_elevation = 0.5; },
          "masking setting largest_elevation is 0.5; accepted: 1 and above");
  refused([](MaskingSettings& s) { s.csf = "castle-red-green"; },
          "masking setting csf is \"castle-red-green\", of colour; accepted: achromatic functions");
}

}  // namespace
}  // namespace perception
