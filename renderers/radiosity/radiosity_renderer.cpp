#include "renderers/radiosity/radiosity_renderer.h"

#include <cassert>
#include <memory>
#include <utility>

#include "perception/base/parallel.h"
#include "renderers/element_hierarchy/solver_parameters.h"
#include "renderers/radiosity/radiosity_picture.h"
#include "renderers/radiosity/radiosity_settings.h"
#include "renderers/ray_tracing/direct_light_pass.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::radiosity {

namespace {

class RadiosityRenderer final : public Renderer {
 public:
  RadiosityRenderer(const base::Parameters& parameters, const Devices& devices)
      : settings_(settings_of(parameters)), devices_(devices) {}

  void prepare(const scene::Scene& scene, StageTimer& timer) override;
  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  /// Direct light at the camera's surfaces by samples on the lights.
  void add_sampled_direct(const RenderJob& job, std::uint64_t seed, StageTimer& timer,
                          RadiosityPicture& picture) const;

  Settings settings_;
  Devices devices_;
  // Each refers to those before it.
  std::unique_ptr<ray_tracing::RayScene> rays_;
  std::unique_ptr<element_hierarchy::Solution> solution_;  ///< null: light reaches no surface
  std::unique_ptr<element_hierarchy::ShownLight> shown_;
};

void RadiosityRenderer::prepare(const scene::Scene& scene, StageTimer& timer) {
  const base::ThreadLimit limit(devices_.threads);
  shown_.reset();
  solution_.reset();
  {
    const auto stage = timer.stage("build");
    rays_ = std::make_unique<ray_tracing::RayScene>(scene, timer);
  }
  const auto stage = timer.stage("transport");
  solution_ = element_hierarchy::solve_radiosity(*rays_, settings_.solver, timer);
  if (!solution_) return;
  const auto inner = timer.stage("vertices");
  shown_ = std::make_unique<element_hierarchy::ShownLight>(*solution_, settings_.shading);
}

void RadiosityRenderer::add_sampled_direct(const RenderJob& job, std::uint64_t seed,
                                           StageTimer& timer, RadiosityPicture& picture) const {
  const auto stage = timer.stage("visibility");
  ray_tracing::DirectLightSettings direct;
  direct.pixel_rays = ray_tracing::PixelRays::spread;
  direct.camera_rays = settings_.camera_rays;
  const ray_tracing::DirectLightPass pass(*rays_, direct);
  ray_tracing::DirectLight light =
      pass.render({job.width_px, job.height_px, job.camera, ray_tracing::hash_combine(seed, 1), 0});
  picture.direct = std::move(light.radiance);
  picture.rays += light.counts.rays();
}

Frame RadiosityRenderer::render(const RenderJob& job, StageTimer& timer) {
  assert(rays_);
  const base::ThreadLimit limit(devices_.threads);
  const std::uint64_t seed =
      ray_tracing::hash_combine(job.seed, static_cast<std::uint64_t>(job.frame_index));
  const bool is_sampled = settings_.direct == DirectMode::next_event;
  RadiosityPicture picture;
  {
    const auto stage = timer.stage("gather");
    picture =
        show_solution(*rays_, shown_.get(), job,
                      {settings_.camera_rays, settings_.part == Part::all && !is_sampled, seed});
  }
  if (settings_.part == Part::all && is_sampled) add_sampled_direct(job, seed, timer, picture);
  Frame frame;
  const auto stage = timer.stage("readback");
  frame.radiance = picture.indirect;
  if (settings_.part == Part::all) {
    for (std::size_t i = 0; i < frame.radiance.pixels.size(); ++i) {
      frame.radiance.pixels[i] += picture.direct.pixels[i];
    }
    frame.aovs.push_back({"direct", std::move(picture.direct)});
  }
  frame.aovs.push_back({"indirect", std::move(picture.indirect)});
  for (perception::NamedImage& image : show_patches(*rays_, solution_.get(), job)) {
    frame.aovs.push_back(std::move(image));
  }
  frame.counters = element_hierarchy::solution_counters(solution_.get());
  const double solution_rays = solution_ ? static_cast<double>(solution_->record.rays) : 0.0;
  frame.counters.emplace_back("rays", static_cast<double>(picture.rays) + solution_rays);
  if (!solution_) frame.notes.push_back("no light reaches a surface");
  if (solution_ && !solution_->record.has_converged) {
    frame.notes.push_back("the radiosity solution has not converged; see counter residuals");
  }
  return frame;
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  return std::make_unique<RadiosityRenderer>(parameters, devices);
}

}  // namespace

RendererInfo renderer_info() {
  RendererInfo info;
  info.name = "radiosity";
  info.version = 2;
  info.summary = "Hierarchical radiosity with clusters, shown directly.";
  info.source =
      "Hanrahan, Salzman, Aupperle 1991, doi:10.1145/122718.122740; Sillion 1995, "
      "doi:10.1109/2945.466719; Scheel, Stamminger, Seidel 2002, CGF 21(3)";
  info.claims = [](const base::Parameters& parameters, const scene::Scene&) {
    return claims_of(parameters);
  };
  info.possible_claims = {{Transport::diffuse, Part::all, std::nullopt},
                          {Transport::diffuse, Part::indirect, std::nullopt}};
  info.supports = {Feature::point_light, Feature::spot_light, Feature::area_light,
                   Feature::environment, Feature::texture,    Feature::glossy,
                   Feature::animation};
  info.uses_seed = true;
  info.parameters = parameter_specs();
  info.presets = presets();
  info.create = create;
  return info;
}

}  // namespace renderers::radiosity
