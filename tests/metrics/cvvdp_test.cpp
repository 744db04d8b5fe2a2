#include "metrics/cvvdp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;
using perception::ViewingConditions;

Image clipped(Image image) {
  for (float& value : image.pixels) value = std::clamp(value, 0.0F, 1.0F);
  return image;
}

/// The wavy picture of 160 x 120 pixels, and a channel of it (or all: -1) made brighter.
Image waves() { return wavy_picture(160, 120, Encoding::display); }
Image raised(Image image, int channel) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (channel < 0 || i % 3 == static_cast<std::size_t>(channel)) image.pixels[i] += 0.1F;
  }
  return clipped(image);
}

double quality(const Image& reference, const Image& test, const ViewingConditions& viewing = {}) {
  return metrics::score(metrics::parse_metric_choice("cvvdp", {}), {reference, test}, viewing)
      .value;
}

ViewingConditions display_of(double ppd, double peak_cd_m2, double black_cd_m2, double lux) {
  ViewingConditions viewing;
  viewing.pixels_per_degree = ppd;
  viewing.peak_cd_m2 = peak_cd_m2;
  viewing.black_cd_m2 = black_cd_m2;
  viewing.ambient_lux = lux;
  return viewing;
}

// Values named "program" below were computed with the authors' program, version 0.5.7 (PyTorch on
// the CPU), on the same pictures and displays. It has the full sensitivity table and calculates in
// single precision throughout, hence the tolerance in JOD.
constexpr double kTolerance_jod = 6e-4;

TEST(Cvvdp, HasTheProgramsValuesOnPicturesOfAllSizes) {
  struct Case {
    int width_px, height_px;
    double program[3];  // of noise amplitudes 0.01, 0.05, 0.2
  };
  // Rows and columns even and odd in every combination; bands down to the base band alone.
  const Case cases[] = {
      {64, 48, {9.988917, 9.601918, 7.446023}},   {131, 77, {9.989382, 9.615268, 7.493025}},
      {77, 130, {9.989053, 9.607169, 7.466574}},  {256, 256, {9.989343, 9.614513, 7.500501}},
      {200, 135, {9.988943, 9.608582, 7.496565}}, {20, 20, {9.989580, 9.630535, 7.486521}},
      {7, 5, {9.968309, 9.848616, 9.460959}},     {3, 3, {9.931810, 9.686773, 8.914806}}};
  const float amplitudes[] = {0.01F, 0.05F, 0.2F};
  for (const Case& one : cases) {
    const Image reference = wavy_picture(one.width_px, one.height_px, Encoding::display);
    for (int i = 0; i < 3; ++i) {
      const Image test = clipped(with_noise(reference, amplitudes[i]));
      EXPECT_NEAR(quality(reference, test), one.program[i], kTolerance_jod)
          << one.width_px << "x" << one.height_px << " " << amplitudes[i];
    }
  }
}

TEST(Cvvdp, HasTheProgramsValuesOnOtherDisplays) {
  const Image reference = waves();
  const Image test = clipped(with_noise(reference, 0.05F));
  const double ppd = ViewingConditions{}.pixels_per_degree;
  EXPECT_NEAR(quality(reference, test), 9.60365, kTolerance_jod);
  EXPECT_NEAR(quality(test, reference), 9.60329, kTolerance_jod);
  EXPECT_NEAR(quality(reference, test, display_of(8.0, 200.0, 0.2, 250.0)), 6.15467, 1e-3);
  EXPECT_NEAR(quality(reference, test, display_of(30.0, 200.0, 0.2, 250.0)), 9.05235,
              kTolerance_jod);
  EXPECT_NEAR(quality(reference, test, display_of(100.0, 200.0, 0.2, 250.0)), 9.86859,
              kTolerance_jod);
  // Bright and fine: where the rebuilt sensitivity is furthest from the full table.
  EXPECT_NEAR(quality(reference, test, display_of(ppd, 1500.0, 0.0015, 10.0)), 9.45910, 3e-3);
  const ViewingConditions dim = display_of(ppd, 2.0, 0.002, 0.0);
  EXPECT_NEAR(quality(reference, test, dim), 9.99621, kTolerance_jod);
  Image dark = reference;
  for (float& value : dark.pixels) value *= 0.2F;
  const Image noisy = clipped(with_noise(dark, 0.05F));
  EXPECT_NEAR(quality(dark, noisy), 9.58006, kTolerance_jod);
  EXPECT_NEAR(quality(dark, noisy, dim), 9.99584, kTolerance_jod);
}

TEST(Cvvdp, HasTheProgramsValuesForOtherErrors) {
  const Image reference = waves();
  Image shifted = reference;
  Image block = reference;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      for (int c = 0; c < 3; ++c) {
        shifted.at((x + 3) % 160, y, c) = reference.at(x, y, c);
        if (x >= 60 && x < 100 && y >= 40 && y < 80) block.at(x, y, c) = 0.9F;
      }
    }
  }
  EXPECT_NEAR(quality(reference, shifted), 9.11943, kTolerance_jod);
  EXPECT_NEAR(quality(reference, block), 7.99662, kTolerance_jod);
  EXPECT_NEAR(quality(reference, raised(reference, 0)), 9.69189, kTolerance_jod);
  EXPECT_NEAR(quality(reference, raised(reference, 2)), 9.09291, kTolerance_jod);
  EXPECT_NEAR(quality(reference, raised(reference, -1)), 9.85665, kTolerance_jod);
}

