#include "renderers/final_gather/view_perception.h"

#include <atomic>
#include <utility>

#include <glm/vec4.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::final_gather {

namespace {

/// A picture that is black everywhere leaves no histogram to adjust.
bool has_light(const perception::Image& image) {
  for (const float value : image.pixels) {
    if (value > 1e-4F) return true;
  }
  return false;
}

}  // namespace

ViewPerception::ViewPerception(perception::Image world_cd_m2, const PerceptionSettings& settings)
    : settings_(settings), world_(std::move(world_cd_m2)) {
  perception::ViewingConditions viewing = perception::default_viewing_conditions();
  viewing.pixels_per_degree = settings.pixels_per_degree;
  viewing.peak_cd_m2 = settings.peak_cd_m2;
  const bool is_adjusted = settings.tone == ToneOperator::histogram && has_light(world_);
  curve_ = std::make_unique<perception::ToneCurve>(
      is_adjusted ? perception::histogram_adjustment(world_, viewing)
                  : perception::linear_tone_curve(perception::display_range(viewing), 1.0));
  preview_ = perception::tone_mapped(world_, *curve_);
  thresholds_ =
      perception::threshold_map(preview_, viewing, perception::threshold_profile(settings.profile));
}

double ViewPerception::world_cd_m2(std::size_t pixel) const {
  return static_cast<double>(world_.pixels[pixel]);
}

double ViewPerception::threshold_cd_m2(std::size_t pixel) const {
  const perception::Image& map =
      settings_.has_masking ? thresholds_.threshold_cd_m2 : thresholds_.tvi_cd_m2;
  return settings_.threshold_scale * static_cast<double>(map.pixels[pixel]);
}

double ViewPerception::base_threshold_cd_m2(std::size_t pixel) const {
  return settings_.threshold_scale * static_cast<double>(thresholds_.tvi_cd_m2.pixels[pixel]);
}

double ViewPerception::elevation(std::size_t pixel) const {
  return static_cast<double>(thresholds_.elevation.pixels[pixel]);
}

double ViewPerception::shown_change_cd_m2(double world_cd_m2, double change_cd_m2) const {
  return (*curve_)(world_cd_m2 + change_cd_m2) - (*curve_)(world_cd_m2);
}

perception::Image preview_luminance(const ray_tracing::RayScene& rays,
                                    const element_hierarchy::ShownLight& shown,
                                    const RenderJob& job, std::uint64_t& cast) {
  const ray_tracing::CameraRays camera(job.camera, job.width_px, job.height_px);
  const element_hierarchy::CameraSurface surface(rays, &shown);
  perception::Image image = perception::make_gray_image(job.width_px, job.height_px, "Y",
                                                        perception::Encoding::luminance_cd_m2);
  const auto scale = static_cast<float>(rays.scene().luminance_scale_cd_m2);
  const auto width = static_cast<std::size_t>(job.width_px);
  std::atomic<std::uint64_t> count = 0;
  const auto look = [&](std::size_t pixel) {
    const ray_tracing::Ray ray = camera.through(static_cast<float>(pixel % width) + 0.5F,
                                                static_cast<float>(pixel / width) + 0.5F);
    ray_tracing::Hit hit;
    count.fetch_add(1, std::memory_order_relaxed);
    if (!rays.intersect(ray, hit)) return surface.environment(ray.direction);
    ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::random, pixel, 0);
    const auto light = surface.all(hit, -ray.direction, numbers.next());
    count.fetch_add(light.rays, std::memory_order_relaxed);
    const auto irradiance = shown.at(hit, -ray.direction);
    return light.direct + light.indirect +
           ray_tracing::diffuse_albedo(rays.scene(), hit) / ray_tracing::kPi *
               (irradiance.direct + irradiance.indirect);
  };
  base::parallel_for(image.pixel_count(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      image.pixels[pixel] = scale * ray_tracing::luminance(look(pixel));
    }
  });
  cast += count;
  return image;
}

}  // namespace renderers::final_gather
