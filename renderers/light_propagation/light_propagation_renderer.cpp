#include "renderers/light_propagation/light_propagation_renderer.h"

#include <algorithm>
#include <cassert>
#include <memory>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/light_propagation/light_propagation_settings.h"
#include "renderers/light_propagation/reflective_map.h"
#include "renderers/light_propagation/sample_light.h"
#include "renderers/light_propagation/volume_slices.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/direct_light_pass.h"
#include "renderers/ray_tracing/light_points.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::light_propagation {

namespace {

using perception::Image;

constexpr std::size_t kPixelGrain = 256;

void store(Image& image, std::size_t pixel, const glm::vec3& color) {
  std::copy_n(&color.x, 3, image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
}

Image black(const RenderJob& job) {
  return perception::make_rgb_image(job.width_px, job.height_px,
                                    perception::Encoding::scene_linear);
}

/// Moves a grid by less than a cell along all axes and adds a cell to each, so that the margin
/// stays at least one.
void move(float cells, Grid& grid) {
  if (cells == 0.0F) return;
  grid.corner += (cells > 0.0F ? cells - 1.0F : cells) * grid.cell_m;
  grid.size += 1;
}

/// What was found out about a scene.
struct Solution {
  std::size_t samples = 0;
  std::uint64_t gather_rays = 0;
  double area_m2 = 0.0;          ///< of all samples
  glm::dvec3 injected_w{0};      ///< flux
  glm::dvec3 left_w{0};          ///< flux that still travels after the last step
  std::size_t volume_bytes = 0;  ///< injected, spread, left
  std::size_t work_bytes = 0;    ///< of propagation besides
  LightVolume volume;
};

/// Pictures of the surfaces at the pixels' centres.
struct IndirectPicture {
  Image radiance;
  Image irradiance;
  Image albedo;
  Image normal;
};

class LightPropagationRenderer final : public Renderer {
 public:
  LightPropagationRenderer(const base::Parameters& parameters, const Devices& devices)
      : settings_(settings_of(parameters)), devices_(devices) {}

  void prepare(const scene::Scene& scene, StageTimer& timer) override;
  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  IndirectPicture look(const RenderJob& job) const;
  void add_details(IndirectPicture picture, Frame& frame) const;

  Settings settings_;
  Devices devices_;
  std::unique_ptr<ray_tracing::RayScene> rays_;
  std::optional<Solution> solution_;
};

void LightPropagationRenderer::prepare(const scene::Scene& scene, StageTimer& timer) {
  const base::ThreadLimit limit(devices_.threads);
  solution_.reset();
  std::vector<SurfaceSample> samples;
  Grid grid;
  {
    const auto stage = timer.stage("build");
    rays_ = std::make_unique<ray_tracing::RayScene>(scene, timer);
    const auto inner = timer.stage("samples");
    if (rays_->triangle_count() == 0) return;
    grid = grid_around({rays_->box_min(), rays_->box_max()}, settings_.cells);
    move(settings_.grid_shift, grid);
    if (settings_.sources == Sources::poisson) {
      samples = sample_surfaces(*rays_, grid, settings_.samples);
    }
  }
  GatheredLight light;
  {
    const auto stage = timer.stage("lights");
    if (settings_.sources == Sources::rsm) {
      ReflectiveMap map = reflective_map(*rays_, settings_.rsm_rays);
      samples = std::move(map.samples);
      light = std::move(map.light);
    } else {
      light = light_samples(*rays_, samples, settings_.light_points);
    }
  }
  auto stage = timer.stage("transport");
  std::optional<LightVolume> injected;
  std::optional<BlockingVolume> blocking;
  std::optional<Propagation> spread;
  {
    const auto inner = timer.stage("injection");
    injected = inject(grid, samples, light.samples);
  }
  if (settings_.has_geometry_volume) {
    const auto inner = timer.stage("blocking");
    blocking = block_by(*rays_, grid);
  }
  {
    const auto inner = timer.stage("propagation");
    spread = propagate(*injected, blocking ? &*blocking : nullptr, settings_.propagation);
  }
  const std::size_t volume_bytes = 3 * grid.cell_count() * sizeof(CellLight);
  stage.add_bytes(static_cast<std::int64_t>(volume_bytes + spread->work_bytes));
  double area_m2 = 0.0;
  for (const SurfaceSample& sample : samples) area_m2 += static_cast<double>(sample.area_m2);
  solution_.emplace(Solution{samples.size(), light.rays, area_m2, injected->flux(),
                             spread->last.flux(), volume_bytes, spread->work_bytes,
                             std::move(spread->sum)});
}

/// Lambert reflection of the volume's light at what pixels' centres show.
IndirectPicture LightPropagationRenderer::look(const RenderJob& job) const {
  IndirectPicture picture{black(job), black(job), black(job), black(job)};
  const ray_tracing::CameraRays camera(job.camera, job.width_px, job.height_px);
  const auto look_at = [&](std::size_t pixel) {
    const auto width = static_cast<std::size_t>(job.width_px);
    ray_tracing::Hit hit;
    if (!solution_ || !rays_->intersect(camera.through(static_cast<float>(pixel % width) + 0.5F,
                                                       static_cast<float>(pixel / width) + 0.5F),
                                        hit)) {
      return;
    }
    const auto receiver = ray_tracing::receiver_at(hit, job.camera.position);
    const glm::vec3 albedo = ray_tracing::diffuse_albedo(rays_->scene(), hit);
    const glm::vec3 received =
        irradiance(solution_->volume, receiver.position, receiver.normal, settings_.lookup);
    store(picture.radiance, pixel, albedo * received * (1.0F / ray_tracing::kPi));
    store(picture.irradiance, pixel, received);
    store(picture.albedo, pixel, albedo);
    store(picture.normal, pixel, receiver.normal);
  };
  base::parallel_for(picture.radiance.pixel_count(), kPixelGrain,
                     [&](std::size_t begin, std::size_t end) {
                       for (std::size_t pixel = begin; pixel < end; ++pixel) look_at(pixel);
                     });
  return picture;
}

Frame LightPropagationRenderer::render(const RenderJob& job, StageTimer& timer) {
  assert(rays_);
  const base::ThreadLimit limit(devices_.threads);
  Frame frame;
  IndirectPicture picture;
  std::uint64_t direct_rays = 0;
  {
    const auto stage = timer.stage("gather");
    picture = look(job);
    frame.radiance = picture.radiance;
  }
  if (settings_.part == Part::all) {
    const auto stage = timer.stage("shadow");
    ray_tracing::DirectLightSettings direct;
    direct.light_samples = settings_.light_samples;
    const ray_tracing::DirectLightPass pass(*rays_, direct);
    ray_tracing::DirectLight light =
        pass.render({job.width_px, job.height_px, job.camera, job.seed, 0});
    direct_rays = light.counts.rays();
    for (std::size_t i = 0; i < frame.radiance.pixels.size(); ++i) {
      frame.radiance.pixels[i] += light.radiance.pixels[i];
    }
    frame.aovs.push_back({"direct", std::move(light.radiance)});
  }
  const auto stage = timer.stage("readback");
  const auto pixels = static_cast<double>(frame.radiance.pixel_count());
  const double gather_rays = solution_ ? static_cast<double>(solution_->gather_rays) : 0.0;
  frame.counters = {{"rays", pixels + gather_rays + static_cast<double>(direct_rays)},
                    {"gather_rays", gather_rays},
                    {"direct_rays", static_cast<double>(direct_rays)}};
  add_details(std::move(picture), frame);
  return frame;
}

void LightPropagationRenderer::add_details(IndirectPicture picture, Frame& frame) const {
  frame.aovs.push_back({"indirect", std::move(picture.radiance)});
  frame.aovs.push_back({"indirect_irradiance", std::move(picture.irradiance)});
  frame.aovs.push_back({"albedo", std::move(picture.albedo)});
  frame.aovs.push_back({"normal", std::move(picture.normal)});
  if (!solution_) return;
  frame.aovs.push_back({"volume_slices", slice_picture(solution_->volume, frame.radiance.width_px,
                                                       frame.radiance.height_px)});
  const auto series = [](const glm::dvec3& value) {
    return std::vector<double>{value.x, value.y, value.z};
  };
  const Grid& grid = solution_->volume.grid;
  frame.counters.insert(frame.counters.end(),
                        {{"surface_samples", static_cast<double>(solution_->samples)},
                         {"sample_area_m2", solution_->area_m2},
                         {"cells", static_cast<double>(grid.cell_count())},
                         {"volume_bytes", static_cast<double>(solution_->volume_bytes)},
                         {"work_bytes", static_cast<double>(solution_->work_bytes)},
                         {"cell_m", static_cast<double>(grid.cell_m)},
                         {"steps", static_cast<double>(settings_.propagation.steps)},
                         {"injected_w", series(solution_->injected_w)},
                         {"left_w", series(solution_->left_w)}});
}

std::unique_ptr<Renderer> create(const base::Parameters& parameters, const Devices& devices) {
  return std::make_unique<LightPropagationRenderer>(parameters, devices);
}

}  // namespace

RendererInfo renderer_info() {
  RendererInfo info;
  info.name = "light-propagation";
  info.summary =
      "One bounce of light through a coarse volume of intensities, fed by samples on surfaces.";
  info.source =
      "Koa and Johan 2016, doi:10.1145/2949035.2949043, on Kaplanyan and Dachsbacher 2010, "
      "doi:10.1145/1730804.1730821";
  info.claims = [](const base::Parameters& parameters, const scene::Scene&) {
    return claims_of(parameters);
  };
  info.possible_claims = {{Transport::one_bounce, Part::all, std::nullopt},
                          {Transport::one_bounce, Part::indirect, std::nullopt}};
  info.supports = {Feature::point_light, Feature::spot_light, Feature::area_light,
                   Feature::environment, Feature::texture,    Feature::animation};
  info.uses_seed = true;
  info.parameters = parameter_specs();
  info.presets = presets();
  info.create = create;
  return info;
}

}  // namespace renderers::light_propagation
