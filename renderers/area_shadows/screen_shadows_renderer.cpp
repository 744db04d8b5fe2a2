#include "renderers/area_shadows/screen_shadows_renderer.h"

#include <bit>
#include <cassert>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "renderers/area_shadows/shadow_picture.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::area_shadows {

namespace {

class ScreenShadowsRenderer final : public Renderer {
 public:
  ScreenShadowsRenderer(const LightPointCounts& counts, ShadowSolver solver, const Devices& devices)
      : counts_(counts), solver_(std::move(solver)), devices_(devices) {}

  void prepare(const scene::Scene& scene, StageTimer& timer) override {
    const base::ThreadLimit limit(devices_.threads);
    const auto stage = timer.stage("build");
    rays_ = std::make_unique<ray_tracing::RayScene>(scene, timer);
  }
  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  std::vector<ray_tracing::LightPointSet> light_points(const RenderJob& job) const;

  LightPointCounts counts_;
  ShadowSolver solver_;
  Devices devices_;
  std::unique_ptr<ray_tracing::RayScene> rays_;
};

std::vector<ray_tracing::LightPointSet> ScreenShadowsRenderer::light_points(
    const RenderJob& job) const {
  // The same for every frame of a sequence: lights that stand still must not flicker.
  return ray_tracing::make_light_points(*rays_, counts_.points, job.seed, counts_.group_size);
}

/// Albedo and normal of the pixels' surfaces.
void add_surface_images(const PixelSurfaces& surfaces, Frame& frame) {
  std::vector<glm::vec3> albedo(surfaces.pixels.size(), glm::vec3(0.0F));
  std::vector<glm::vec3> normal = albedo;
  for (std::size_t pixel = 0; pixel < surfaces.pixels.size(); ++pixel) {
    const PixelSurface& surface = surfaces.pixels[pixel];
    if (!surface.is_surface()) continue;
    albedo[pixel] = surface.albedo;
    normal[pixel] = surface.receiver.normal;
  }
  frame.aovs.push_back({"albedo", image_of(surfaces, albedo)});
  frame.aovs.push_back({"normal", image_of(surfaces, normal)});
}

Frame ScreenShadowsRenderer::render(const RenderJob& job, StageTimer& timer) {
  assert(rays_);
  const base::ThreadLimit limit(devices_.threads);
  PixelSurfaces surfaces;
  std::vector<ray_tracing::LightPointSet> lights;
  OtherLight points;
  {
    const auto stage = timer.stage("build");
    const auto inner = timer.stage("surfaces");
    surfaces = find_pixel_surfaces(*rays_, job);
  }
  {
    const auto stage = timer.stage("lights");
    lights = light_points(job);
  }
  {
    const auto stage = timer.stage("shadow");
    points = add_point_lights(*rays_, surfaces);
  }
  ShadowResult result = solver_({*rays_, surfaces, lights}, timer);
  Frame frame;
  OtherLight lobes;
  {
    const auto stage = timer.stage("gather");
    const auto inner = timer.stage("shade");
    lobes = add_glossy_lobes(*rays_, surfaces, lights);
    frame.radiance = compose(surfaces, result.irradiance, {&points, &lobes});
  }
  const auto stage = timer.stage("readback");
  frame.aovs = std::move(result.aovs);
  frame.aovs.push_back({"irradiance", image_of(surfaces, result.irradiance)});
  add_surface_images(surfaces, frame);
  const auto camera_rays = static_cast<double>(surfaces.pixels.size());
  const auto point_rays = static_cast<double>(points.rays);
  const auto glossy_rays = static_cast<double>(lobes.rays);
  frame.counters = {{"rays", result.rays + camera_rays + point_rays + glossy_rays},
                    {"shadow_rays", result.rays},
                    {"camera_rays", camera_rays},
                    {"point_light_rays", point_rays},
                    {"glossy_rays", glossy_rays},
                    {"area_lights", static_cast<double>(lights.size())}};
  frame.counters.insert(frame.counters.end(), result.counters.begin(), result.counters.end());
  return frame;
}

}  // namespace

std::unique_ptr<Renderer> make_screen_shadows_renderer(const LightPointCounts& counts,
                                                       ShadowSolver solver,
                                                       const Devices& devices) {
  return std::make_unique<ScreenShadowsRenderer>(counts, std::move(solver), devices);
}

RendererInfo screen_shadows_info() {
  RendererInfo info;
  info.claims = [](const base::Parameters&, const scene::Scene&) {
    return Claims{Transport::direct, Part::all, std::nullopt};
  };
  info.possible_claims = {{Transport::direct, Part::all, std::nullopt}};
  info.supports = {Feature::point_light, Feature::spot_light, Feature::area_light,
                   Feature::environment, Feature::texture,    Feature::phong,
                   Feature::animation};
  info.uses_seed = true;
  return info;
}

void check_power_of_two(const std::string& owner, const std::string& parameter,
                        std::int64_t value) {
  if (value > 0 && std::has_single_bit(static_cast<std::uint64_t>(value))) return;
  throw base::InputError(owner + ": " + parameter + " is " + std::to_string(value) +
                         "; accepted: powers of two");
}

}  // namespace renderers::area_shadows
