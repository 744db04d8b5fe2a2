#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "renderers/many_lights/bias_compensation.h"
#include "renderers/many_lights/ray_gather.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "tests/renderers/many_lights/ray_cast_inputs.h"
#include "tests/renderers/scene_builder.h"

/// Virtual lights by ray casting, gathered with shadow rays, against the path tracer's one bounce.
namespace renderers::many_lights {
namespace {

using ray_tracing::CameraRays;
using ray_tracing::Hit;
using ray_tracing::LightSampler;
using ray_tracing::RayScene;
using test::SceneBuilder;

constexpr int kSide_px = 32;
constexpr float kClamp = 2.0F;  // 1/m2

scene::Light spot() {
  scene::Light light;
  light.type = scene::LightType::spot;
  light.position = {0.8F, 0.9F, -0.8F};
  light.intensity = {12, 11, 10};
  light.direction = glm::normalize(glm::vec3(-1, -0.7F, 1.1F));
  light.inner_cone_rad = 0.6F;
  light.outer_cone_rad = 0.8F;
  return light;
}

scene::Light point() {
  scene::Light light;
  light.position = {0.5F, 0.3F, -0.5F};
  light.intensity = {3, 3, 4};
  return light;
}

/// A room with a block, open towards the camera.
SceneBuilder room_with(const scene::Light& light) {
  SceneBuilder builder;
  const int white = builder.add_material(test::lambert(glm::vec3(0.75F)));
  const int red = builder.add_material(test::lambert({0.6F, 0.1F, 0.1F}));
  builder.add_quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, white);
  builder.add_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);
  builder.add_quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white);
  builder.add_quad({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, red);
  builder.add_box({-0.3F, -1, 0.1F}, {0.3F, -0.2F, 0.6F}, white, false);
  builder.scene.lights.push_back(light);
  builder.look({0.2F, 0.1F, -3}, {-0.25F, -0.5F, 0.3F}, 16.0F);
  return builder;
}

/// True for pixels whose corners and centre lie on one flat surface: the path tracer averages over
/// the pixel, the gather has one receiver in its middle.
std::vector<bool> flat_pixels(const RayScene& rays) {
  const CameraRays camera(rays.scene().camera, kSide_px, kSide_px);
  std::vector<bool> flat;
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 0; x < kSide_px; ++x) {
      Hit center;
      const auto through = [&](float dx, float dy) {
        return camera.through(static_cast<float>(x) + dx, static_cast<float>(y) + dy);
      };
      bool is_flat = rays.intersect(through(0.5F, 0.5F), center);
      for (const glm::vec2& corner :
           {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(1, 1)}) {
        Hit hit;
        is_flat = is_flat && rays.intersect(through(corner.x, corner.y), hit) &&
                  hit.object == center.object;
      }
      flat.push_back(is_flat);
    }
  }
  return flat;
}

/// Radiance and its variance over the flat pixels, three channels each.
struct Reference {
  std::vector<double> value;
  std::vector<double> variance;

  double mean() const {
    double sum = 0.0;
    for (const double v : value) sum += v;
    return sum / static_cast<double>(value.size());
  }
  /// Standard error of the mean, relative.
  double precision() const {
    double sum = 0.0;
    for (const double v : variance) sum += v;
    return std::sqrt(sum) / static_cast<double>(value.size()) / mean();
  }
  /// Root mean square of the pixels' noise, relative to the mean.
  double noise() const {
    double sum = 0.0;
    for (const double v : variance) sum += v;
    return std::sqrt(sum / static_cast<double>(variance.size())) / mean();
  }
};

Reference reference_of(const scene::Scene& scene, const std::vector<bool>& flat, float clamp) {
  const Frame frame = test::render(scene, {.settings = {"transport=one_bounce", "part=indirect",
                                                        "geometry_clamp=" + std::to_string(clamp)},
                                           .width_px = kSide_px,
                                           .height_px = kSide_px,
                                           .samples = 1024});
  Reference reference;
  for (std::size_t i = 0; i < frame.radiance.pixels.size(); ++i) {
    if (!flat[i / 3]) continue;
    reference.value.push_back(static_cast<double>(frame.radiance.pixels[i]));
    reference.variance.push_back(static_cast<double>(test::aov(frame, "variance").pixels[i]));
  }
  return reference;
}