TEST(Cvvdp, HasTheProgramsHeatMap) {
  const Image reference = waves();
  const auto mean_of_map = [&](const Image& test) {
    const auto score = score_of("cvvdp", reference, test);
    double sum = 0.0;
    for (const float value : score.map->pixels) {
      EXPECT_GE(value, 0.0F);
      sum += static_cast<double>(value);
    }
    return sum / static_cast<double>(score.map->pixels.size());
  };
  // Ten times the program's, which shows 1 - JOD / 10 (and rounds it to half precision).
  EXPECT_NEAR(mean_of_map(clipped(with_noise(reference, 0.05F))), 0.143274, 1e-4);
  EXPECT_NEAR(mean_of_map(raised(reference, 0)), 0.333430, 5e-4);
}

TEST(Cvvdp, TheMapShowsWhereTheErrorIs) {
  const Image reference = gray_picture(96, 96, Encoding::display, 0.5F);
  Image test = reference;
  for (int c = 0; c < 3; ++c) test.at(70, 20, c) = 1.0F;
  const auto score = score_of("cvvdp", reference, test);
  EXPECT_NEAR(detail(score, "lost_jod_maximum_x_px"), 70.0, 1.0);
  EXPECT_NEAR(detail(score, "lost_jod_maximum_y_px"), 20.0, 1.0);
  EXPECT_LT(score.map->at(10, 90), 0.01F * score.map->at(70, 20));
  EXPECT_GT(detail(score, "achromatic"), detail(score, "red_green"));
}

TEST(Cvvdp, DoesNotSeeAChangeOfAWholeUniformPicture) {
  // Every contrast is taken over the picture's own background: adaptation is complete.
  const Image dark = gray_picture(64, 64, Encoding::display, 0.5F);
  const Image bright = gray_picture(64, 64, Encoding::display, 0.6F);
  EXPECT_NEAR(quality(dark, bright), 10.0, 1e-4);
}

TEST(Cvvdp, SeparatesWhatIsSeenFromWhatIsNot) {
  // A grating of 4 cycles per degree at 67 pixels per degree; threshold is near 0.5 %.
  const auto grating = [](double contrast) {
    return picture(256, 256, Encoding::luminance_cd_m2, [&](int x, int) -> std::array<float, 3> {
      const double phase = 2.0 * std::numbers::pi * 4.0 * x / 67.0206;
      const auto light = static_cast<float>(50.0 * (1.0 + contrast * std::sin(phase)));
      return {light, light, light};
    });
  };
  const Image uniform = grating(0.0);
  EXPECT_GT(quality(uniform, grating(0.0005)), 9.99);
  EXPECT_LT(quality(uniform, grating(0.1)), 9.0);
  // Masking: the same step of contrast is less visible on a strong grating of the same kind.
  EXPECT_GT(quality(grating(0.5), grating(0.51)), quality(uniform, grating(0.01)) + 0.01);
}

TEST(Cvvdp, HasThePublishedColoursAndQualities) {
  const auto white = metrics::cvvdp_opponent_of({100.0, 100.0, 100.0});
  EXPECT_NEAR(white[0], 105.10279, 6e-6);
  EXPECT_NEAR(white[1], 0.37753, 6e-6);
  EXPECT_NEAR(white[2], 1.03271, 6e-6);
  const auto red = metrics::cvvdp_opponent_of({100.0, 0.0, 0.0});
  EXPECT_NEAR(red[0], 23.32012, 6e-6);
  EXPECT_NEAR(red[1], 12.76208, 6e-6);
  EXPECT_NEAR(red[2], -21.48225, 6e-6);

  const std::pair<double, double> qualities[] = {{0.0, 10.0},     {0.05, 9.99742}, {0.1, 9.99484},
                                                 {1.0, 9.95604},  {5.0, 9.80357},  {20.0, 9.28673},
                                                 {100.0, 6.81260}};
  for (const auto& [difference, jod] : qualities) {
    EXPECT_NEAR(metrics::cvvdp_quality_jod(difference), jod, 6e-6) << difference;
  }
}

TEST(Cvvdp, AMaskLeavesOutTheWorstPart) {
  const Image reference = waves();
  Image test = reference;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 40; ++x) test.at(x, y, 1) = (x + y) % 4 < 2 ? 0.2F : 0.8F;
  }
  const Image right = mask_where(160, 120, [](int x, int) { return x >= 80; });
  const Image left = mask_where(160, 120, [](int x, int) { return x < 40; });
  const double whole = quality(reference, test);
  EXPECT_LT(score_of("cvvdp", reference, test, &left).value, whole);
  EXPECT_GT(score_of("cvvdp", reference, test, &right).value, 9.9);
}

TEST(Cvvdp, TakesGreyAlphaAndNegativeLight) {
  Image gray = perception::make_gray_image(20, 20, "Y", Encoding::luminance_cd_m2);
  std::fill(gray.pixels.begin(), gray.pixels.end(), 30.0F);
  Image spot = gray;
  spot.at(10, 10) = 60.0F;
  const Image rgb = perception::rgb_of(gray);
  const Image rgb_spot = perception::rgb_of(spot);
  EXPECT_EQ(quality(gray, spot), quality(rgb, rgb_spot));

  Image with_alpha(20, 20, {"R", "G", "B", "A"}, Encoding::luminance_cd_m2);
  for (std::size_t i = 0; i < rgb.pixel_count(); ++i) {
    std::copy_n(&rgb_spot.pixels[3 * i], 3, &with_alpha.pixels[4 * i]);
  }
  EXPECT_EQ(quality(rgb, with_alpha), quality(rgb, rgb_spot));

  Image negative = rgb;
  negative.at(3, 3, 2) = -5.0F;
  EXPECT_TRUE(std::isfinite(quality(rgb, negative)));
  Image black = rgb;
  std::fill(black.pixels.begin(), black.pixels.end(), 0.0F);
  EXPECT_EQ(quality(black, black), 10.0);
  EXPECT_TRUE(std::isfinite(quality(black, rgb_spot)));
}

}  // namespace
