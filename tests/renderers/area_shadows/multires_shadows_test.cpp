#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"
#include "tests/renderers/area_shadows/polygon_irradiance.h"
#include "tests/renderers/area_shadows/shadow_bench.h"

/// The renderer `multires-shadows`: laws of its fragments, and its picture against the one that
/// lights every pixel.
namespace renderers::test {
namespace {

using Settings = std::vector<std::string>;

const Settings kPaper{"depth_measure=range",  "depth_threshold=0.1",  "normal_measure=range",
                      "normal_threshold=0.2", "test_points=same",     "bit_threshold=1",
                      "ring=false",           "extra_tests=false",    "free_level=0",
                      "estimate=sum",         "upsampled=irradiance", "rbf_form=raw",
                      "rbf_bases=3",          "copied_level=2",       "bits_per_level=0"};

/// The settings with others in their place or after them.
Settings with(Settings settings, const Settings& more) {
  for (const std::string& setting : more) {
    const std::string name = setting.substr(0, setting.find('=') + 1);
    std::erase_if(settings, [&](const std::string& old) { return old.starts_with(name); });
    settings.push_back(setting);
  }
  return settings;
}

/// Floor, wall, ball and box under two lamps, part of it before the background.
scene::Scene still_life() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert({0.8F, 0.7F, 0.6F}));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(5.0F)));
  const int gloss = builder.add_material(phong(glm::vec3(0.3F), glm::vec3(0.3F), 6.0F));
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, white);
  builder.add_quad({-2, 0, 2}, {0, 1.5F, 0}, {4, 0, 0}, white);
  builder.add_quad({-1, 2.4F, 0}, {0.6F, 0, 0}, {0, 0, 0.6F}, lamp);
  builder.add_quad({0.9F, 2.2F, 0.4F}, {0.3F, 0, 0}, {0, 0, 0.5F}, lamp);
  builder.add_sphere({0.4F, 0.5F, 0.5F}, 0.5F, 32, white);
  builder.add_box({-1.0F, 0.0F, 0.2F}, {-0.5F, 0.9F, 0.7F}, gloss, false);
  builder.add_point_light({1.2F, 1.5F, -0.5F}, glm::vec3(0.5F));
  builder.look({0.3F, 1.2F, -3.6F}, {0, 0.7F, 0.5F}, 45.0F);
  return builder.scene;
}

TEST(MultiresShadows, UnoccludedLightIsThePolygonsAtEveryLevel) {
  const LampOverFloor lamp;
  const scene::Scene scene = lamp.scene().scene;
  constexpr int kSide_px = 48;
  std::set<float> levels;
  for (int coarsest = 0; coarsest <= 5; ++coarsest) {
    const Frame frame = picture_of(scene, "multires-shadows",
                                   {"coarsest_level=" + std::to_string(coarsest)}, kSide_px);
    for (int y = 0; y < kSide_px; ++y) {
      for (int x = 0; x < kSide_px; ++x) {
        if (aov(frame, "albedo").at(x, y) != 1.0F) continue;
        const double expected = lamp.irradiance(lamp.point(x, y, kSide_px));
        EXPECT_NEAR(irradiance_at(frame.radiance, x, y), expected, 0.005 * expected);
        levels.insert(aov(frame, "level").at(x, y));
      }
    }
  }
  EXPECT_GE(levels.size(), 5U);
}

TEST(MultiresShadows, FragmentsTileTheSurfacesOnce) {
  const scene::Scene scene = still_life();
  for (const Settings& settings : {Settings{}, kPaper}) {
    // 75 x 53: no multiple of any fragment.
    const Frame frame = render(scene, {.renderer = "multires-shadows",
                                       .settings = settings,
                                       .width_px = 75,
                                       .height_px = 53,
                                       .samples = 0});
    const perception::Image& level = aov(frame, "level");
    std::vector<double> pixels(6, 0.0);
    std::size_t surfaces = 0;
    for (int y = 0; y < 53; ++y) {
      for (int x = 0; x < 75; ++x) {
        const bool has_surface = aov(frame, "albedo").at(x, y) > 0.0F;
        EXPECT_TRUE(!has_surface || level.at(x, y) >= 0.0F) << x << ", " << y;
        if (has_surface) ++surfaces;
        if (level.at(x, y) >= 0.0F) pixels[static_cast<std::size_t>(level.at(x, y))] += 1.0;
      }
    }
    EXPECT_GT(surfaces, 2000U);
    EXPECT_LT(surfaces, 75U * 53U);  // there is background
    // Each level's fragments have their pixels, less what the image's end cuts off.
    for (const auto& [name, value] : frame.counters) {
      if (name != "level_fragments") continue;
      const auto& counts = std::get<std::vector<double>>(value);
      for (std::size_t l = 0; l < counts.size(); ++l) {
        EXPECT_LE(pixels[l], counts[l] * std::pow(4.0, l)) << l;
        EXPECT_GE(pixels[l], 0.25 * counts[l] * std::pow(4.0, l)) << l;
      }
      EXPECT_EQ(pixels[0], counts[0]);
    }
  }
}