/// Radiance over the flat pixels from the gather's irradiance.
std::vector<double> radiance_of(const GatheredLight& light, const SurfaceImage& surfaces,
                                const std::vector<bool>& flat) {
  std::vector<double> radiance;
  for (std::size_t i = 0; i < flat.size(); ++i) {
    if (!flat[i]) continue;
    const glm::vec4 reflected = light.irradiance[i] * surfaces.albedo[i] / 3.14159265F;
    for (int c = 0; c < 3; ++c) radiance.push_back(static_cast<double>(reflected[c]));
  }
  return radiance;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Root mean square difference relative to the mean, the reference's noise taken off.
double relative_error(const std::vector<double>& made, const Reference& reference) {
  double sum = 0.0;
  for (std::size_t i = 0; i < made.size(); ++i) {
    const double delta = made[i] - reference.value[i];
    sum += delta * delta - reference.variance[i];
  }
  return std::sqrt(std::max(0.0, sum / static_cast<double>(made.size()))) / reference.mean();
}

/// Slope of the least-squares line through (log n, log error).
double log_slope(const std::vector<int>& counts, const std::vector<double>& errors) {
  const auto n = static_cast<double>(counts.size());
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double log_count = std::log(counts[i]);
    const double log_error = std::log(errors[i]);
    x += log_count / n;
    y += log_error / n;
    xx += log_count * log_count / n;
    xy += log_count * log_error / n;
  }
  return (xy - x * y) / (xx - x * x);
}

struct Room {
  explicit Room(const scene::Light& light) : builder(room_with(light)) {}

  SceneBuilder builder;
  StageTimer timer;
  RayScene rays{builder.scene, timer};
  SurfaceImage surfaces = test::cast_surfaces(rays, kSide_px, kSide_px);
  std::vector<bool> flat = flat_pixels(rays);

  std::vector<double> gather(int count, float clamp, bool has_visibility = true) const {
    const auto lights = test::cast_lights(rays, builder.scene.lights[0], count);
    const GatheredLight light = gather_by_rays({.scene = builder.scene,
                                                .surfaces = surfaces,
                                                .lights = lights,
                                                .rays = has_visibility ? &rays : nullptr},
                                               {.interleave = 1, .geometry_clamp = clamp});
    return radiance_of(light, surfaces, flat);
  }
};

void expect_convergence(const scene::Light& light) {
  const Room room(light);
  const Reference reference = reference_of(room.builder.scene, room.flat, kClamp);
  std::vector<int> counts;
  std::vector<double> errors;
  for (const int count : {64, 256, 1024, 4096, 16384}) {
    const std::vector<double> made = room.gather(count, kClamp);
    const double error = relative_error(made, reference);
    if (error < 0.25 * reference.noise()) break;
    counts.push_back(count);
    errors.push_back(error);
  }
  ASSERT_GE(counts.size(), 3U);
  const double slope = log_slope(counts, errors);
  EXPECT_LT(slope, -0.5);
  EXPECT_GT(slope, -1.0);
  EXPECT_LT(errors.back(), 0.02);
  EXPECT_GT(relative_error(room.gather(4096, kClamp, false), reference), 0.1)
      << "missing shadows must show";
  EXPECT_GT(relative_error(room.gather(4096, 0.5F), reference), 0.03) << "another clamp must show";
}

TEST(OneBounce, SpotLightsConvergeToTheClampedPathTracer) { expect_convergence(spot()); }

TEST(OneBounce, PointLightsConvergeToTheClampedPathTracer) { expect_convergence(point()); }

TEST(OneBounce, ClampedLightPlusCompensationIsTheUnclampedPathTracer) {
  const Room room(spot());
  const Reference reference = reference_of(room.builder.scene, room.flat, 0.0F);
  ASSERT_LT(reference.precision(), 0.003);
  std::vector<double> made = room.gather(4096, kClamp);
  const double clamped = mean_of(made);
  const CompensatedLight compensated =
      compensate_bias(room.rays, LightSampler(room.rays), room.surfaces,
                      {.geometry_clamp = kClamp,
                       .rays = 256,
                       .camera_position = room.builder.scene.camera.position});
  double added = 0.0;
  for (std::size_t i = 0; i < room.flat.size(); ++i) {
    if (!room.flat[i]) continue;
    for (int c = 0; c < 3; ++c) added += static_cast<double>(compensated.radiance[i][c]);
  }
  added /= static_cast<double>(made.size());
  EXPECT_NEAR((clamped + added) / reference.mean(), 1.0, 0.01);
  EXPECT_LT(clamped / reference.mean(), 0.97) << "the clamp must take something";
}

}  // namespace
}  // namespace renderers::many_lights
