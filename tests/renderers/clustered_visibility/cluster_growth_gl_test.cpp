#include "renderers/clustered_visibility/cluster_growth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "tests/expect_error.h"
#include "tests/renderers/instant_radiosity/box_scenes.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::test {
namespace {

using clustered_visibility::visible_share;
using perception::Image;

Image grey(float radiance) {
  Image image = perception::make_rgb_image(16, 12, perception::Encoding::scene_linear);
  std::ranges::fill(image.pixels, radiance);
  return image;
}

TEST(VisibleShare, IsThatOfPixelsThatDifferByMoreThanTheirThreshold) {
  const perception::ViewingConditions viewing = perception::default_viewing_conditions();
  const Image image = grey(0.3F);
  EXPECT_EQ(visible_share(image, image, viewing, 400), 0.0);
  EXPECT_EQ(visible_share(image, grey(0.3003F), viewing, 400), 0.0) << "a thousandth";
  EXPECT_EQ(visible_share(image, grey(0.45F), viewing, 400), 1.0) << "half as much again";
  Image corner = image;
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      for (int c = 0; c < 3; ++c) corner.pixels[static_cast<std::size_t>((y * 16 + x) * 3 + c)] = 3;
    }
  }
  EXPECT_NEAR(visible_share(image, corner, viewing, 400), 12.0 / 192.0, 6.0 / 192.0);
}

/// Pictures of few light maps. @param more  further settings
Frame picture(const scene::Scene& scene, std::vector<std::string> more) {
  RenderRequest request;
  request.renderer = "clustered-visibility";
  request.settings = {"light_map_px=64", "area_light_map_px=32", "shadow_map_px=32",
                      "vpls=256",        "part=indirect",        "visibility=hard"};
  for (std::string& setting : more) request.settings.push_back(std::move(setting));
  request.width_px = request.height_px = 32;
  request.samples = 0;
  return render(scene, request);
}

std::vector<double> series(const Frame& frame, const std::string& name) {
  for (const auto& [each, value] : frame.counters) {
    if (each == name) return std::get<std::vector<double>>(value);
  }
  return {};
}

TEST(ClusterGrowth, DoublesUntilThePreviewNoLongerChangesVisibly) {
  const Frame frame = picture(boxes_by_light()[1].second, {"adaptive=true", "vals=256"});
  const std::vector<double> tried = series(frame, "growth_vals");
  const std::vector<double> shares = series(frame, "growth_visible_share");
  ASSERT_FALSE(tried.empty());
  ASSERT_EQ(shares.size(), tried.size());
  for (std::size_t i = 0; i < tried.size(); ++i) {
    EXPECT_EQ(tried[i], 8.0 * static_cast<double>(1 << i));
    EXPECT_EQ(shares[i] <= 0.02, i + 1 == tried.size()) << "goes on while it changes, only then";
  }
  EXPECT_EQ(counter(frame, "shadow_maps"), tried.back());
  EXPECT_LT(tried.back(), 256.0);
  EXPECT_GT(tried.back(), 8.0);
}

TEST(ClusterGrowth, ThePictureIsThatOfTheNumberFound) {
  for (const char* start : {"cluster_start=prefix", "cluster_start=stride"}) {
    const Frame grown = picture(spot_in_box(), {"adaptive=true", "vals=100", start});
    const auto found = static_cast<int>(counter(grown, "shadow_maps"));
    EXPECT_LE(found, 100);
    const Frame fixed = picture(spot_in_box(), {"vals=" + std::to_string(found), start});
    EXPECT_EQ(grown.radiance.pixels, fixed.radiance.pixels) << start;
    EXPECT_GT(mean_radiance(grown), 0.0);
  }
}

TEST(ClusterGrowth, ToleranceDecidesAndValsIsTheMost) {
  const auto found = [](const char* tolerance, const char* vals) {
    return counter(picture(spot_in_box(), {"adaptive=true", tolerance, vals}), "shadow_maps");
  };
  EXPECT_EQ(found("adaptive_tolerance=1", "vals=100"), 8.0) << "twice the first number";
  EXPECT_EQ(found("adaptive_tolerance=0", "vals=11"), 11.0);
  EXPECT_EQ(found("adaptive_tolerance=0.02", "vals=3"), 3.0) << "fewer than the first number";
}

TEST(ClusterGrowth, DirectLightMasksWhatIndirectLightChanges) {
  const Frame alone = picture(boxes_by_light()[2].second, {"adaptive=true", "vals=256"});
  RenderRequest request;
  request.renderer = "clustered-visibility";
  request.settings = {"light_map_px=64", "area_light_map_px=32", "shadow_map_px=32", "vpls=256",
                      "visibility=hard", "adaptive=true",        "vals=256"};
  request.width_px = request.height_px = 32;
  request.samples = 0;
  const Frame all = render(boxes_by_light()[2].second, request);
  EXPECT_LE(counter(all, "shadow_maps"), counter(alone, "shadow_maps"));
}

TEST(ClusterGrowth, SeesTheLightThatTheSceneSaysItIs) {
  scene::Scene scene = boxes_by_light()[1].second;
  const double bright = counter(picture(scene, {"adaptive=true", "vals=256"}), "shadow_maps");
  scene.luminance_scale_cd_m2 = 1e-4;
  const Frame dark = picture(scene, {"adaptive=true", "vals=256"});
  EXPECT_EQ(counter(dark, "shadow_maps"), 8.0) << "below the display's black";
  EXPECT_GT(bright, 8.0);
}

TEST(ClusterGrowth, IsRefusedWithRaysAndWithWarmClusters) {
  tests::expect_error_with<base::InputError>(
      [] {
        picture(spot_in_box(), {"adaptive=true", "warm_start=true"});
      },
      {"adaptive is true with warm_start", "accepted: one of them"});
  RenderRequest request;
  request.renderer = "clustered-visibility";
  request.settings = {"adaptive=true", "visibility=oracle"};
  tests::expect_error_with<base::InputError>([&] { render(spot_in_box(), request); },
                                             {"adaptive is true with visibility oracle", "hard"});
}

TEST(ClusterGrowth, OfADarkSceneStopsAtOnce) {
  scene::Scene scene = spot_in_box();
  scene.lights.clear();
  const Frame frame = picture(scene, {"adaptive=true", "vals=64"});
  EXPECT_EQ(counter(frame, "shadow_maps"), 8.0);
  EXPECT_EQ(mean_radiance(frame), 0.0);
}

}  // namespace
}  // namespace renderers::test