/// All fragments pixels: the bits of the renderer that lights every pixel, in every channel.
TEST(MultiresShadows, PixelsAloneGiveTheReferencesBits) {
  const scene::Scene scene = still_life();
  const Frame reference = picture_of(scene, "per-pixel-shadows");
  const Settings all_pixels{"depth_threshold=0", "normal_threshold=0", "free_level=0"};
  for (const Settings& settings : {Settings{}, kPaper}) {
    const Frame frame = picture_of(scene, "multires-shadows", with(settings, all_pixels));
    EXPECT_EQ(frame.radiance.pixels, reference.radiance.pixels);
    EXPECT_EQ(counter(frame, "shadow_rays"), counter(reference, "shadow_rays"));
  }
  const Frame coarse = picture_of(scene, "multires-shadows");
  EXPECT_NE(coarse.radiance.pixels, reference.radiance.pixels);
  EXPECT_LT(counter(coarse, "shadow_rays"), 0.7 * counter(reference, "shadow_rays"));
  EXPECT_LT(relative_rmse(coarse.radiance, reference.radiance), 0.01);
}

/// A fragment that two surfaces share must not take values from around it, which tell about one of
/// them, nor mix what they see: a ball and a box before a lit floor, with the finest thresholds.
TEST(MultiresShadows, FragmentsAcrossSurfacesAreAsGoodAsPixels) {
  const scene::Scene scene = still_life();
  constexpr int kSide_px = 128;
  const Frame reference = picture_of(scene, "per-pixel-shadows", {}, kSide_px);
  const Frame split =
      picture_of(scene, "multires-shadows", {"bit_threshold=1", "free_level=0"}, kSide_px);
  const Frame kept = picture_of(scene, "multires-shadows", {"bit_threshold=1"}, kSide_px);
  const double split_error = relative_rmse(split.radiance, reference.radiance);
  const double kept_error = relative_rmse(kept.radiance, reference.radiance);
  RecordProperty("split", std::to_string(split_error));
  RecordProperty("kept", std::to_string(kept_error));
  EXPECT_LT(kept_error, 1.2 * split_error);
  EXPECT_LT(counter(kept, "fragments"), 0.9 * counter(split, "fragments"));
}

/// The environment is one more light: soft shadows all over, nothing is culled.
TEST(MultiresShadows, AnEnvironmentIsALight) {
  scene::Scene scene = still_life();
  SceneBuilder sky;
  sky.set_environment({0.3F, 0.4F, 0.5F});
  scene.environment = sky.scene.environment;
  const Frame reference = picture_of(scene, "per-pixel-shadows");
  const Frame frame = picture_of(scene, "multires-shadows");
  EXPECT_EQ(counter(frame, "area_lights"), 3.0);
  EXPECT_EQ(counter(frame, "culled_fragments"), 0.0);
  EXPECT_LT(relative_rmse(frame.radiance, reference.radiance), 0.02);
  EXPECT_LT(counter(frame, "shadow_rays"), 0.9 * counter(reference, "shadow_rays"));
}

/// Bars and steps with hard edges, at angles and between pixels. Without the ring edges between
/// fragments are missed: the control.
TEST(MultiresShadows, HardShadowEdgesAreFound) {
  const Settings coarse{"coarsest_level=4"};
  double missed = 0.0;
  double missed_without_ring = 0.0;
  double missed_by_paper = 0.0;
  int pictures = 0;
  for (const double width_m : {0.25, 0.5}) {  // 8 and 16 pixels of 64
    for (const double angle_rad : {0.0, 0.3, 0.8, 1.57}) {
      ShadowBench bench;
      bench.half_lamp_m = 0.002;
      bench.width_m = width_m;
      bench.angle_rad = angle_rad;
      bench.offset_m = 0.11 * ++pictures;
      const scene::Scene scene = bench.scene();
      const Frame reference = picture_of(scene, "per-pixel-shadows");
      bench.has_sheet = false;
      const Frame open = picture_of(bench.scene(), "per-pixel-shadows");
      const auto share_of = [&](const Settings& settings) {
        return missed_share(picture_of(scene, "multires-shadows", settings), reference, open, 4);
      };
      missed += share_of(coarse);
      missed_without_ring += share_of(with(coarse, {"ring=false", "extra_tests=false"}));
      missed_by_paper += share_of(with(kPaper, coarse));
    }
  }
  EXPECT_LE(missed / pictures, 0.01);
  EXPECT_GT(missed_without_ring / pictures, 0.1);
  EXPECT_GT(missed_by_paper / pictures, 0.1);
}

