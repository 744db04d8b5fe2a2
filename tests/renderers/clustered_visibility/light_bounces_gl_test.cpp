#include "renderers/clustered_visibility/light_bounces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "renderers/scene/scene_file.h"
#include "tests/places.h"
#include "tests/renderers/instant_radiosity/box_scenes.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::test {
namespace {

std::vector<double> series(const Frame& frame, const std::string& name) {
  for (const auto& [key, value] : frame.counters) {
    if (key == name) return std::get<std::vector<double>>(value);
  }
  return {};
}

/// Small pictures of indirect light unless the settings say otherwise.
RenderRequest request_with(const std::vector<std::string>& settings) {
  RenderRequest request;
  request.renderer = "clustered-visibility";
  request.settings = settings;
  for (const std::string preset : {"light_map_px=64", "area_light_map_px=32", "shadow_map_px=32",
                                   "vpls=256", "part=indirect", "interleave=1"}) {
    const std::string name = preset.substr(0, preset.find('=') + 1);
    const bool is_given = std::ranges::any_of(
        settings, [&](const std::string& text) { return text.starts_with(name); });
    if (!is_given) request.settings.push_back(preset);
  }
  request.width_px = request.height_px = 24;
  request.samples = 0;
  return request;
}

Frame picture(const scene::Scene& scene, const std::vector<std::string>& more) {
  return render(scene, request_with(more));
}

std::vector<double> flux_of(const Frame& frame) { return series(frame, "bounce_flux_w"); }

/// Of every bounce, W; the picture is no more than a few pixels.
std::vector<double> fluxes(const scene::Scene& scene, const std::vector<std::string>& settings) {
  RenderRequest request = request_with(settings);
  request.width_px = request.height_px = 4;
  return flux_of(render(scene, request));
}

/// An empty closed box, 3 x 2 x 2.5 m, of one colour, with a point light in it.
scene::Scene empty_box(float albedo) {
  SceneBuilder builder;
  builder.add_box({0, 0, 0}, {3, 2, 2.5F}, builder.add_material(lambert(glm::vec3(albedo))), true);
  builder.add_point_light({1.2F, 1.1F, 1.4F}, glm::vec3(5.0F));
  builder.look({1.5F, 1.0F, 2.2F}, {1.5F, 0.9F, 0.0F}, 60.0F);
  return builder.scene;
}

TEST(LightBounces, AClosedBoxReflectsItsAlbedoOfTheFluxOfTheBounceBefore) {
  for (const float albedo : {0.3F, 0.8F}) {
    const std::vector<double> flux =
        fluxes(empty_box(albedo), {"bounces=4", "clamp_radius=0", "visibility=oracle"});
    ASSERT_EQ(flux.size(), 4U);
    EXPECT_NEAR(flux[0], 4.0 * 3.14159265358979 * 5.0 * albedo, 0.02 * flux[0]);
    for (std::size_t i = 1; i < flux.size(); ++i) {
      EXPECT_NEAR(flux[i] / flux[i - 1], albedo, 0.04 * albedo) << "bounce " << i + 1;
    }
  }
}

scene::Scene cornell_box_spot() {
  const std::filesystem::path scenes =
      std::filesystem::path(tests::kSourceFolder) / "suites/scenes";
  return scene::read_scene_file(scenes / "cornell-box-spot.yaml").at_frame(0);
}

/// `path` with what the renderer claims of several bounces.
Frame truth_of(const scene::Scene& scene) {
  const RenderRequest claimed = request_with({"bounces=2"});
  const RendererInfo& info = find_renderer(claimed.renderer, {});
  const Claims claims = info.claims(parameters_of(claimed.renderer, claimed.settings), scene);
  RenderRequest request;
  request.settings = {"transport=" + to_string(claims.transport), "part=" + to_string(claims.part),
                      "geometry_clamp=" + std::to_string(*claims.geometry_clamp)};
  request.width_px = request.height_px = 24;
  request.samples = 512;
  return render(scene, request);
}

/// relative_rms over pixels that show one surface, and the mean's excess.
struct Difference {
  double relative_rms = 0.0;
  double bias = 0.0;
};

Difference difference_of(const Frame& made, const Frame& truth) {
  const std::vector<bool> is_used = is_flat_pixel(truth);
  double squares = 0.0;
  double sum = 0.0;
  double mean = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < truth.radiance.pixels.size(); ++i) {
    if (!is_used[i / 3]) continue;
    const double value = double{truth.radiance.pixels[i]};
    const double error = double{made.radiance.pixels[i]} - value;
    squares += error * error;
    sum += error;
    mean += value;
    count += 1.0;
  }
  return {std::sqrt(squares / count) / (mean / count), sum / mean};
}

