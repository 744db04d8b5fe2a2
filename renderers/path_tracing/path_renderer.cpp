#include "renderers/path_tracing/path_renderer.h"

#include <array>
#include <atomic>
#include <cassert>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "perception/base/available_memory.h"
#include "perception/base/parallel.h"
#include "perception/base/units.h"
#include "renderers/contract/sample_schedule.h"
#include "renderers/path_tracing/film.h"
#include "renderers/path_tracing/path_integrator.h"
#include "renderers/path_tracing/path_settings.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/pixel_tiles.h"

namespace renderers::path_tracing {

namespace {

using ray_tracing::CameraRays;
using ray_tracing::kPacketRays;
using ray_tracing::LightSampler;
using ray_tracing::PixelTile;
using ray_tracing::RayScene;
using ray_tracing::SampleSequence;

/// Rays of all threads.
struct SharedRayCounts {
  std::atomic<std::uint64_t> camera = 0;
  std::atomic<std::uint64_t> bounce = 0;
  std::atomic<std::uint64_t> shadow = 0;
  std::atomic<std::uint64_t> light = 0;

  void add(const RayCounts& counts) {
    camera.fetch_add(counts.camera, std::memory_order_relaxed);
    bounce.fetch_add(counts.bounce, std::memory_order_relaxed);
    shadow.fetch_add(counts.shadow, std::memory_order_relaxed);
    light.fetch_add(counts.light, std::memory_order_relaxed);
  }
};

/// One image on its way: film, counters and the job's constants.
class Rendering {
 public:
  Rendering(const RenderJob& job, const PathIntegrator& integrator, const PathSettings& settings)
      : job_(job),
        integrator_(integrator),
        sampler_(settings.sampler),
        pixel_(settings.pixel),
        camera_(job.camera, job.width_px, job.height_px),
        film_(job.width_px, job.height_px),
        seed_(ray_tracing::hash_combine(job.seed, static_cast<std::uint64_t>(job.frame_index))) {}

  void add_samples(const SampleRange& range);
  const Film& film() const { return film_; }
  const SharedRayCounts& counts() const { return counts_; }

 private:
  void add_tile(const PixelTile& tile, const SampleRange& range);
  std::size_t pixel_at(const glm::ivec2& place) const;

  const RenderJob& job_;
  const PathIntegrator& integrator_;
  ray_tracing::SequenceKind sampler_;
  PixelFilter pixel_;
  CameraRays camera_;
  Film film_;
  std::uint64_t seed_;
  SharedRayCounts counts_;
};

void Rendering::add_samples(const SampleRange& range) {
  film_.reserve(range.end);
  ray_tracing::for_each_tile(job_.width_px, job_.height_px,
                             [&](const PixelTile& tile) { add_tile(tile, range); });
}

std::size_t Rendering::pixel_at(const glm::ivec2& place) const {
  return static_cast<std::size_t>(place.y) * static_cast<std::size_t>(job_.width_px) +
         static_cast<std::size_t>(place.x);
}

void Rendering::add_tile(const PixelTile& tile, const SampleRange& range) {
  std::array<std::uint64_t, kPacketRays> seeds{};
  for (std::size_t p = 0; p < tile.count; ++p) {
    seeds[p] = ray_tracing::hash_combine(seed_, pixel_at(tile.pixels[p]));
  }
  RayCounts counts;
  std::array<ray_tracing::Ray, kPacketRays> rays;
  std::array<PathSample, kPacketRays> samples;
  std::vector<SampleSequence> numbers;
  numbers.reserve(tile.count);
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const auto randomisation = static_cast<std::uint64_t>(i % kRandomisations);
    numbers.clear();
    for (std::size_t p = 0; p < tile.count; ++p) {
      numbers.emplace_back(sampler_, ray_tracing::hash_combine(seeds[p], randomisation),
                           static_cast<std::uint32_t>(i / kRandomisations));
      const glm::vec4 u = pixel_ == PixelFilter::box ? numbers[p].next() : glm::vec4(0.5F);
      const glm::vec2 corner(tile.pixels[p]);
      rays[p] = camera_.through(corner.x + u.x, corner.y + u.y);
      samples[p] = {};
    }
    integrator_.trace(std::span(rays).first(tile.count), numbers,
                      std::span(samples).first(tile.count), counts);
    for (std::size_t p = 0; p < tile.count; ++p) {
      film_.add(pixel_at(tile.pixels[p]), i, samples[p]);
    }
  }
  counts_.add(counts);
}

class PathRenderer final : public Renderer {
 public:
  PathRenderer(const base::Parameters& parameters, const Devices& devices)
      : settings_(settings_of(parameters)), devices_(devices) {}

  void prepare(const scene::Scene& scene, StageTimer& timer) override;
  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  std::int64_t sample_until_done(Rendering& rendering, const RenderJob& job, double start_s,
                                 StageTimer& timer) const;
  Frame finish(const Rendering& rendering, std::int64_t samples, StageTimer& timer) const;

