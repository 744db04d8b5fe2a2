#include "renderers/clustered_visibility/clustered_picture.h"

#include <cassert>
#include <span>
#include <utility>

#include "renderers/many_lights/ray_gather.h"
#include "renderers/opengl/gpu_stage.h"
#include "renderers/opengl/view.h"

namespace renderers::clustered_visibility {

using opengl::GpuStage;

ClusteredPicture::ClusteredPicture(std::shared_ptr<opengl::Context> context,
                                   const Settings& settings)
    : context_(std::move(context)),
      settings_(settings),
      gpu_scene_(context_),
      generator_(context_, many_lights::generator_settings(settings)),
      lights_(context_, settings),
      growth_(context_, settings),
      bounces_(context_, settings),
      gather_(context_),
      blur_(context_),
      shade_(context_) {}

void ClusteredPicture::load(const scene::Scene& scene, StageTimer& timer) {
  scene_ = &scene;
  gpu_scene_.load(scene, timer);
  generator_.load(scene);
  lights_.load(scene, timer);
  bounces_.load(scene, timer);
}

void ClusteredPicture::make_lights(double clamp, const ray_tracing::RayScene* rays,
                                   StageTimer& timer) {
  generator_.generate(gpu_scene_, 0, timer);
  if (settings_.growth.is_on) return;
  lights_.make(generator_.lights(), gpu_scene_, 0, timer);
  make_bounces(clamp, rays, timer);
}

void ClusteredPicture::make_bounces(double clamp, const ray_tracing::RayScene* rays,
                                    StageTimer& timer) {
  const int clusters = lights_.clusters().used_clusters();
  bounces_.make(generator_.lights(), lights_, {*scene_, gpu_scene_, clamp, rays, clusters}, timer);
}

void ClusteredPicture::draw(const RenderJob& job, double clamp, const ray_tracing::RayScene* rays,
                            StageTimer& timer) {
  many_lights::GatherSettings settings;
  settings.interleave = settings_.interleave;
  settings.geometry_clamp = static_cast<float>(clamp);
  settings.with_glossy = gpu_scene_.has_glossy();
  settings.camera_position = job.camera.position;
  oracle_rays_ = {};
  if (settings_.growth.is_on) {
    growth_.grow({job, gpu_scene_, generator_.lights(), clamp, rays, scene_->luminance_scale_cd_m2},
                 lights_, timer);
    make_bounces(clamp, rays, timer);
  }
  draw_surfaces(job, timer);
  gather(settings, rays, timer);
  if (settings_.has_blur()) blur(settings.with_glossy, timer);
  const GpuStage stage(*context_, timer, "transport");
  shade_.begin(job.width_px, job.height_px);
  shade_.add(*surfaces_, light(), settings.with_glossy, 1.0F);
  context_->check("making indirect light");
}

void ClusteredPicture::draw_surfaces(const RenderJob& job, StageTimer& timer) {
  const GpuStage stage(*context_, timer, "visibility");
  surface_image_.reset();
  if (!surfaces_ || surfaces_->width_px() != job.width_px ||
      surfaces_->height_px() != job.height_px) {
    surfaces_.reset();  // its memory goes before that of the next
    surfaces_ = std::make_unique<opengl::GeometryBuffer>(context_, job.width_px, job.height_px);
  }
  surfaces_->render(gpu_scene_, opengl::camera_view(job.camera, job.width_px, job.height_px));
}

void ClusteredPicture::gather(const many_lights::GatherSettings& settings,
                              const ray_tracing::RayScene* rays, StageTimer& timer) {
  if (!settings_.has_maps()) {
    assert(rays);
    gather_by_rays(settings, *rays, timer);
    return;
  }
  const GpuStage stage(*context_, timer, "gather");
  gather_.begin(*surfaces_, settings);
  if (bounces_.count() == 0) {
    lights_.gather(*surfaces_, gpu_scene_, settings, gather_);
    return;
  }
  const std::vector<LightSet> sets = this->sets();
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const GpuStage bounce(*context_, timer, bounce_name(i));
    sets[i].clusters->gather(*surfaces_, gpu_scene_, settings, gather_);
  }
}

void ClusteredPicture::gather_by_rays(const many_lights::GatherSettings& settings,
                                      const ray_tracing::RayScene& rays, StageTimer& timer) {
  const auto stage = timer.stage("gather");
  {
    const auto transfer = timer.stage("transfer");
    surfaces();
  }
  many_lights::GatheredLight sum;
  for (const LightSet& set : sets()) {
    many_lights::GatheredLight gathered = gather_by_oracle(
        {*scene_, *surface_image_, rays}, set, settings_.virtual_lights, settings, timer);
    if (sum.irradiance.empty()) {
      sum = std::move(gathered);
    } else {
      add_light(gathered, sum);
    }
  }
  oracle_rays_ = {sum.rays, sum.occluded};
  const auto transfer = timer.stage("transfer");
  many_lights::write_light(context_, *surfaces_, sum, by_rays_);
}

std::vector<LightSet> ClusteredPicture::sets() const {
  std::vector<LightSet> sets{{&generator_.lights(), &lights_, settings_.only_val}};
  for (std::size_t i = 0; i < bounces_.count(); ++i) sets.push_back(bounces_.set(i));
  return sets;
}

OracleRays ClusteredPicture::oracle_rays() const {
  OracleRays rays = oracle_rays_;
  return rays += bounces_.oracle_rays();
}

void ClusteredPicture::blur(bool with_glossy, StageTimer& timer) {
  const auto filter = timer.stage("filter");
  const GpuStage stage(*context_, timer, "blur");
  const many_lights::BlurSettings settings =
      many_lights::blur_settings(settings_, gpu_scene_.bounds().diagonal_m());
  blur_.apply(*surfaces_, settings, light().irradiance);
  if (with_glossy) blur_.apply(*surfaces_, settings, light().glossy);
}

const many_lights::SurfaceImage& ClusteredPicture::surfaces() {
  if (!surface_image_) surface_image_ = many_lights::read_surfaces(*surfaces_);
  return *surface_image_;
}

std::int64_t ClusteredPicture::memory_bytes() const {
  std::int64_t bytes = gpu_scene_.memory_bytes() + generator_.memory_bytes() +
                       lights_.memory_bytes() + growth_.memory_bytes() + bounces_.memory_bytes() +
                       gather_.memory_bytes() + blur_.memory_bytes();
  if (surfaces_) bytes += surfaces_->memory_bytes();
  for (const opengl::Texture* texture :
       {&shade_.radiance(), &by_rays_.irradiance, &by_rays_.glossy}) {
    if (!texture->is_empty()) bytes += opengl::size_bytes_of(texture->shape());
  }
  return bytes;
}

}  // namespace renderers::clustered_visibility
