#include "renderers/final_gather/view_perception.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include <glm/vec4.hpp>

#include "perception/base/parallel.h"
#include "perception/contrast_sensitivity.h"
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

/// Octaves around the best seen frequency, from what a large cell of the grid does to what pixels
/// can show. @param best  index of the best seen one
std::vector<double> artefact_frequencies_cpd(double best_cpd, double pixels_per_degree,
                                             std::size_t& best) {
  constexpr int kOctavesBelow = 3;
  std::vector<double> frequencies;
  best = kOctavesBelow;
  for (int octave = -kOctavesBelow; octave <= 0; ++octave) {
    frequencies.push_back(std::ldexp(best_cpd, octave));
  }
  const double nyquist_cpd = 0.5 * pixels_per_degree;
  while (2.0 * frequencies.back() <= nyquist_cpd) frequencies.push_back(2.0 * frequencies.back());
  return frequencies;
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
  perception::ThresholdSettings model = perception::threshold_profile(settings.profile);
  const perception::MaskingSettings& masking = model.masking;
  const double best_cpd =
      perception::csf_peak(perception::find_csf(masking.csf), masking.csf_luminance_cd_m2)
          .frequency_cpd;
  frequencies_cpd_ = {best_cpd};
  if (settings.masked_by == MaskedBy::matched) {
    frequencies_cpd_ = artefact_frequencies_cpd(best_cpd, settings.pixels_per_degree, edge_);
    for (const double frequency : frequencies_cpd_) {
      model.targets.push_back({frequency, std::nullopt});
    }
  }
  thresholds_ = perception::threshold_map(preview_, viewing, model);
}

double ViewPerception::world_cd_m2(std::size_t pixel) const {
  return static_cast<double>(world_.pixels[pixel]);
}

double ViewPerception::tvi_cd_m2(std::size_t pixel) const {
  return settings_.threshold_scale * static_cast<double>(thresholds_.tvi_cd_m2.pixels[pixel]);
}

const perception::Image& ViewPerception::elevation_map() const {
  return thresholds_.targets.empty() ? thresholds_.elevation : thresholds_.targets[edge_].elevation;
}

double ViewPerception::elevation(std::size_t pixel) const {
  return static_cast<double>(elevation_map().pixels[pixel]);
}

double ViewPerception::unmasked_elevation(std::size_t frequency) const {
  return thresholds_.targets.empty() ? 1.0 : thresholds_.targets[frequency].unmasked;
}

double ViewPerception::threshold_cd_m2(std::size_t pixel, std::size_t frequency) const {
  if (!settings_.has_masking) return tvi_cd_m2(pixel) * unmasked_elevation(frequency);
  const perception::Image& map = thresholds_.targets.empty()
                                     ? thresholds_.elevation
                                     : thresholds_.targets[frequency].elevation;
  return tvi_cd_m2(pixel) * static_cast<double>(map.pixels[pixel]);
}

double ViewPerception::base_threshold_cd_m2(std::size_t pixel) const {
  return tvi_cd_m2(pixel) * unmasked_elevation(edge_);
}

double ViewPerception::at_frequency(std::span<const double> thresholds,
                                    double frequency_cpd) const {
  const double place = std::log2(frequency_cpd / frequencies_cpd_.front());
  const auto last = static_cast<double>(thresholds.size() - 1);
  if (!(place > 0.0)) return thresholds.front();
  if (place >= last) return thresholds.back();
  const auto low = static_cast<std::size_t>(place);
  return std::lerp(thresholds[low], thresholds[low + 1], place - static_cast<double>(low));
}

double ViewPerception::shown_change_cd_m2(double world_cd_m2, double change_cd_m2) const {
  return (*curve_)(world_cd_m2 + change_cd_m2) - (*curve_)(world_cd_m2);
}

double hidden_steps(const ViewPerception& view, std::span<const double> thresholds,
                    double change_cd_m2, double width_deg) {
  const double edge_cpd = view.edge_frequency_cpd();
  const double least = *std::ranges::min_element(thresholds.subspan(view.edge()));
  const auto are_hidden = [&](double steps) {
    const double frequency_cpd = width_deg > 0.0 ? std::max(edge_cpd, steps / width_deg) : edge_cpd;
    return change_cd_m2 <= steps * view.at_frequency(thresholds, frequency_cpd);
  };
  // More steps are lower and finer; so many are hidden whatever their frequency.
  double enough = change_cd_m2 / least;
  if (thresholds.size() == 1) return enough;
  double too_few = 0.0;
  constexpr int kHalvings = 20;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (too_few + enough);
    (are_hidden(middle) ? enough : too_few) = middle;
  }
  return enough;
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
