#include "renderers/indirect_view/indirect_view.h"

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/contract/sample_schedule.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/direct_light_pass.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::indirect_view {

namespace {

using perception::Image;
using ray_tracing::hash_combine;
using ray_tracing::Hit;
using ray_tracing::SampleSequence;
using ray_tracing::SequenceKind;

constexpr std::size_t kPixelGrain = 32;

Image black(const RenderJob& job) {
  return perception::make_rgb_image(job.width_px, job.height_px,
                                    perception::Encoding::scene_linear);
}

Image mean_image(const RenderJob& job, const std::vector<glm::vec3>& sums, std::int64_t samples) {
  Image image = black(job);
  const float weight = 1.0F / static_cast<float>(std::max<std::int64_t>(1, samples));
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const glm::vec3 color = weight * sums[i];
    std::copy_n(&color.x, 3, image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return image;
}

/// One image on its way: sums over the camera rays of every pixel.
class Rendering {
 public:
  Rendering(const View& view, const RenderJob& job);
  void add_samples(const SampleRange& range, StageTimer& timer);
  Image radiance(std::int64_t samples) const;
  Frame finish(std::int64_t samples) const;

 private:
  void add_direct(const SampleRange& range);
  void add_indirect(const SampleRange& range);
  void add_sample(std::size_t pixel, std::int64_t sample, std::uint64_t& gathered);
  glm::vec3 glossy(const ViewedPoint& point, const glm::vec3& to_viewer, const glm::vec4& u,
                   std::uint64_t& gathered) const;

  const View& view_;
  const RenderJob& job_;
  std::uint64_t seed_;
  ray_tracing::CameraRays camera_;
  ray_tracing::DirectLightPass direct_pass_;
  std::vector<glm::vec3> direct_;
  std::vector<glm::vec3> indirect_;
  std::vector<glm::vec3> albedo_;
  std::vector<glm::vec3> normal_;
  std::uint64_t direct_rays_ = 0;
  std::atomic<std::uint64_t> gather_rays_ = 0;
  std::uint64_t camera_rays_ = 0;
};

ray_tracing::DirectLightSettings direct_settings() {
  ray_tracing::DirectLightSettings settings;
  settings.pixel_rays = ray_tracing::PixelRays::spread;
  return settings;
}

Rendering::Rendering(const View& view, const RenderJob& job)
    : view_(view),
      job_(job),
      seed_(seed_of(job)),
      camera_(job.camera, job.width_px, job.height_px),
      direct_pass_(view.rays, direct_settings()) {
  const auto pixels =
      static_cast<std::size_t>(job.width_px) * static_cast<std::size_t>(job.height_px);
  for (auto* sums : {&direct_, &indirect_, &albedo_, &normal_}) {
    sums->assign(pixels, glm::vec3(0.0F));
  }
}

void Rendering::add_samples(const SampleRange& range, StageTimer& timer) {
  if (view_.settings.part == Part::all) {
    const auto stage = timer.stage("visibility");
    add_direct(range);
  }
  const auto stage = timer.stage("gather");
  add_indirect(range);
}

void Rendering::add_direct(const SampleRange& range) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const ray_tracing::DirectLight light =
        direct_pass_.render({job_.width_px, job_.height_px, job_.camera, hash_combine(seed_, 1),
                             static_cast<std::uint32_t>(i)});
    direct_rays_ += light.counts.rays();
    const std::vector<float>& values = light.radiance.pixels;
    for (std::size_t p = 0; p < direct_.size(); ++p) {
      direct_[p] += glm::vec3(values[3 * p], values[3 * p + 1], values[3 * p + 2]);
    }
  }
}

void Rendering::add_indirect(const SampleRange& range) {
  base::parallel_for(indirect_.size(), kPixelGrain, [&](std::size_t begin, std::size_t end) {
    std::uint64_t gathered = 0;
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      for (std::int64_t i = range.begin; i < range.end; ++i) add_sample(pixel, i, gathered);
    }
    gather_rays_.fetch_add(gathered, std::memory_order_relaxed);
  });
  camera_rays_ += indirect_.size() * static_cast<std::uint64_t>(range.end - range.begin);
}

