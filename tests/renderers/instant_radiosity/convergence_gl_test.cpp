#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/renderers/instant_radiosity/box_scenes.h"
#include "tests/renderers/scene_builder.h"

/// Virtual lights against the path tracer with the same claims (one bounce, the same bound of the
/// geometry term): the two share nothing but the scene and the definition.
namespace renderers::test {
namespace {

/// Mean of squares of (a - b) over all values less the expected noise of b, and the mean of b.
struct Difference {
  double mean_square = 0.0;
  double noise_square = 0.0;  ///< mean variance of the truth
  double mean_truth = 0.0;
  double mean_test = 0.0;

  /// sqrt(mse - noise) / mean; 0 if the noise explains the difference.
  double relative_rmse() const {
    return std::sqrt(std::max(0.0, mean_square - noise_square)) / mean_truth;
  }
  double relative_bias() const { return mean_test / mean_truth - 1.0; }
};

Difference difference_of(const Frame& test, const Frame& truth) {
  const std::vector<float>& a = test.radiance.pixels;
  const std::vector<float>& b = truth.radiance.pixels;
  const std::vector<float>& variance = aov(truth, "variance").pixels;
  const std::vector<bool> is_used = is_flat_pixel(truth);
  Difference difference;
  double count = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!is_used[i / 3]) continue;
    const double error = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    difference.mean_square += error * error;
    difference.noise_square += static_cast<double>(variance[i]);
    difference.mean_truth += static_cast<double>(b[i]);
    difference.mean_test += static_cast<double>(a[i]);
    count += 1.0;
  }
  EXPECT_GT(count, 0.5 * static_cast<double>(a.size())) << "too few pixels show one surface";
  difference.mean_square /= count;
  difference.noise_square /= count;
  difference.mean_truth /= count;
  difference.mean_test /= count;
  return difference;
}

/// Slope of the line of least squares through log errors over log numbers of lights, each number
/// four times the one before.
double loglog_slope(const std::vector<double>& errors) {
  const double middle = 0.5 * static_cast<double>(errors.size() - 1);
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double x = std::log(4.0) * (static_cast<double>(i) - middle);
    products += x * std::log(errors[i]);
    squares += x * x;
  }
  return products / squares;
}

constexpr int kSide_px = 24;

Frame truth_of(const scene::Scene& scene, const std::string& clamp) {
  RenderRequest request;
  request.renderer = "path";
  request.settings = {"transport=one_bounce", "part=indirect", "geometry_clamp=" + clamp};
  request.width_px = request.height_px = kSide_px;
  request.samples = 1024;
  return render(scene, request);
}

Frame lights_of(const scene::Scene& scene, std::vector<std::string> settings, int sets = 1,
                int side_px = kSide_px) {
  RenderRequest request;
  request.renderer = "instant-radiosity";
  request.settings = std::move(settings);
  request.settings.emplace_back("part=indirect");
  const auto set_unless_given = [&](const std::string& name, const char* value) {
    const bool is_given = std::ranges::any_of(
        request.settings, [&](const std::string& text) { return text.starts_with(name + "="); });
    if (!is_given) request.settings.push_back(name + "=" + value);
  };
  set_unless_given("interleave", "1");
  set_unless_given("visibility", "ray");
  request.width_px = request.height_px = side_px;
  request.samples = sets;
  return render(scene, request);
}

TEST(InstantRadiosityConvergence, FallsToTheNoiseFloorOfThePathTracerUnderTheSameClamp) {
  const scene::Scene scene = spot_in_box();
  const Frame truth = truth_of(scene, "10");
  std::vector<double> errors;
  for (const char* lights : {"64", "256", "1024", "4096"}) {
    const Frame frame = lights_of(scene, {"geometry_clamp=10", std::string("vpls=") + lights});
    errors.push_back(difference_of(frame, truth).relative_rmse());
    RecordProperty(std::string("relative_rmse_") + lights, std::to_string(errors.back()));
  }
  EXPECT_LT(errors[1], 0.7 * errors[0]);
  EXPECT_LT(errors[2], 0.7 * errors[1]);
  EXPECT_LT(errors[3], 0.02);
  // Independent lights would have -1/2, evenly spread ones before smooth light -1; found: -0.72.
  EXPECT_LT(loglog_slope(errors), -0.5);
  EXPECT_GT(loglog_slope(errors), -1.0);
  const Frame many = lights_of(scene, {"geometry_clamp=10", "vpls=4096"}, 8);
  const Difference last = difference_of(many, truth);
  EXPECT_LT(last.relative_rmse(), 0.01);
  EXPECT_NEAR(last.relative_bias(), 0.0, 0.003);
}

