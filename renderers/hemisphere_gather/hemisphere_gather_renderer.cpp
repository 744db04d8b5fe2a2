#include "renderers/hemisphere_gather/hemisphere_gather_renderer.h"

#include <array>
#include <cassert>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "perception/base/parallel.h"
#include "renderers/contract/choice_names.h"
#include "renderers/contract/frame_counters.h"
#include "renderers/element_hierarchy/shown_light.h"
#include "renderers/element_hierarchy/solver_parameters.h"
#include "renderers/indirect_view/indirect_view.h"

namespace renderers::hemisphere_gather {

namespace {

using element_hierarchy::Shading;
using element_hierarchy::ShownLight;
using indirect_view::HemisphereRays;
using indirect_view::ViewedPoint;

constexpr std::array<std::pair<const char*, Shading>, 2> kShadings{
    {{"flat", Shading::flat}, {"smooth", Shading::smooth}}};

/// Indirect light by rays that meet surfaces with the solution's light.
class GatheredSolution final : public indirect_view::IndirectLight {
 public:
  GatheredSolution(const ray_tracing::RayScene& rays, const ShownLight& shown,
                   const HemisphereRays& settings)
      : rays_(rays), shown_(shown), settings_(settings) {}

  glm::vec3 irradiance(const ViewedPoint& point, std::uint64_t& rays) const override {
    return gather_irradiance(
        rays_, point, settings_,
        [&](const ViewedPoint& seen, float) { return reflected(seen, rays); }, rays);
  }

  glm::vec3 reflected(const ViewedPoint& point, std::uint64_t&) const override {
    return shown_.reflected(point.surface, point.geometric_normal);
  }

 private:
  const ray_tracing::RayScene& rays_;
  const ShownLight& shown_;
  HemisphereRays settings_;
};

/// Parameters, typed. Meanings: `parameter_specs`.
struct Settings {
  element_hierarchy::SolverSettings solver;
  indirect_view::ViewSettings view;
  HemisphereRays gather;
  Shading shading = Shading::smooth;
};

std::vector<base::ParameterSpec> parameter_specs() {
  std::vector<base::ParameterSpec> specs = element_hierarchy::solver_parameters();
  for (auto group : {indirect_view::view_parameters(), indirect_view::hemisphere_parameters()}) {
    specs.insert(specs.end(), std::make_move_iterator(group.begin()),
                 std::make_move_iterator(group.end()));
  }
  specs.push_back(base::choice_parameter(
      "shading", names_of(kShadings), "smooth",
      "Light of the solution where a ray ends: a value per patch, or linear between the patches' "
      "vertices; ours."));
  return specs;
}

Settings settings_of(const base::Parameters& parameters) {
  return {element_hierarchy::solver_settings_of(parameters),
          indirect_view::view_settings_of(parameters),
          indirect_view::hemisphere_rays_of(parameters),
          value_of(kShadings, parameters.text("shading"))};
}

std::vector<base::Preset> presets() {
  using Value = base::ParameterValue;
  base::Preset paper{"paper", element_hierarchy::paper_solver_values()};
  paper.values.emplace_back("gather_sequence", Value(std::string("strata")));
  paper.values.emplace_back("shading", Value(std::string("flat")));
  return {std::move(paper), base::Preset{"best", {}}};
}

class HemisphereGatherRenderer final : public Renderer {
 public:
  HemisphereGatherRenderer(const base::Parameters& parameters, const Devices& devices)
      : settings_(settings_of(parameters)), devices_(devices) {}

  void prepare(const scene::Scene& scene, StageTimer& timer) override;
  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  Settings settings_;
  Devices devices_;
  // Each refers to those before it.
  std::unique_ptr<ray_tracing::RayScene> rays_;
  std::unique_ptr<element_hierarchy::Solution> solution_;  ///< null: light reaches no surface
  std::unique_ptr<ShownLight> shown_;
};

void HemisphereGatherRenderer::prepare(const scene::Scene& scene, StageTimer& timer) {
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
  shown_ = std::make_unique<ShownLight>(*solution_, settings_.shading);
}

Frame HemisphereGatherRenderer::render(const RenderJob& job, StageTimer& timer) {
  assert(rays_);
  const double start_s = steady_seconds();
  const base::ThreadLimit limit(devices_.threads);
  std::unique_ptr<GatheredSolution> light;
  if (shown_) light = std::make_unique<GatheredSolution>(*rays_, *shown_, settings_.gather);
  Frame frame =
      indirect_view::render_view({*rays_, light.get(), settings_.view, start_s}, job, timer);
  for (auto& entry : element_hierarchy::solution_counters(solution_.get())) {
    frame.counters.push_back(std::move(entry));
  }
  if (!solution_) return frame;
  add_to_counter("rays", static_cast<double>(solution_->record.rays), frame);
  if (!solution_->record.has_converged) {
    frame.notes.push_back("the radiosity solution has not converged; see counter residuals");
  }
  return frame;
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  return std::make_unique<HemisphereGatherRenderer>(parameters, devices);
}

}  // namespace

RendererInfo renderer_info() {
  RendererInfo info = indirect_view::view_info();
  std::erase(info.supports, Feature::emission_profile);  // the solution knows none
  info.name = "hemisphere-gather";
  info.version = 2;
  info.summary = "A radiosity solution gathered at every camera ray by rays over the hemisphere.";
  info.source =
      "Reichert 1992, M.S. thesis, Cornell University; Scheel, Stamminger, Seidel 2002, CGF 21(3)";
  info.parameters = parameter_specs();
  info.presets = presets();
  info.create = create;
  return info;
}

}  // namespace renderers::hemisphere_gather
