#include "renderers/final_gather/gather_picture.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::final_gather {

namespace {

using perception::Image;

constexpr std::size_t kPixelGrain = 64;

/// Sums over the camera rays of a pixel.
struct PixelSum {
  glm::vec3 radiance{0.0F};
  glm::vec3 irradiance{0.0F};
  double visibility_rays = 0.0;
  double form_factor_samples = 0.0;
  double senders = 0.0;
  glm::dvec3 resampled{0.0};
  std::uint64_t rays = 0;
};

void add_ray(const GatherScene& scene, const PointGather& gather, const ray_tracing::Ray& ray,
             std::uint64_t number, PixelSum& sum) {
  ray_tracing::Hit hit;
  ++sum.rays;
  if (!scene.rays.intersect(ray, hit)) {
    sum.radiance += scene.surface.environment(ray.direction);
    return;
  }
  ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::random, number, 0);
  const auto light = scene.surface.all(hit, -ray.direction, numbers.next());
  sum.rays += light.rays;
  sum.radiance += light.direct + light.indirect;
  const glm::vec3 albedo = ray_tracing::diffuse_albedo(scene.rays.scene(), hit);
  if (scene.solution == nullptr || albedo == glm::vec3(0.0F)) return;
  const std::uint32_t leaf = scene.solution->tree->leaf_at(hit, -ray.direction);
  if (leaf == element_hierarchy::kNoElement) return;
  const float side = glm::dot(hit.geometric_normal, ray.direction) < 0.0F ? 1.0F : -1.0F;
  const Receiver receiver{hit, side * hit.shading_normal, number};
  const GatheredLight gathered = gather(receiver, leaf);
  const glm::vec3 irradiance = gathered.irradiance + scene.environment.at(receiver, sum.rays);
  sum.radiance += albedo / ray_tracing::kPi * irradiance;
  sum.irradiance += irradiance;
  sum.visibility_rays += gathered.visibility_rays;
  sum.form_factor_samples += gathered.form_factor_samples;
  sum.senders += gathered.senders;
  sum.resampled += gathered.resampled;
}

void put(const glm::vec3& color, std::size_t pixel, Image& image) {
  std::copy_n(&color.x, 3, image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
}

Image gray(const RenderJob& job) {
  return perception::make_gray_image(job.width_px, job.height_px, "Y",
                                     perception::Encoding::scene_linear);
}

}  // namespace

EnvironmentGather::EnvironmentGather(const ray_tracing::RayScene& rays, int samples,
                                     const TransferSettings& settings)
    : rays_(rays), samples_(samples), settings_(settings) {
  if (!rays.scene().environment) return;
  sampler_ = std::make_unique<ray_tracing::EnvironmentSampler>(*rays.scene().environment);
  if (sampler_->power() <= 0.0) sampler_.reset();
}

glm::vec3 EnvironmentGather::at(const Receiver& receiver, std::uint64_t& cast) const {
  glm::vec3 sum(0.0F);
  if (!sampler_) return sum;
  std::uint64_t key = ray_tracing::hash_combine(settings_.points.seed, 0xe0);
  if (settings_.reuse == Reuse::per_pixel) {
    key = ray_tracing::hash_combine(key, receiver.ray_number);
  }
  for (int i = 0; i < samples_; ++i) {
    const auto drawn = sampler_->sample(
        sender_position(settings_.points.positions, key, static_cast<std::uint32_t>(i)));
    const float cosine = glm::dot(drawn.direction, receiver.normal);
    if (drawn.pdf <= 0.0F || cosine <= 0.0F) continue;
    ++cast;
    if (rays_.is_occluded(ray_from(receiver.point, drawn.direction))) continue;
    sum += scene::sample_environment(*rays_.scene().environment, drawn.direction) *
           (cosine / drawn.pdf);
  }
  return sum / static_cast<float>(samples_);
}

GatherPicture gather_picture(const GatherScene& scene, const CameraSamples& samples,
                             const RenderJob& job, const PointGather& gather) {
  GatherPicture picture;
  picture.radiance =
      perception::make_rgb_image(job.width_px, job.height_px, perception::Encoding::scene_linear);
  picture.irradiance = picture.radiance;
  picture.visibility_samples = gray(job);
  picture.form_factor_samples = gray(job);
  picture.resampled = gray(job);
  picture.classes =
      perception::make_rgb_image(job.width_px, job.height_px, perception::Encoding::scene_linear);
  picture.camera_rays = gray(job);
  std::vector<PixelSum> sums(samples.pixel_count());
  base::parallel_for(sums.size(), kPixelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      for (int i = 0; i < samples.count(pixel); ++i) {
        add_ray(scene, gather, samples.ray(pixel, i), samples.number(pixel, i), sums[pixel]);
      }
    }
  });
  for (std::size_t pixel = 0; pixel < sums.size(); ++pixel) {
    const PixelSum& sum = sums[pixel];
    const auto count = static_cast<float>(samples.count(pixel));
    put(sum.radiance / count, pixel, picture.radiance);
    put(sum.irradiance / count, pixel, picture.irradiance);
    picture.visibility_samples.pixels[pixel] = static_cast<float>(sum.visibility_rays) / count;
    picture.form_factor_samples.pixels[pixel] = static_cast<float>(sum.form_factor_samples) / count;
    const glm::vec3 shares(sum.senders > 0.0 ? sum.resampled / sum.senders : glm::dvec3(0.0));
    put(shares, pixel, picture.classes);
    picture.resampled.pixels[pixel] = shares.x + shares.y + shares.z;
    picture.camera_rays.pixels[pixel] = count;
    picture.visibility_rays += sum.visibility_rays;
    picture.form_factor_evaluations += sum.form_factor_samples;
    picture.other_rays += sum.rays;
  }
  return picture;
}

}  // namespace renderers::final_gather
