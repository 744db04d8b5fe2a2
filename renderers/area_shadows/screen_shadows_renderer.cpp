#include "renderers/area_shadows/screen_shadows_renderer.h"

#include <bit>
#include <cassert>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "renderers/area_shadows/gpu_visibility.h"
#include "renderers/area_shadows/shadow_picture.h"
#include "renderers/gpu_tracing/triangle_bvh.h"
#include "renderers/opengl/context.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::area_shadows {

namespace {

class ScreenShadowsRenderer final : public Renderer {
 public:
  ScreenShadowsRenderer(const ScreenShadowsSettings& settings, ShadowSolver solver,
                        const Devices& devices)
      : settings_(settings), solver_(std::move(solver)), devices_(devices) {}

  void prepare(const scene::Scene& scene, StageTimer& timer) override;
  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  std::vector<ray_tracing::LightPointSet> light_points(const RenderJob& job) const;
  std::unique_ptr<PointVisibility> visibility(const PixelSurfaces& surfaces,
                                              const std::vector<ray_tracing::LightPointSet>& lights,
                                              StageTimer& timer);

  ScreenShadowsSettings settings_;
  ShadowSolver solver_;
  Devices devices_;
  std::unique_ptr<ray_tracing::RayScene> rays_;
  std::unique_ptr<DeviceRays> gpu_;  ///< null: rays are Embree's
};

/// The context whose compute shaders trace the rays, or null. @throws UnsupportedError
std::shared_ptr<opengl::Context> tracing_context(RayBackend backend, const Devices& devices) {
  switch (backend) {
    case RayBackend::automatic:
      return opengl::Context::hardware_of(devices);
    case RayBackend::gpu:
      return opengl::Context::of(devices);
    case RayBackend::embree:
      break;
  }
  return nullptr;
}

void ScreenShadowsRenderer::prepare(const scene::Scene& scene, StageTimer& timer) {
  const base::ThreadLimit limit(devices_.threads);
  const auto stage = timer.stage("build");
  const auto context = tracing_context(settings_.backend, devices_);
  if (!context) {
    gpu_.reset();
  } else if (!gpu_ || gpu_->bvh.context() != context) {
    gpu_ = std::make_unique<DeviceRays>(context);
  }
  rays_ = std::make_unique<ray_tracing::RayScene>(scene, timer);
  if (!gpu_) return;
  const auto inner = timer.stage("gpu_bvh");
  gpu_->bvh.load(gpu_tracing::build_bvh(*rays_), timer);
}

std::unique_ptr<PointVisibility> ScreenShadowsRenderer::visibility(
    const PixelSurfaces& surfaces, const std::vector<ray_tracing::LightPointSet>& lights,
    StageTimer& timer) {
  if (gpu_) return std::make_unique<GpuVisibility>(*gpu_, surfaces, lights, timer);
  return std::make_unique<EmbreeVisibility>(*rays_, surfaces, lights);
}

std::vector<ray_tracing::LightPointSet> ScreenShadowsRenderer::light_points(
    const RenderJob& job) const {
  // The same for every frame of a sequence: lights that stand still must not flicker.
  return ray_tracing::make_light_points(*rays_, settings_.points, job.seed, settings_.group_size);
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
  std::unique_ptr<PointVisibility> between;
  OtherLight points;
  {
    const auto stage = timer.stage("build");
    const auto inner = timer.stage("surfaces");
    surfaces = find_pixel_surfaces(*rays_, job);
  }
  {
    const auto stage = timer.stage("lights");
    lights = light_points(job);
    between = visibility(surfaces, lights, timer);
  }
  {
    const auto stage = timer.stage("shadow");
    points = add_point_lights(*rays_, surfaces);
  }
  ShadowResult result = solver_({*rays_, surfaces, lights, *between}, timer);
  Frame frame;
  OtherLight lobes;
  {
    const auto stage = timer.stage("gather");
    const auto inner = timer.stage("shade");
    lobes = add_glossy_lobes(rays_->scene(), surfaces, lights, *between, timer);
    frame.radiance = compose(surfaces, result.irradiance, {&points, &lobes});
  }
  const auto stage = timer.stage("readback");
  if (gpu_) {
    frame.device = gpu_->bvh.context()->facts().renderer;
    frame.gl_platform = opengl::to_string(gpu_->bvh.context()->platform());
  }
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

std::unique_ptr<Renderer> make_screen_shadows_renderer(const ScreenShadowsSettings& settings,
                                                       ShadowSolver solver,
                                                       const Devices& devices) {
  return std::make_unique<ScreenShadowsRenderer>(settings, std::move(solver), devices);
}

base::ParameterSpec backend_parameter() {
  return base::choice_parameter(
      "backend", {"auto", "embree", "gpu"}, "auto",
      "Who casts the shadow rays to points on lights: Embree on the CPU, or compute shaders of the "
      "device in a hierarchy of their own; auto: the device if it is hardware, else Embree.");
}

RayBackend backend_of(const base::Parameters& parameters) {
  const std::string& name = parameters.text("backend");
  if (name == "embree") return RayBackend::embree;
  return name == "gpu" ? RayBackend::gpu : RayBackend::automatic;
}

RendererInfo screen_shadows_info() {
  RendererInfo info;
  info.claims = [](const base::Parameters&, const scene::Scene&) {
    return Claims{Transport::direct, Part::all, std::nullopt};
  };
  info.possible_claims = {{Transport::direct, Part::all, std::nullopt}};
  info.supports = {Feature::point_light, Feature::spot_light, Feature::area_light,
                   Feature::environment, Feature::texture,    Feature::glossy,
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