void Rendering::add_sample(std::size_t pixel, std::int64_t sample, std::uint64_t& gathered) {
  const std::uint64_t pixel_seed = hash_combine(hash_combine(seed_, 2), pixel);
  const auto index = static_cast<std::uint32_t>(sample);
  SampleSequence numbers(SequenceKind::sobol, pixel_seed, index);
  const glm::vec4 place = numbers.next();
  const auto width = static_cast<std::size_t>(job_.width_px);
  const ray_tracing::Ray ray = camera_.through(static_cast<float>(pixel % width) + place.x,
                                               static_cast<float>(pixel / width) + place.y);
  Hit hit;
  if (!view_.rays.intersect(ray, hit)) return;
  const ViewedPoint point = viewed_point(hit, -ray.direction, hash_combine(pixel_seed, 1), index);
  const glm::vec3 albedo = ray_tracing::diffuse_albedo(view_.rays.scene(), hit);
  albedo_[pixel] += albedo;
  normal_[pixel] += point.normal;
  if (view_.light == nullptr) return;
  if (albedo != glm::vec3(0.0F)) {
    indirect_[pixel] += albedo / ray_tracing::kPi * view_.light->irradiance(point, gathered);
  }
  const auto material = static_cast<std::size_t>(hit.material);
  if (!view_.rays.scene().materials[material].is_glossy()) return;
  indirect_[pixel] += glossy(point, -ray.direction, numbers.next(), gathered);
}

/// Indirect light of the lobe at the first surface: one ray, weighted by f cos / pdf.
glm::vec3 Rendering::glossy(const ViewedPoint& point, const glm::vec3& to_viewer,
                            const glm::vec4& u, std::uint64_t& gathered) const {
  ray_tracing::SurfaceBrdf lobe =
      make_brdf(view_.rays.scene(), point.surface, to_viewer, ray_tracing::Lobes::all);
  lobe.diffuse = glm::vec3(0.0F);
  lobe.glossy_share = 1.0F;
  const ray_tracing::BrdfSample drawn = sample(lobe, 0.0F, {u.x, u.y});
  if (drawn.value == glm::vec3(0.0F)) return glm::vec3(0.0F);
  ++gathered;
  Hit seen;
  if (!view_.rays.intersect(ray_from(point.surface, drawn.direction), seen)) return glm::vec3(0.0F);
  const std::uint64_t seed = hash_combine(hash_combine(point.seed, 3), point.index);
  return drawn.value / drawn.pdf *
         view_.light->reflected(viewed_point(seen, -drawn.direction, seed, 0), gathered);
}

Image Rendering::radiance(std::int64_t samples) const {
  std::vector<glm::vec3> sums = indirect_;
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += direct_[i];
  return mean_image(job_, sums, samples);
}

Frame Rendering::finish(std::int64_t samples) const {
  Frame frame;
  frame.radiance = radiance(samples);
  frame.samples = samples;
  if (view_.settings.part == Part::all) {
    frame.aovs.push_back({"direct", mean_image(job_, direct_, samples)});
  }
  frame.aovs.push_back({"indirect", mean_image(job_, indirect_, samples)});
  frame.aovs.push_back({"albedo", mean_image(job_, albedo_, samples)});
  frame.aovs.push_back({"normal", mean_image(job_, normal_, samples)});
  const auto number = [](std::uint64_t value) { return static_cast<double>(value); };
  frame.counters = {{"camera_rays", number(camera_rays_)},
                    {"gather_rays", number(gather_rays_)},
                    {"direct_rays", number(direct_rays_)},
                    {"rays", number(camera_rays_ + gather_rays_ + direct_rays_)}};
  if (view_.light == nullptr) frame.notes.push_back("no light reaches a surface");
  return frame;
}

}  // namespace

std::uint64_t seed_of(const RenderJob& job) {
  return hash_combine(job.seed, static_cast<std::uint64_t>(job.frame_index));
}

Frame render_view(const View& view, const RenderJob& job, StageTimer& timer) {
  Rendering rendering(view, job);
  const SampleSchedule schedule(job, view.settings.samples);
  std::int64_t done = 0;
  double not_counted_s = 0.0;
  while (const auto range = schedule.next(done, steady_seconds() - view.start_s - not_counted_s)) {
    rendering.add_samples(*range, timer);
    done = range->end;
    if (!job.checkpoint || !SampleSchedule::is_checkpoint(done)) continue;
    const double pause_s = steady_seconds();
    Image image;
    {
      const auto stage = timer.stage("readback");
      image = rendering.radiance(done);
    }
    job.checkpoint(image, done);
    not_counted_s += steady_seconds() - pause_s;
  }
  const auto stage = timer.stage("readback");
  return rendering.finish(done);
}

}  // namespace renderers::indirect_view