perception::Image levels_of(const scene::Scene& scene, const Settings& settings) {
  return aov(picture_of(scene, "multires-shadows", settings), "level");
}

/// Whether no pixel's fragment is coarser in the first one; and some are finer.
testing::AssertionResult is_finer(const perception::Image& a, const perception::Image& b) {
  bool differs = false;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (a.pixels[i] > b.pixels[i]) return testing::AssertionFailure() << "coarser at " << i;
    differs = differs || a.pixels[i] < b.pixels[i];
  }
  if (!differs) return testing::AssertionFailure() << "nothing differs";
  return testing::AssertionSuccess();
}

TEST(MultiresShadows, LowerThresholdsNeverTakeRefinementAway) {
  const scene::Scene scene = still_life();
  const Settings plain{"ring=false",           "extra_tests=false", "gass=false",
                       "test_points=same",     "bit_threshold=3",   "depth_threshold=0.5",
                       "normal_threshold=0.9", "bits_per_level=0"};
  const perception::Image base = levels_of(scene, plain);
  EXPECT_TRUE(is_finer(levels_of(scene, with(plain, {"bit_threshold=1"})), base));
  EXPECT_TRUE(is_finer(levels_of(scene, with(plain, {"bits_per_level=1"})), base));
  EXPECT_TRUE(is_finer(levels_of(scene, with(plain, {"depth_threshold=0.005"})), base));
  EXPECT_TRUE(is_finer(levels_of(scene, with(plain, {"normal_threshold=0.1"})), base));
  EXPECT_TRUE(is_finer(levels_of(scene, with(plain, {"free_level=0"})), base));
  EXPECT_TRUE(is_finer(levels_of(scene, with(plain, {"ring=true"})), base));
  EXPECT_TRUE(is_finer(levels_of(scene, with(plain, {"extra_tests=true"})), base));
}

TEST(MultiresShadows, SteepGradientsSkipALevel) {
  ShadowBench bench;
  bench.half_lamp_m = 0.05;
  bench.angle_rad = 0.4;
  const scene::Scene scene = bench.scene();
  const Settings plain{"ring=false", "extra_tests=false", "test_points=same", "bit_threshold=1"};
  const Frame with_gass = picture_of(scene, "multires-shadows", plain);
  const Frame without = picture_of(scene, "multires-shadows", with(plain, {"gass=false"}));
  EXPECT_TRUE(is_finer(aov(with_gass, "level"), aov(without, "level")));
  std::set<float> pieces;
  for (const float value : aov(with_gass, "pieces").pixels) pieces.insert(value);
  for (const float value : pieces) {
    EXPECT_TRUE(value == 0.0F || value == 4.0F || value == 10.0F || value == 13.0F ||
                value == 16.0F)
        << value;
  }
  EXPECT_GT(pieces.size(), 2U);
  EXPECT_GT(counter(with_gass, "pieces_10") + counter(with_gass, "pieces_13"), 0.0);
  EXPECT_EQ(counter(without, "pieces_10") + counter(without, "pieces_16"), 0.0);
  EXPECT_LT(counter(with_gass, "tested_fragments"), counter(without, "tested_fragments"));
}

/// Culled pixels are those no light reaches, and there are some: the box's far sides.
TEST(MultiresShadows, CullingTakesNoLight) {
  const scene::Scene scene = still_life();
  const Frame reference = picture_of(scene, "per-pixel-shadows");
  const Frame frame = picture_of(scene, "multires-shadows");
  double culled = 0.0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      if (aov(frame, "culled").at(x, y) != 1.0F) continue;
      culled += 1.0;
      EXPECT_EQ(aov(reference, "irradiance").at(x, y), 0.0F);
    }
  }
  EXPECT_GT(culled, 0.0);
  EXPECT_GT(counter(frame, "culled_fragments"), 0.0);
}

