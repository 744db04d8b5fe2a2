#include "perception/stimuli.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "perception/cortex_transform.h"
#include "tests/expect_error.h"

namespace perception {
namespace {

Image modelfest_image(int number, double contrast = 1.0) {
  return stimulus_image(modelfest_stimulus(number), contrast, kModelFestMean_cd_m2,
                        kModelFestPixelsPerDegree);
}

/// Contrast of a pixel: L / mean - 1.
double contrast_at(const Image& image, int x, int y, double mean) {
  return static_cast<double>(image.at(x, y)) / mean - 1.0;
}

double rms(const Image& image, double mean) {
  double sum = 0.0;
  for (const float value : image.pixels) {
    sum += (static_cast<double>(value) - mean) * (static_cast<double>(value) - mean);
  }
  return std::sqrt(sum / static_cast<double>(image.pixels.size()));
}

TEST(Gabor, IsItsFormula) {
  const GaborPatch patch{.frequency_cpd = 4.0, .sigma_along_deg = 0.3, .sigma_across_deg = 0.6};
  EXPECT_EQ(gabor_value(patch, 0.0, 0.0), 1.0);
  EXPECT_NEAR(gabor_value(patch, 0.25, 0.0), std::exp(-0.5 * std::pow(0.25 / 0.3, 2)), 1e-12);
  EXPECT_NEAR(gabor_value(patch, 0.125, 0.0), -std::exp(-0.5 * std::pow(0.125 / 0.3, 2)), 1e-12);
  EXPECT_NEAR(gabor_value(patch, 0.0, 0.6), std::exp(-0.5), 1e-12);
  // Turned by 90 degrees, x and y change places.
  GaborPatch turned = patch;
  turned.orientation_deg = 90.0;
  EXPECT_NEAR(gabor_value(turned, 0.1, 0.2), gabor_value(patch, 0.2, -0.1), 1e-12);
}

TEST(StimulusImage, SizeMeanAndContrast) {
  const Image image = stimulus_image(grating_stimulus(2.0, 0.0, 2.0), 0.3, 50.0, 40.0);
  EXPECT_EQ(image.width_px, 80);
  EXPECT_EQ(image.height_px, 80);
  EXPECT_EQ(image.encoding, Encoding::luminance_cd_m2);
  const auto [least, most] = std::minmax_element(image.pixels.begin(), image.pixels.end());
  EXPECT_NEAR(*most, 65.0F, 0.3F);
  EXPECT_NEAR(*least, 35.0F, 0.3F);
  EXPECT_NEAR(rms(image, 50.0), 50.0 * 0.3 / std::numbers::sqrt2, 1e-3);
  EXPECT_NEAR(image.at(3, 0), image.at(23, 79), 1e-4F);  // a period is 20 pixels
  for (const float value : stimulus_image(grating_stimulus(2.0, 0.0, 1.0), 0.0, 7.0, 20.0).pixels) {
    EXPECT_EQ(value, 7.0F);
  }
  tests::expect_error<base::InputError>(
      [] { stimulus_image(grating_stimulus(2.0, 0.0, 2.0), 1.5, 50.0, 40.0); },
      "contrast is 1.5; accepted: 0 to 1");
}

TEST(ModelFest, FortyOneStimuliOf256PixelsWithUnitPeak) {
  ASSERT_EQ(modelfest_stimuli().size(), 41U);
  std::set<int> numbers;
  for (const ModelFestStimulus& one : modelfest_stimuli()) {
    numbers.insert(one.number);
    const Image image = modelfest_image(one.number);
    EXPECT_EQ(image.width_px, 256);
    EXPECT_EQ(image.height_px, 256);
    double peak = 0.0;
    for (const float value : image.pixels) {
      peak = std::max(peak, std::abs(static_cast<double>(value) / kModelFestMean_cd_m2 - 1.0));
    }
    EXPECT_LE(peak, 1.0 + 1e-6) << one.number;
    EXPECT_GT(peak, 0.7) << one.number;  // 30 cpd at 120 ppd misses its crest by 1/8 of a period
  }
  EXPECT_EQ(*numbers.begin(), 1);
  EXPECT_EQ(*numbers.rbegin(), 42);
  EXPECT_FALSE(numbers.contains(35));
  tests::expect_error<base::InputError>(
      [] { modelfest_stimulus(35); },
      "there is no ModelFest stimulus 35; accepted: 1 to 42 without 35 (35 and 43 are image "
      "files)");
}

/// Energy over the image in degree^2 against the closed form of the continuous pattern.
double energy_deg2(int number) {
  const double pixel_deg2 = 1.0 / (kModelFestPixelsPerDegree * kModelFestPixelsPerDegree);
  const Image image = modelfest_image(number);
  return std::pow(rms(image, kModelFestMean_cd_m2) / kModelFestMean_cd_m2, 2) * 256.0 * 256.0 *
         pixel_deg2;
}

TEST(ModelFest, ContrastEnergiesOfGaborsAndBlobs) {
  // A Gabor's energy is half that of its squared envelope, pi sx sy / 2; whole patches only.
  EXPECT_NEAR(energy_deg2(12), std::numbers::pi * 0.14 * 0.14 / 2.0, 2e-4);
  EXPECT_NEAR(energy_deg2(18), std::numbers::pi * 0.14 * 0.28 / 2.0, 2e-4);
  // Neighbours five sigma apart overlap a little.
  EXPECT_NEAR(energy_deg2(33), (5.0 + 8.0 * std::exp(-6.25)) * std::numbers::pi * 0.07 * 0.07 / 2.0,
              1e-5);
  EXPECT_NEAR(energy_deg2(38), std::numbers::pi * 0.14 * 0.14 / 4.0, 2e-4);
  const double blob = 8.43 / 60.0;
  EXPECT_NEAR(energy_deg2(27), std::numbers::pi * blob * blob, 1e-4);
  EXPECT_NEAR(energy_deg2(40), std::numbers::pi * 0.1249 * 0.1249, 1.2e-3);  // averaged rim
}

TEST(ModelFest, BarsAreHorizontalAndLinesOnePixel) {
  const Image gabor = modelfest_image(4);
  // Half a period of 4 cpd is 15 pixels: down the picture contrast turns, across it does not.
  EXPECT_LT(contrast_at(gabor, 128, 143, 30.0), -0.8);
  EXPECT_GT(contrast_at(gabor, 143, 128, 30.0), 0.8);
  EXPECT_GT(contrast_at(modelfest_image(37), 128, 143, 30.0), 0.3);  // turned by 90 degrees
  const Image line = modelfest_image(31);
  EXPECT_GT(contrast_at(line, 128, 128, 30.0), 0.99);
  EXPECT_NEAR(contrast_at(line, 128, 127, 30.0), 0.0, 1e-6);
  EXPECT_NEAR(contrast_at(line, 128, 129, 30.0), 0.0, 1e-6);
  const Image dipole = modelfest_image(32);
  EXPECT_LT(contrast_at(dipole, 128, 127, 30.0), -0.99);
  EXPECT_NEAR(contrast_at(dipole, 128, 128, 30.0), 0.0, 1e-6);
  EXPECT_GT(contrast_at(dipole, 128, 129, 30.0), 0.99);
  const Image edge = modelfest_image(30);
  EXPECT_LT(contrast_at(edge, 128, 127, 30.0), -0.99);
  EXPECT_GT(contrast_at(edge, 128, 128, 30.0), 0.99);
  const Image checks = modelfest_image(42);
  EXPECT_GT(contrast_at(checks, 128, 128, 30.0), 0.9);
  // Half a period of 4 cpd down and across; the axes run along the checks' diagonals.
  EXPECT_LT(contrast_at(checks, 128 + 15, 128 + 15, 30.0), -0.8);
  EXPECT_GT(contrast_at(checks, 128 + 30, 128, 30.0), 0.5);
}

TEST(ModelFest, LooksTheSameAtOtherResolutions) {
  for (const int number : {3, 27, 31, 40}) {
    const Image coarse = stimulus_image(modelfest_stimulus(number), 1.0, 30.0, 60.0);
    const Image fine = modelfest_image(number);
    EXPECT_EQ(coarse.width_px, 128);
    for (int y = 56; y < 72; ++y) {
      for (int x = 56; x < 72; ++x) {
        const float mean = 0.25F * (fine.at(2 * x, 2 * y) + fine.at(2 * x + 1, 2 * y) +
                                    fine.at(2 * x, 2 * y + 1) + fine.at(2 * x + 1, 2 * y + 1));
        EXPECT_NEAR(coarse.at(x, y), mean, number == 40 ? 4.0F : 0.7F) << number;
      }
    }
  }
}

TEST(NoisePattern, HasZeroMeanUnitPowerAndItsSpectrum) {
  constexpr double kPpd = 32.0;
  for (const NoiseKind kind :
       {NoiseKind::white, NoiseKind::pink, NoiseKind::brown, NoiseKind::narrow_band}) {
    const Image noise = noise_pattern(kind, 96, kPpd, 4.0, 7);
    double sum = 0.0;
    for (const float value : noise.pixels) sum += static_cast<double>(value);
    EXPECT_NEAR(sum / 9216.0, 0.0, 1e-6);
    EXPECT_NEAR(rms(noise, 0.0), 1.0, 1e-6);
    EXPECT_EQ(noise.pixels, noise_pattern(kind, 96, kPpd, 4.0, 7).pixels);
    EXPECT_NE(noise.pixels, noise_pattern(kind, 96, kPpd, 4.0, 8).pixels);
  }
  // Power of narrow-band noise at 4 cpd lies in the octave around 1/8 cycle per pixel.
  const CortexTransform cortex(noise_pattern(NoiseKind::narrow_band, 96, kPpd, 4.0, 7));
  double near = 0.0;
  for (const int level : {3, 4}) {
    for (int o = 0; o < 6; ++o) near += std::pow(rms(cortex.channel(level, o), 0.0), 2);
  }
  double far = std::pow(rms(cortex.baseband(), 0.0), 2);
  for (const int level : {1, 5}) {
    for (int o = 0; o < 6; ++o) far += std::pow(rms(cortex.channel(level, o), 0.0), 2);
  }
  EXPECT_GT(near, 50.0 * far);
  for (const float value : noise_pattern(NoiseKind::none, 8, kPpd, 1.0, 1).pixels) {
    EXPECT_EQ(value, 0.0F);
  }
}

TEST(EdgeInNoise, HoldsTheContrastsItSays) {
  EdgeInNoise parameters;
  parameters.edge_rms = 0.01;
  parameters.noise = NoiseKind::pink;
  const StimulusPair pair = edge_in_noise(parameters);
  EXPECT_EQ(pair.reference.width_px, 176);
  EXPECT_NEAR(rms(pair.reference, 100.0) / 100.0, 0.2, 1e-5);
  double squares = 0.0;
  for (std::size_t i = 0; i < pair.test.pixels.size(); ++i) {
    const double d =
        static_cast<double>(pair.test.pixels[i]) - static_cast<double>(pair.reference.pixels[i]);
    squares += d * d;
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(pair.test.pixels.size())), 1.0, 1e-4);
  // Bright below, dark above, highest at the edge.
  EXPECT_LT(pair.test.at(5, 87), pair.reference.at(5, 87));
  EXPECT_GT(pair.test.at(5, 88), pair.reference.at(5, 88));
  EXPECT_EQ(pair.test.at(5, 20), pair.reference.at(5, 20));
  parameters.ramp_deg = 0.0;
  tests::expect_error<base::InputError>([&] { edge_in_noise(parameters); },
                                        "the edge's ramp is 0; accepted: above 0 degrees");
}

TEST(PedestalPair, AddsTheIncrementInPhase) {
  const Stimulus patch = gabor_stimulus({.frequency_cpd = 7.0}, 2.0);
  const StimulusPair pair = pedestal_pair(patch, 0.1, 0.02, 40.0, 50.0);
  const Image increment = stimulus_image(patch, 0.02, 40.0, 50.0);
  for (std::size_t i = 0; i < increment.pixels.size(); ++i) {
    EXPECT_NEAR(pair.test.pixels[i] - pair.reference.pixels[i], increment.pixels[i] - 40.0F, 1e-4F);
  }
  EXPECT_EQ(pedestal_pair(patch, 0.1, 0.0, 40.0, 50.0).test.pixels, pair.reference.pixels);
  tests::expect_error<base::InputError>([&] { pedestal_pair(patch, 0.9, 0.2, 40.0, 50.0); },
                                        "contrast is 1.1; accepted: 0 to 1");
}

TEST(MaskedPair, AddsATargetToAMasker) {
  const Stimulus target = gabor_stimulus({.frequency_cpd = 4.0, .orientation_deg = 0.0}, 2.0);
  const Stimulus masker = grating_stimulus(4.0, 90.0, 2.0);
  const StimulusPair pair = masked_pair(target, 0.05, masker, 0.3, 40.0, 30.0);
  EXPECT_EQ(pair.reference.pixels, stimulus_image(masker, 0.3, 40.0, 30.0).pixels);
  EXPECT_NEAR(pair.test.at(30, 30) - pair.reference.at(30, 30), 40.0 * 0.05, 0.2);
  EXPECT_THROW(masked_pair(target, 0.05, grating_stimulus(4.0, 0.0, 3.0), 0.3, 40.0, 30.0),
               base::InputError);
}

TEST(Stimuli, AreTheSameForAnyNumberOfThreads) {
  const auto with_threads = [](int threads) {
    const base::ThreadLimit limit(threads);
    return modelfest_image(42).pixels;
  };
  EXPECT_EQ(with_threads(1), with_threads(4));
}

}  // namespace
}  // namespace perception
