#include "renderers/area_shadows/rbf_upsampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace renderers::area_shadows {
namespace {

constexpr int kSide_px = 64;

/// A flat picture cut into fragments of all levels, each with the value of a function of the place.
struct Bench {
  PixelSurfaces surfaces;
  FragmentSet set;
  FragmentLight light;

  explicit Bench(const std::function<float(const glm::vec2&)>& value) {
    surfaces.width_px = surfaces.height_px = set.width_px = set.height_px = kSide_px;
    PixelSurface flat;
    flat.material = 0;
    flat.depth_m = 1.0F;
    flat.receiver.normal = flat.receiver.geometric_normal = {0, 0, 1};
    surfaces.pixels.assign(kSide_px * kSide_px, flat);
    for (std::size_t i = 0; i < surfaces.pixels.size(); ++i) {
      const auto pixel = static_cast<int>(i);
      surfaces.pixels[i].receiver.position = {static_cast<float>(pixel % kSide_px),
                                              static_cast<float>(pixel / kSide_px), 0};
    }
    set.at.assign(surfaces.pixels.size(), kNone);
    for (int i = 0; i < 16; ++i) {
      Fragment block;
      block.level = 4;
      block.x = i % 4;
      block.y = i / 4;
      cut(block, (i * 5 + 3) % 7);
    }
    for (std::size_t i = 0; i < set.fragments.size(); ++i) add_light(i, value);
    light.first_extra.push_back(static_cast<std::uint32_t>(light.extras.size()));
  }

  /// Three of seven blocks stay whole; of the others one corner is cut on and on.
  void cut(Fragment fragment, int kind) {
    fragment.pixels = quadrant_pixels(fragment, set);
    if (kind < 3 || fragment.level == 0) {
      fragment.state = Fragment::State::final;
      label(fragment, static_cast<std::int32_t>(set.fragments.size()), set);
      set.fragments.push_back(fragment);
      return;
    }
    const Parts parts = parts_of(fragment, set);
    for (std::size_t i = 0; i < parts.count; ++i) {
      cut(parts.fragments[i], parts.quadrants[i] == kind - 3 ? kind : 0);
    }
  }

  void add_light(std::size_t index, const std::function<float(const glm::vec2&)>& value) {
    const Fragment& fragment = set.fragments[index];
    const auto sample_at = [&](const glm::vec2& at, std::int32_t pixel) {
      return LightSample{at, glm::vec3(value(at)), glm::vec3(1.0F), pixel};
    };
    light.centres.push_back(sample_at(centre_of(fragment, set), fragment.pixels[0]));
    light.first_extra.push_back(static_cast<std::uint32_t>(light.extras.size()));
    if (fragment.level < 3) return;
    for (const std::int32_t pixel : extra_pixels(fragment, set)) {
      const glm::vec2 at(static_cast<float>(pixel % kSide_px) + 0.5F,
                         static_cast<float>(pixel / kSide_px) + 0.5F);
      light.extras.push_back(sample_at(at, pixel));
    }
  }

  PixelIrradiance upsample(RbfForm form, RbfChoice choice, std::size_t bases = 3) const {
    RbfUpsamplingSettings settings;
    settings.rbf.form = form;
    settings.rbf.choice = choice;
    settings.rbf.bases = bases;
    settings.copied_level = form == RbfForm::planar ? 0 : 2;
    return upsample_by_rbf(surfaces, set, light, settings);
  }
};

struct Range {
  float least = 1e9F;
  float greatest = -1e9F;
};
Range range_of(const PixelIrradiance& pixels) {
  Range range;
  for (const glm::vec3& pixel : pixels) {
    range.least = std::min(range.least, pixel.x);
    range.greatest = std::max(range.greatest, pixel.x);
  }
  return range;
}

/// Greatest difference of pixels beside each other, `margin_px` away from the picture's border.
float greatest_jump(const PixelIrradiance& pixels, int margin_px = 0) {
  float jump = 0.0F;
  for (int y = margin_px; y < kSide_px - margin_px; ++y) {
    for (int x = margin_px; x + 1 < kSide_px - margin_px; ++x) {
      const auto at = static_cast<std::size_t>(y * kSide_px + x);
      const auto across = static_cast<std::size_t>(x * kSide_px + y);
      jump = std::max(jump, std::fabs(pixels[at + 1].x - pixels[at].x));
      jump = std::max(jump, std::fabs(pixels[across + kSide_px].x - pixels[across].x));
    }
  }
  return jump;
}

TEST(RbfUpsampling, TheBenchHasAllLevelsAndCoversThePicture) {
  const Bench bench([](const glm::vec2&) { return 1.0F; });
  std::array<int, 5> levels{};
  for (const Fragment& fragment : bench.set.fragments)
    ++levels[static_cast<std::size_t>(fragment.level)];
  for (const int count : levels) EXPECT_GT(count, 0);
  EXPECT_EQ(std::ranges::count(bench.set.at, kNone), 0);
}

TEST(RbfUpsampling, AConstantStaysOneAndRawFunctionsLoseIt) {
  const Bench bench([](const glm::vec2&) { return 1.0F; });
  for (const RbfChoice choice : {RbfChoice::nearest, RbfChoice::sectors}) {
    for (const RbfForm form : {RbfForm::normalised, RbfForm::planar}) {
      const Range kept = range_of(bench.upsample(form, choice, 6));
      EXPECT_FLOAT_EQ(kept.least, 1.0F);
      EXPECT_FLOAT_EQ(kept.greatest, 1.0F);
    }
    // The control: what the paper's equations make of a constant.
    const Range raw = range_of(bench.upsample(RbfForm::raw, choice));
    EXPECT_TRUE(raw.least < 0.9F || raw.greatest > 1.1F) << raw.least << " " << raw.greatest;
  }
}

/// Between samples on all sides a ramp has no jump above twice its slope where the bases change.
TEST(RbfUpsampling, ARampHasNoSeams) {
  constexpr float kSlope = 0.02F;
  constexpr int kMargin_px = 8;
  const auto ramp = [](const glm::vec2& at) { return 1.0F + 0.01F * at.x + kSlope * at.y; };
  const Bench bench(ramp);
  const PixelIrradiance smooth = bench.upsample(RbfForm::planar, RbfChoice::nearest, 6);
  EXPECT_LT(greatest_jump(smooth, kMargin_px), 2.0F * kSlope);
  // At the picture's border, where samples lie on one side only, it may be 3 times.
  EXPECT_LT(greatest_jump(smooth), 3.0F * kSlope);
  // Controls: the paper's form and nearest values jump by more.
  const PixelIrradiance raw = bench.upsample(RbfForm::raw, RbfChoice::nearest);
  EXPECT_GT(greatest_jump(raw, kMargin_px), 4.0F * kSlope);
  const PixelIrradiance nearest = upsample_nearest(bench.set, bench.light);
  EXPECT_GT(greatest_jump(nearest, kMargin_px), 8.0F * kSlope);
}

TEST(RbfUpsampling, OtherSurfacesHaveNoPart) {
  const auto step = [](const glm::vec2& at) { return at.x < 32.0F ? 1.0F : 5.0F; };
  Bench bench(step);
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 32; x < kSide_px; ++x) {
      bench.surfaces.pixels[bench.set.pixel(x, y)].receiver.position.z = -0.5F;
    }
  }
  const PixelIrradiance pixels = bench.upsample(RbfForm::normalised, RbfChoice::sectors);
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 0; x < kSide_px; ++x) {
      EXPECT_FLOAT_EQ(pixels[bench.set.pixel(x, y)].x, x < 32 ? 1.0F : 5.0F);
    }
  }
}