/// A post that moves by shares of a pixel: no position is an exception.
TEST(MultiresShadows, ErrorsStayBoundedWhileAnOccluderMoves) {
  double worst = 0.0;
  double worst_by_paper = 0.0;
  for (int step = 0; step < 6; ++step) {
    ShadowBench bench;
    bench.half_lamp_m = 0.06;
    bench.width_m = 0.12;  // 4 pixels under a penumbra as wide
    bench.angle_rad = 0.2;
    bench.offset_m = 0.007 * step;
    const scene::Scene scene = bench.scene();
    const perception::Image truth = picture_of(scene, "per-pixel-shadows").radiance;
    worst = std::max(worst, relative_rmse(picture_of(scene, "multires-shadows").radiance, truth));
    worst_by_paper =
        std::max(worst_by_paper,
                 relative_rmse(picture_of(scene, "multires-shadows", kPaper).radiance, truth));
  }
  EXPECT_LT(worst, 0.02);
  EXPECT_GT(worst_by_paper, 2.0 * worst);
}

/// The wide penumbra of a half plane, pixel by pixel against the reference with many points.
TEST(MultiresShadows, APenumbraKeepsItsProfile) {
  ShadowBench bench;
  bench.half_lamp_m = 0.3;
  bench.width_m = 3.0;
  bench.offset_m = 1.5;
  const scene::Scene scene = bench.scene();
  const Frame truth = picture_of(scene, "per-pixel-shadows", {"light_points=1024"});
  const Frame frame = picture_of(scene, "multires-shadows");
  const auto largest = static_cast<double>(*std::ranges::max_element(truth.radiance.pixels));
  for (std::size_t i = 0; i < truth.radiance.pixels.size(); ++i) {
    EXPECT_NEAR(frame.radiance.pixels[i], truth.radiance.pixels[i], 0.08 * largest) << i;
  }
  EXPECT_LT(relative_rmse(frame.radiance, truth.radiance), 0.015);
}

TEST(MultiresShadows, SameBytesForEveryNumberOfThreads) {
  const scene::Scene scene = still_life();
  for (const Settings& settings : {Settings{}, kPaper, Settings{"upsampling=multi_pass"}}) {
    RenderRequest request{.renderer = "multires-shadows",
                          .settings = settings,
                          .width_px = 40,
                          .height_px = 40,
                          .samples = 0,
                          .threads = 1};
    const Frame one = render(scene, request);
    request.threads = 3;
    const Frame three = render(scene, request);
    EXPECT_EQ(three.radiance.pixels, one.radiance.pixels);
    EXPECT_EQ(counter(three, "rays"), counter(one, "rays"));
  }
}

TEST(MultiresShadows, RaysAddUp) {
  const Frame frame = picture_of(still_life(), "multires-shadows");
  EXPECT_EQ(counter(frame, "shadow_rays"), counter(frame, "visibility_rays") +
                                               counter(frame, "gather_rays") +
                                               counter(frame, "extra_rays"));
  EXPECT_EQ(counter(frame, "rays"), counter(frame, "shadow_rays") + counter(frame, "camera_rays") +
                                        counter(frame, "point_light_rays") +
                                        counter(frame, "glossy_rays"));
  EXPECT_EQ(counter(frame, "fragments"),
            counter(frame, "final_fragments") + counter(frame, "extra_samples"));
  double extras = 0.0;
  for (const float value : aov(frame, "extra_samples").pixels) extras += value > 0.0F ? 1.0 : 0.0;
  EXPECT_EQ(extras, counter(frame, "extra_samples"));
}

TEST(MultiresShadows, ScenesWithoutLightOrSurfaces) {
  SceneBuilder empty;
  empty.set_environment(glm::vec3(0.25F));
  for (const float value : picture_of(empty.scene, "multires-shadows", {}, 20).radiance.pixels) {
    EXPECT_NEAR(value, 0.25F, 1e-6F);
  }
  SceneBuilder dark;
  dark.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, dark.add_material(lambert(glm::vec3(1.0F))));
  dark.look({0, 3, 0}, {0, 0, 0}, 30.0F);
  const Frame frame = picture_of(dark.scene, "multires-shadows", {}, 20);
  for (const float value : frame.radiance.pixels) EXPECT_EQ(value, 0.0F);
  EXPECT_EQ(counter(frame, "shadow_rays"), 0.0);
}

TEST(MultiresShadows, SaysWhatItCannotDo) {
  EXPECT_EQ(tests::input_error_of(
                [] { picture_of(still_life(), "multires-shadows", {"rays_per_quadrant=24"}); }),
            "multires-shadows: rays_per_quadrant is 24; accepted: powers of two");
}

}  // namespace
}  // namespace renderers::test