TEST(InstantRadiosityConvergence, ABoundOfItsOwnWouldEndTheFall) {
  // What keeps a bias flattens: the truth without the lights' bound.
  const scene::Scene scene = spot_in_box();
  const Frame truth = truth_of(scene, "0");
  std::vector<double> errors;
  for (const char* lights : {"64", "256", "1024", "4096"}) {
    const Frame frame = lights_of(scene, {"geometry_clamp=1", std::string("vpls=") + lights});
    errors.push_back(difference_of(frame, truth).relative_rmse());
  }
  EXPECT_GT(loglog_slope(errors), -0.4);
}

TEST(InstantRadiosityConvergence, ADoubledClampWouldBeSeen) {
  const scene::Scene scene = spot_in_box();
  const Frame truth = truth_of(scene, "2");
  const Frame frame = lights_of(scene, {"geometry_clamp=4", "vpls=4096"}, 2);
  EXPECT_GT(difference_of(frame, truth).relative_bias(), 0.01);
}

TEST(InstantRadiosityConvergence, CompensationBringsBackWhatTheClampTakes) {
  const scene::Scene scene = spot_in_box();
  const Frame truth = truth_of(scene, "0");
  const Frame clamped = lights_of(scene, {"geometry_clamp=1", "vpls=4096"}, 4);
  const Frame whole =
      lights_of(scene, {"geometry_clamp=1", "vpls=4096", "compensation_rays=64"}, 4);
  EXPECT_LT(difference_of(clamped, truth).relative_bias(), -0.03);
  EXPECT_NEAR(difference_of(whole, truth).relative_bias(), 0.0, 0.01);
}

TEST(InstantRadiosityConvergence, EveryKindOfLightGivesWhatThePathTracerGives) {
  for (const auto& [name, scene] : boxes_by_light()) {
    const Frame truth = truth_of(scene, "10");
    // Of the environment's light only what enters the open side makes useful virtual lights.
    const char* lights = scene.environment ? "vpls=16384" : "vpls=4096";
    const Frame frame = lights_of(
        scene, {"geometry_clamp=10", lights, "area_light_maps=64", "environment_maps=512"}, 4);
    const Difference difference = difference_of(frame, truth);
    EXPECT_NEAR(difference.relative_bias(), 0.0, 0.01) << name;
    EXPECT_LT(difference.relative_rmse(), 0.04) << name;
  }
}

TEST(InstantRadiosityConvergence, GlossyReceiversReflectAsThePathTracerSays) {
  const scene::Scene scene = glossy_box();
  const Frame truth = truth_of(scene, "10");
  const Frame frame = lights_of(scene, {"geometry_clamp=10", "vpls=4096"}, 4);
  const Difference difference = difference_of(frame, truth);
  EXPECT_NEAR(difference.relative_bias(), 0.0, 0.01);
  EXPECT_LT(difference.relative_rmse(), 0.06);
}

TEST(InstantRadiosityConvergence, ShadowMapsComeNearToRays) {
  const scene::Scene scene = spot_in_box();
  const Frame rays = lights_of(scene, {"geometry_clamp=10"});
  const Frame none = lights_of(scene, {"geometry_clamp=10", "visibility=none"});
  const Frame maps = lights_of(scene, {"geometry_clamp=10", "visibility=shadow_map"});
  const Frame points = lights_of(scene, {"geometry_clamp=10", "visibility=imperfect",
                                         "shadow_map_px=64", "imperfect_points=4096"});
  const double none_error = relative_rms(none, rays);
  EXPECT_GT(none_error, 0.05) << "the scene has no shadows to be tested by";
  EXPECT_LT(relative_rms(maps, rays), 0.2 * none_error);
  EXPECT_LT(relative_rms(points, rays), 0.6 * none_error);
  EXPECT_EQ(counter(maps, "shadow_maps"), 1024.0);
  EXPECT_GT(counter(rays, "visibility_rays"), counter(rays, "occluded_rays"));
}

TEST(InstantRadiosityConvergence, InterleavingWithBlurKeepsTheMeanAndTheShape) {
  const scene::Scene scene = spot_in_box();
  const auto picture = [&](const char* interleave, const char* blur) {
    return lights_of(scene, {"geometry_clamp=10", "visibility=none", interleave, blur}, 1, 128);
  };
  const Frame full = picture("interleave=1", "blur=none");
  const double noisy = relative_rms(picture("interleave=8", "blur=none"), full);
  for (const char* blur : {"blur=box", "blur=separable", "blur=centred"}) {
    const Frame shared = picture("interleave=8", blur);
    EXPECT_NEAR(mean_radiance(shared) / mean_radiance(full), 1.0, 0.01) << blur;
    EXPECT_LT(relative_rms(shared, full), 0.5 * noisy) << blur;
  }
}

}  // namespace
}  // namespace renderers::test
