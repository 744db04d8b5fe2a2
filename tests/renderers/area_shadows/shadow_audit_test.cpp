#include <cmath>

#include <gtest/gtest.h>

#include "renderers/area_shadows/fragment_light.h"
#include "tests/renderers/area_shadows/shadow_bench.h"

/// What `multires-shadows` says about itself: its audit, the use of bits, samples along edges,
/// bytes.
namespace renderers::test {
namespace {

using Settings = std::vector<std::string>;

/// A hard bar across fragments of 16 pixels.
scene::Scene bar() {
  ShadowBench bench;
  bench.half_lamp_m = 0.002;
  bench.width_m = 0.25;
  bench.angle_rad = 0.3;
  bench.offset_m = 0.22;
  return bench.scene();
}

/// Penumbrae of 3.8 pixels.
scene::Scene soft_bar() {
  ShadowBench bench;
  bench.half_lamp_m = 0.06;
  bench.angle_rad = 0.3;
  return bench.scene();
}

Frame picture(const scene::Scene& scene, const Settings& settings) {
  return picture_of(scene, "multires-shadows", settings);
}

/// Without the ring edges between fragments are missed: the control. What the audit counts is what
/// pictures by themselves show.
TEST(ShadowAudit, CountsMissedBorders) {
  const Settings blind{"coarsest_level=4", "ring=false", "extra_tests=false", "audit=true"};
  const Frame missing = picture(bar(), blind);
  EXPECT_GT(counter(missing, "audit_missed_fragments"), 0.0);
  EXPECT_GT(counter(missing, "audit_crossed_blocks"), 3.0);
  ShadowBench open;
  open.half_lamp_m = 0.002;
  open.has_sheet = false;
  EXPECT_DOUBLE_EQ(
      counter(missing, "audit_missed_fragments") / counter(missing, "audit_crossed_blocks"),
      missed_share(missing, picture_of(bar(), "per-pixel-shadows"),
                   picture_of(open.scene(), "per-pixel-shadows"), 4));
  EXPECT_GT(counter(missing, "audit_missed_blocks"), 0.0);
  EXPECT_LE(counter(missing, "audit_missed_blocks"), counter(missing, "audit_missed_fragments"));
  const Frame found = picture(bar(), {"coarsest_level=4", "audit=true"});
  EXPECT_EQ(counter(found, "audit_missed_fragments"), 0.0);
  EXPECT_EQ(counter(found, "audit_missed_blocks"), 0.0);
  EXPECT_EQ(counter(found, "audit_crossed_blocks"), counter(missing, "audit_crossed_blocks"));
  EXPECT_EQ(counter(found, "audit_culled_lit_pixels"), 0.0);
}

TEST(ShadowAudit, ChangesNeitherPictureNorRays) {
  const Frame plain = picture(soft_bar(), {});
  const Frame audited = picture(soft_bar(), {"audit=true"});
  EXPECT_EQ(plain.radiance.pixels, audited.radiance.pixels);
  EXPECT_EQ(counter(plain, "rays"), counter(audited, "rays"));
  EXPECT_GT(counter(audited, "audit_rays"), 0.0);
}

/// Errors by place: all pixels of coarse fragments under RBFs, none under other upsampling.
TEST(ShadowAudit, TellsEnclosedFromExtrapolatedPixels) {
  const Settings coarse{"audit=true", "copied_level=-1", "upsampled=irradiance", "rbf_form=raw"};
  const Frame frame = picture(soft_bar(), coarse);
  EXPECT_EQ(counter(frame, "enclosed_pixels") + counter(frame, "extrapolated_pixels"), 64.0 * 64.0);
  EXPECT_GT(counter(frame, "enclosed_rmse"), 0.0);
  const Frame three = picture(soft_bar(), {"audit=true", "copied_level=-1", "upsampled=irradiance",
                                           "rbf_form=raw", "rbf_bases=3"});
  EXPECT_GT(counter(three, "extrapolated_pixels"), counter(frame, "extrapolated_pixels"))
      << "fewer bases lie around fewer places";
  const Frame nearest = picture(soft_bar(), {"audit=true", "upsampling=nearest"});
  EXPECT_EQ(counter(nearest, "enclosed_pixels") + counter(nearest, "extrapolated_pixels"), 0.0);
}

TEST(ShadowBits, AreUsedAgain) {
  const Frame kept = picture(soft_bar(), {});
  const Frame again = picture(soft_bar(), {"reuse=false"});
  EXPECT_EQ(kept.radiance.pixels, again.radiance.pixels);
  EXPECT_EQ(counter(kept, "coarse_gather_rays"), 0.0) << "coarse fragments cast no further ray";
  EXPECT_GT(counter(again, "coarse_gather_rays"), 0.0);
  EXPECT_EQ(counter(kept, "visibility_rays"), counter(again, "visibility_rays"));
  EXPECT_LT(counter(kept, "shadow_rays"), counter(again, "shadow_rays"));
}

TEST(ShadowBits, ADecisionTakesFourTimesSixteenRays) {
  const Frame frame = picture(soft_bar(), {"extra_tests=false"});
  EXPECT_LE(counter(frame, "test_rays"), 64.0 * counter(frame, "tested_fragments"));
  EXPECT_GT(counter(frame, "test_rays"), 48.0 * counter(frame, "tested_fragments"));
}

/// Each coarse fragment has three samples of its own, and its right and lower neighbours'.
TEST(EdgeSamples, AreCountedWithThoseOfNeighbours) {
  ShadowBench open;
  open.has_sheet = false;
  const Frame frame = picture(open.scene(), {"coarsest_level=4"});
  EXPECT_EQ(counter(frame, "coarse_fragments"), 16.0);
  EXPECT_EQ(counter(frame, "extra_samples"), 48.0);
  EXPECT_EQ(counter(frame, "edged_fragments"), 16.0);
  const Frame none = picture(open.scene(), {"coarsest_level=4", "extra_samples=false"});
  EXPECT_EQ(counter(none, "coarse_fragments"), 16.0);
  EXPECT_EQ(counter(none, "edged_fragments"), 0.0);
}

/// Level by level needs a picture of each level, of four floats a block, beside the list that all
/// have; one pass its extra samples.
TEST(UpsamplingBytes, OfSeveralPassesAreTheLevels) {
  const Settings levels{"coarsest_level=4", "upsampling=multi_pass"};
  const Settings nearest{"coarsest_level=4", "upsampling=nearest"};
  const double list = counter(picture(soft_bar(), nearest), "upsampling_bytes");
  EXPECT_EQ(counter(picture(soft_bar(), levels), "upsampling_bytes") - list,
            16.0 * (64 * 64 + 32 * 32 + 16 * 16 + 8 * 8 + 4 * 4));
  const Frame one_pass = picture(soft_bar(), {"coarsest_level=4"});
  EXPECT_EQ(counter(one_pass, "upsampling_bytes") - list,
            counter(one_pass, "extra_samples") * sizeof(area_shadows::LightSample));
}

TEST(PenumbraImage, ShowsPixelsThatSeeAPartOfTheLight) {
  const Frame soft = picture_of(soft_bar(), "per-pixel-shadows");
  const Frame hard = picture_of(bar(), "per-pixel-shadows");
  const auto lit = [](const Frame& frame) {
    double sum = 0.0;
    for (const float value : aov(frame, "penumbra").pixels) sum += static_cast<double>(value);
    return sum;
  };
  // Across a turned square of side 1 its shadow's border is cos + sin wide, of which the first and
  // last sqrt(2 x 0.02 sin cos) see less than 2 % of it, or of the rest.
  const double cosine = std::cos(0.3);
  const double sine = std::sin(0.3);
  const double width = cosine + sine - 2.0 * std::sqrt(0.04 * sine * cosine);
  constexpr double kSidePx = 0.12 * 32.0;
  const double expected = 2.0 * 64.0 / cosine * width * kSidePx;
  EXPECT_NEAR(lit(soft), expected, 0.05 * expected);
  EXPECT_LT(lit(hard), 0.2 * lit(soft));
}

}  // namespace
}  // namespace renderers::test