TEST(LightBounces, EachBringsThePictureNearerToThatOfAllDiffuseBounces) {
  const scene::Scene scene = cornell_box_spot();
  const Frame truth = truth_of(scene);
  for (const char* visibility : {"visibility=hard", "visibility=cssm"}) {
    double before = 1e9;
    for (const char* bounces : {"bounces=1", "bounces=2", "bounces=3"}) {
      const Difference difference = difference_of(picture(scene, {bounces, visibility}), truth);
      EXPECT_LT(difference.relative_rms, 0.7 * before) << visibility << " " << bounces;
      before = difference.relative_rms;
    }
  }
  // Eight are all but a thousandth; the bound between bounces, which `path` does not have, takes as
  // much.
  const Difference all = difference_of(picture(scene, {"bounces=8", "visibility=oracle"}), truth);
  EXPECT_NEAR(all.bias, 0.0, 0.01);
}

TEST(LightBounces, OneBounceIsThePictureWithoutTheParameterBitForBit) {
  const scene::Scene scene = spot_in_box();
  EXPECT_EQ(picture(scene, {"bounces=1"}).radiance.pixels, picture(scene, {}).radiance.pixels);
}

TEST(LightBounces, AreTheSameBytesAgainAndBlackWithoutLight) {
  for (const char* visibility : {"visibility=cssm", "visibility=oracle"}) {
    scene::Scene scene = spot_in_box();
    const Frame once = picture(scene, {"bounces=3", visibility});
    EXPECT_EQ(once.radiance.pixels, picture(scene, {"bounces=3", visibility}).radiance.pixels);
    EXPECT_GT(mean_radiance(once), mean_radiance(picture(scene, {visibility})));
    scene.lights.clear();
    const Frame dark = picture(scene, {"bounces=3", visibility});
    EXPECT_EQ(*std::ranges::max_element(dark.radiance.pixels), 0.0F);
    EXPECT_EQ(flux_of(dark), std::vector<double>(3, 0.0));
  }
}

TEST(LightBounces, ReceiveByOneTestWhateverThePicturesVisibility) {
  const scene::Scene scene = spot_in_box();
  const auto flux = [&](const char* visibility) {
    return fluxes(scene, {"bounces=3", "shadow_map_px=128", visibility});
  };
  const std::vector<double> hard = flux("visibility=hard");
  for (const char* visibility : {"visibility=cssm", "visibility=pcf"}) {
    EXPECT_EQ(flux(visibility), hard) << visibility;
  }
  const std::vector<double> rays = flux("visibility=oracle");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(hard[i], rays[i], 0.1 * rays[i]) << "bounce " << i + 1;
  }
}

TEST(LightBounces, UnitsDoNotMatter) {
  const std::vector<std::string> settings{"bounces=3", "vals=12"};
  const Frame metres = picture(spot_in_box(), settings);
  const Frame kilometres = picture(scaled(spot_in_box(), 1024.0F), settings);
  EXPECT_LT(relative_rms(kilometres, metres), 0.01);
  const std::vector<double> flux = flux_of(metres);
  for (std::size_t i = 0; i < flux.size(); ++i) {
    EXPECT_NEAR(flux_of(kilometres)[i] / flux[i], 1024.0 * 1024.0, 0.01 * 1024.0 * 1024.0);
  }
}

TEST(LightBounces, OfALaterFrameAreThoseOfAColdStart) {
  const RenderRequest request = request_with({"bounces=3", "interleave=4"});
  const auto kept = find_renderer(request.renderer, {})
                        .create(parameters_of(request.renderer, request.settings), {});
  StageTimer timer;
  kept->prepare(spot_in_box(), timer);
  const scene::Scene next = glossy_box();
  kept->update(next, timer);
  RenderJob job;
  job.width_px = request.width_px;
  job.height_px = request.height_px;
  job.camera = next.camera;
  EXPECT_EQ(kept->render(job, timer).radiance.pixels, render(next, request).radiance.pixels);
}

TEST(LightBounces, HaveStagesAndCountersOfTheirOwn) {
  StageTimer timer;
  const Frame frame = render(spot_in_box(), request_with({"bounces=2"}), &timer);
  for (const char* stage : {"lights/points", "lights/bounce_2/gather", "lights/bounce_2/emit",
                            "lights/bounce_2/cluster", "lights/bounce_2/shadow",
                            "lights/bounce_2/filter/basis", "gather/bounce_1", "gather/bounce_2"}) {
    EXPECT_GT(timer.wall_of(stage), 0.0) << stage;
  }
  const std::vector<double> lights = series(frame, "bounce_vpls");
  ASSERT_EQ(lights.size(), 2U);
  EXPECT_EQ(lights[0], counter(frame, "valid_vpls"));
  EXPECT_GT(lights[1], 0.5 * 256.0);
  EXPECT_LE(lights[1], 256.0);
}

TEST(LightBounces, BlackSurfacesSendNothingOn) {
  EXPECT_EQ(fluxes(empty_box(0.0F), {"bounces=2"}), std::vector<double>(2, 0.0));
}

TEST(LightBounces, GrowWithTheNumberOfClustersFound) {
  const Frame grown = picture(spot_in_box(), {"bounces=2", "adaptive=true", "vals=64"});
  const auto maps = static_cast<int>(counter(grown, "shadow_maps"));
  const Frame fixed = picture(spot_in_box(), {"bounces=2", "vals=" + std::to_string(maps / 2)});
  EXPECT_EQ(grown.radiance.pixels, fixed.radiance.pixels);
}

}  // namespace
}  // namespace renderers::test
