#include "renderers/irradiance_cache/irradiance_cache_renderer.h"

#include <cassert>
#include <memory>
#include <utility>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/contract/frame_counters.h"
#include "renderers/indirect_view/indirect_view.h"
#include "renderers/irradiance_cache/irradiance_cache_settings.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::irradiance_cache {

namespace {

class IrradianceCacheRenderer final : public Renderer {
 public:
  IrradianceCacheRenderer(const base::Parameters& parameters, const Devices& devices)
      : settings_(settings_of(parameters)), devices_(devices) {}

  void prepare(const scene::Scene& scene, StageTimer& timer) override;
  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  Settings settings_;
  Devices devices_;
  std::unique_ptr<ray_tracing::RayScene> rays_;
};

void IrradianceCacheRenderer::prepare(const scene::Scene& scene, StageTimer& timer) {
  const base::ThreadLimit limit(devices_.threads);
  const auto stage = timer.stage("build");
  rays_ = std::make_unique<ray_tracing::RayScene>(scene, timer);
}

Frame IrradianceCacheRenderer::render(const RenderJob& job, StageTimer& timer) {
  assert(rays_);
  const double start_s = steady_seconds();
  const base::ThreadLimit limit(devices_.threads);
  std::unique_ptr<CachedLight> light;
  if (rays_->triangle_count() > 0 && !ray_tracing::LightSampler(*rays_).is_empty()) {
    CacheSettings cache = settings_.cache;
    const float diagonal_m = glm::distance(rays_->box_min(), rays_->box_max());
    cache.spacing = {static_cast<float>(settings_.least_spacing) * diagonal_m,
                     static_cast<float>(settings_.greatest_spacing) * diagonal_m,
                     settings_.cache.spacing.by_gradient};
    light = std::make_unique<CachedLight>(*rays_, cache);
    const auto stage = timer.stage("transport");
    const auto inner = timer.stage("records");
    light->fill(job, ray_tracing::hash_combine(indirect_view::seed_of(job), 4));
  }
  Frame frame =
      indirect_view::render_view({*rays_, light.get(), settings_.view, start_s}, job, timer);
  const auto number = [](auto value) { return static_cast<double>(value); };
  frame.counters.emplace_back("records", light ? number(light->records().size()) : 0.0);
  frame.counters.emplace_back("records_discarded", light ? number(light->discarded()) : 0.0);
  frame.counters.emplace_back("record_rays", light ? number(light->record_rays()) : 0.0);
  frame.counters.emplace_back("uncovered", light ? number(light->uncovered()) : 0.0);
  frame.counters.emplace_back("record_bytes",
                              light ? number(light->records().memory_bytes()) : 0.0);
  if (light) add_to_counter("rays", number(light->record_rays()), frame);
  return frame;
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  return std::make_unique<IrradianceCacheRenderer>(parameters, devices);
}

}  // namespace

RendererInfo renderer_info() {
  RendererInfo info = indirect_view::view_info();
  info.name = "irradiance-cache";
  info.summary = "Indirect irradiance and its gradients at few points, interpolated between them.";
  info.source =
      "Ward, Rubinstein, Clear 1988, doi:10.1145/54852.378490; Ward and Heckbert 1992, "
      "\"Irradiance "
      "Gradients\", EGWR";
  info.claims = [](const base::Parameters& parameters, const scene::Scene&) {
    return claims_of(parameters);
  };
  info.possible_claims.push_back({Transport::one_bounce, Part::all, std::nullopt});
  info.possible_claims.push_back({Transport::one_bounce, Part::indirect, std::nullopt});
  info.parameters = parameter_specs();
  info.presets = presets();
  info.create = create;
  return info;
}

}  // namespace renderers::irradiance_cache