  PathSettings settings_;
  Devices devices_;
  std::unique_ptr<LightSampler> lights_;
  std::unique_ptr<RayScene> rays_;
};

void PathRenderer::prepare(const scene::Scene& scene, StageTimer& timer) {
  const base::ThreadLimit limit(devices_.threads);
  lights_.reset();
  {
    const auto stage = timer.stage("build");
    rays_ = std::make_unique<RayScene>(scene, timer);
  }
  const auto stage = timer.stage("lights");
  lights_ = std::make_unique<LightSampler>(*rays_);
}

/// @throws DeviceMemoryError for a film that no memory is left for: before it fills it
void check_memory(const RenderJob& job, std::int64_t samples) {
  constexpr std::uint64_t kAlwaysThere_bytes = std::uint64_t{1} << 28;
  const std::uint64_t need_bytes = Film::needed_bytes(job.width_px, job.height_px, samples);
  if (need_bytes < kAlwaysThere_bytes) return;
  const auto have_bytes = base::available_memory_bytes();
  if (!have_bytes || need_bytes <= static_cast<std::uint64_t>(*have_bytes)) return;
  throw DeviceMemoryError(
      fmt::format("path: sums and images of {}x{} pixels take at least {} with {} samples; {} are "
                  "available; accepted: a smaller size, or a machine with more memory",
                  job.width_px, job.height_px, base::format_bytes(static_cast<double>(need_bytes)),
                  samples, base::format_bytes(static_cast<double>(*have_bytes))));
}

Frame PathRenderer::render(const RenderJob& job, StageTimer& timer) {
  assert(rays_ && lights_);
  // Under a time budget one sample may be all there is.
  check_memory(job, job.time_budget_s ? 1 : job.samples.value_or(settings_.samples));
  const double start_s = steady_seconds();
  const base::ThreadLimit limit(devices_.threads);
  std::optional<Rendering> rendering;
  std::optional<PathIntegrator> integrator;
  {
    const auto stage = timer.stage("transport");
    integrator.emplace(*rays_, *lights_, settings_);
    rendering.emplace(job, *integrator, settings_);
  }
  const std::int64_t samples = sample_until_done(*rendering, job, start_s, timer);
  return finish(*rendering, samples, timer);
}

std::int64_t PathRenderer::sample_until_done(Rendering& rendering, const RenderJob& job,
                                             double start_s, StageTimer& timer) const {
  const SampleSchedule schedule(job, settings_.samples);
  double not_counted_s = 0.0;
  std::int64_t done = 0;
  while (const auto range = schedule.next(done, steady_seconds() - start_s - not_counted_s)) {
    {
      const auto stage = timer.stage("transport");
      rendering.add_samples(*range);
    }
    done = range->end;
    if (!job.checkpoint || !SampleSchedule::is_checkpoint(done)) continue;
    const double pause_s = steady_seconds();
    std::optional<perception::Image> image;
    {
      const auto stage = timer.stage("readback");
      image = rendering.film().radiance(done);
    }
    job.checkpoint(*image, done);
    not_counted_s += steady_seconds() - pause_s;
  }
  return done;
}

Frame PathRenderer::finish(const Rendering& rendering, std::int64_t samples,
                           StageTimer& timer) const {
  Frame frame;
  frame.samples = samples;
  {
    const auto stage = timer.stage("filter");
    frame.radiance = rendering.film().radiance(samples);
  }
  const auto stage = timer.stage("readback");
  const Film& film = rendering.film();
  frame.aovs = film.first_surface(samples);
  if (settings_.claims.part == Part::all) frame.aovs.push_back({"direct", film.direct(samples)});
  frame.aovs.push_back({"indirect", film.indirect(samples)});
  if (samples >= 2) {
    frame.aovs.push_back({"variance", film.variance(samples)});
  } else {
    frame.notes.push_back("no variance: one sample per pixel has none to show");
  }
  const auto camera = static_cast<double>(rendering.counts().camera.load());
  const auto bounce = static_cast<double>(rendering.counts().bounce.load());
  const auto shadow = static_cast<double>(rendering.counts().shadow.load());
  const auto light = static_cast<double>(rendering.counts().light.load());
  frame.counters = {{"rays", camera + bounce + shadow + light},
                    {"camera_rays", camera},
                    {"bounce_rays", bounce},
                    {"shadow_rays", shadow},
                    {"light_rays", light},
                    {"samples", static_cast<double>(samples)}};
  return frame;
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  return std::make_unique<PathRenderer>(parameters, devices);
}

std::vector<Claims> possible_claims() {
  std::vector<Claims> claims;
  for (const Part part : {Part::all, Part::indirect}) {
    for (const Transport transport :
         {Transport::direct, Transport::one_bounce, Transport::diffuse, Transport::full}) {
      if (part == Part::indirect && transport == Transport::direct) continue;  // the empty set
      claims.push_back({transport, part, std::nullopt});
    }
  }
  return claims;
}

}  // namespace

RendererInfo renderer_info() {
  RendererInfo info;
  info.name = "path";
  info.summary =
      "Unbiased path tracing with next-event estimation and multiple importance sampling.";
  info.source =
      "Kajiya 1986, doi:10.1145/15922.15902; Veach and Guibas 1995, "
      "doi:10.1145/218380.218498";
  info.claims = [](const base::Parameters& parameters, const scene::Scene&) {
    return claims_of(parameters);
  };
  info.possible_claims = possible_claims();
  info.supports = {Feature::point_light,      Feature::spot_light,  Feature::area_light,
                   Feature::emission_profile, Feature::environment, Feature::texture,
                   Feature::glossy,           Feature::animation};
  info.progressive_unit = "samples per pixel";
  info.uses_seed = true;
  info.parameters = parameter_specs();
  info.presets = presets();
  info.create = create;
  return info;
}

}  // namespace renderers::path_tracing