LightSample sample(float x, float y, float value) {
  return {{x, y}, glm::vec3(value), glm::vec3(1.0F), 0};
}

TEST(RbfInterpolation, SolvesThePapersEquations) {
  const std::array samples{sample(0, 0, 1), sample(8, 0, 2), sample(0, 8, 4)};
  Bases bases;
  for (const LightSample& one : samples) bases.samples[bases.count++] = &one;
  RbfSettings raw;
  raw.form = RbfForm::raw;
  // At the samples Eqs. 1 and 2 give their values.
  for (const LightSample& one : samples) {
    const glm::vec2 near = one.position_px + 0.01F;
    EXPECT_NEAR(interpolate(near, bases, 8.0F, raw).x, one.irradiance.x, 0.02F);
  }
  // Phi of this triangle: a = exp(-1/2) beside the right angle, b = exp(-1) across; in its middle
  // phi = exp(-1/4) for all three, so w by hand, from Phi w = I.
  const double a = std::exp(-0.5);
  const double b = std::exp(-1.0);
  // w1 + a (w2 + w3) = 1, a w1 + w2 + b w3 = 2, a w1 + b w2 + w3 = 4.
  const double sum23 = (6.0 - 2.0 * a) / (1.0 + b - 2.0 * a * a);
  const double w1 = 1.0 - a * sum23;
  const double expected = std::exp(-0.25) * (w1 + sum23);
  EXPECT_NEAR(static_cast<double>(interpolate({4, 4}, bases, 8.0F, raw).x), expected, 1e-5);
  // Eq. 3 with two samples.
  bases.count = 2;
  const double near = std::exp(-4.0 / 128.0);
  const double far = std::exp(-36.0 / 128.0);
  EXPECT_NEAR(static_cast<double>(interpolate({2, 0}, bases, 8.0F, raw).x),
              (near + 2.0 * far) / (near + far), 1e-5);
  bases.count = 1;
  EXPECT_EQ(interpolate({2, 0}, bases, 8.0F, raw).x, 1.0F);
  EXPECT_EQ(interpolate({2, 0}, {}, 8.0F, raw).x, 0.0F);
}

TEST(RbfInterpolation, SamplesInARowFallBackToTheirMean) {
  const std::array samples{sample(0, 0, 1), sample(0.1F, 0, 2), sample(0.2F, 0, 3)};
  Bases bases;
  for (const LightSample& one : samples) bases.samples[bases.count++] = &one;
  const float value = interpolate({5, 5}, bases, 8.0F, {}).x;
  EXPECT_GT(value, 1.9F);
  EXPECT_LT(value, 2.1F);
}

TEST(RbfInterpolation, SectorsTakeSamplesFromAllSides) {
  std::vector<LightSample> samples{sample(3, 0, 1), sample(4, 1, 1), sample(5, 0, 1),
                                   sample(-9, 1, 2), sample(-1, -20, 3)};
  RbfSettings settings;
  const Bases around = BaseChooser(settings).choose({0, 0}, samples);
  ASSERT_EQ(around.count, 3U);
  EXPECT_EQ(around.samples[0], &samples[0]);
  settings.choice = RbfChoice::nearest;
  const Bases near = BaseChooser(settings).choose({0, 0}, samples);
  ASSERT_EQ(near.count, 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(near.samples[i], &samples[i]);
}

}  // namespace
}  // namespace renderers::area_shadows
