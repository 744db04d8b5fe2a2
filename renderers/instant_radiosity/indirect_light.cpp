#include "renderers/instant_radiosity/indirect_light.h"

#include <algorithm>
#include <cassert>

#include "renderers/opengl/gpu_stage.h"
#include "renderers/opengl/view.h"

namespace renderers::instant_radiosity {

namespace {

using many_lights::VirtualLight;
using opengl::GpuStage;

constexpr int kLightStride = static_cast<int>(sizeof(VirtualLight) / sizeof(glm::vec4));

shadow_maps::ImperfectMapSettings imperfect_settings(const Settings& settings) {
  shadow_maps::ImperfectMapSettings imperfect;
  imperfect.points_per_map = settings.imperfect_points;
  imperfect.keeps_points = settings.keeps_imperfect_points;
  if (!settings.fills_holes) imperfect.pull_push_levels = 0;
  return imperfect;
}

}  // namespace

IndirectLight::IndirectLight(std::shared_ptr<opengl::Context> context, const Settings& settings)
    : context_(context),
      settings_(settings),
      gpu_scene_(context),
      generator_(context, many_lights::generator_settings(settings)),
      gather_(context),
      blur_(context),
      shade_(context) {
  const bool is_hard = settings.visibility == Visibility::shadow_map;
  const bool is_imperfect = settings.visibility == Visibility::imperfect;
  if (!is_hard && !is_imperfect) return;
  maps_.emplace(context_, settings.shadow_map_px,
                std::min(settings.virtual_lights, settings.shadow_map_batch));
  if (is_hard) hard_maps_.emplace(context_);
  if (is_imperfect) imperfect_maps_.emplace(context_, imperfect_settings(settings));
}

void IndirectLight::load(const scene::Scene& scene, StageTimer& timer) {
  scene_ = &scene;
  lights_set_ = -1;
  point_set_ = 0;
  gpu_scene_.load(scene, timer);
  generator_.load(scene);
  if (imperfect_maps_) imperfect_maps_->load(scene, timer);
}

void IndirectLight::make_lights(int set, StageTimer& timer) {
  if (lights_set_ == set) return;
  // Every set sees area lights and environment from other points, so that their mean converges.
  if (set != point_set_ && generator_.has_point_sets()) {
    const auto stage = timer.stage("lights");
    generator_.use_point_set(*scene_, set);
    point_set_ = set;
  }
  generator_.generate(gpu_scene_, set, timer);
  lights_set_ = set;
}

void IndirectLight::begin(const RenderJob& job, double clamp) {
  if (!surfaces_ || surfaces_->width_px() != job.width_px ||
      surfaces_->height_px() != job.height_px) {
    surfaces_.reset();  // its memory goes before that of the next
    surfaces_ = std::make_unique<opengl::GeometryBuffer>(context_, job.width_px, job.height_px);
  }
  camera_ = job.camera;
  gather_settings_.interleave = settings_.interleave;
  gather_settings_.geometry_clamp = static_cast<float>(clamp);
  gather_settings_.with_glossy = gpu_scene_.has_glossy();
  gather_settings_.camera_position = job.camera.position;
  shade_.begin(job.width_px, job.height_px);
  sets_ = 0;
  counts_ = {};
}

void IndirectLight::add(const LightSet& set, const ray_tracing::RayScene* rays, StageTimer& timer) {
  make_lights(set.index, timer);
  draw_surfaces(set, timer);
  gather(rays, timer);
  if (settings_.has_blur()) blur(timer);
  {
    const GpuStage stage(*context_, timer, "transport");
    shade_.add(*surfaces_, light(), gather_settings_.with_glossy, 1.0F);
  }
  ++sets_;
  context_->check("making indirect light");
}

void IndirectLight::draw_surfaces(const LightSet& set, StageTimer& timer) {
  const GpuStage stage(*context_, timer, "visibility");
  surface_image_.reset();
  surfaces_->render(gpu_scene_, opengl::camera_view(camera_, surfaces_->width_px(),
                                                    surfaces_->height_px(), set.offset_px));
}

void IndirectLight::gather(const ray_tracing::RayScene* rays, StageTimer& timer) {
  if (is_ray_traced()) {
    assert(rays);
    gather_with_rays(*rays, timer);
    return;
  }
  gather_.begin(*surfaces_, gather_settings_);
  if (maps_) {
    gather_with_maps(timer);
    return;
  }
  const GpuStage stage(*context_, timer, "gather");
  const int count = generator_.light_count();
  gather_.add(*surfaces_, gpu_scene_,
              {.lights = &generator_.lights(), .count = count, .first = 0, .batch = count},
              gather_settings_);
}

void IndirectLight::gather_with_maps(StageTimer& timer) {
  const shadow_maps::MapOrigins origins{&generator_.lights(), kLightStride};
  const int count = generator_.light_count();
  for (int first = 0; first < count; first += maps_->layers()) {
    const int batch = std::min(maps_->layers(), count - first);
    {
      const GpuStage stage(*context_, timer, "shadow");
      if (hard_maps_) hard_maps_->fill(*maps_, gpu_scene_, origins, first, batch);
      if (imperfect_maps_) imperfect_maps_->fill(*maps_, origins, first, batch);
    }
    const GpuStage stage(*context_, timer, "gather");
    gather_.add(*surfaces_, gpu_scene_,
                {.lights = &generator_.lights(),
                 .count = count,
                 .first = first,
                 .batch = batch,
                 .maps = &*maps_,
                 .bias = hard_maps_ ? shadow_maps::LookupBias{} : shadow_maps::kImperfectBias},
                gather_settings_);
  }
  counts_.maps += static_cast<std::uint64_t>(count);
}

void IndirectLight::gather_with_rays(const ray_tracing::RayScene& rays, StageTimer& timer) {
  const auto stage = timer.stage("gather");
  std::vector<VirtualLight> lights;
  {
    const auto transfer = timer.stage("transfer");
    lights =
        generator_.lights().read<VirtualLight>(static_cast<std::size_t>(generator_.light_count()));
    surfaces();
  }
  const many_lights::GatheredLight gathered = many_lights::gather_by_rays(
      {.scene = *scene_, .surfaces = *surface_image_, .lights = lights, .rays = &rays},
      gather_settings_);
  counts_.rays += gathered.rays;
  counts_.occluded += gathered.occluded;
  const auto transfer = timer.stage("transfer");
  many_lights::write_light(context_, *surfaces_, gathered, by_rays_);
}

void IndirectLight::blur(StageTimer& timer) {
  const GpuStage stage(*context_, timer, "filter");
  const many_lights::BlurSettings settings =
      many_lights::blur_settings(settings_, gpu_scene_.bounds().diagonal_m());
  blur_.apply(*surfaces_, settings, light().irradiance);
  if (gather_settings_.with_glossy) blur_.apply(*surfaces_, settings, light().glossy);
}

const many_lights::SurfaceImage& IndirectLight::surfaces() {
  if (!surface_image_) surface_image_ = many_lights::read_surfaces(*surfaces_);
  return *surface_image_;
}

std::vector<float> IndirectLight::read_radiance() const {
  std::vector<float> values = shade_.radiance().read();
  for (float& value : values) value /= static_cast<float>(sets_);
  return values;
}

std::vector<float> IndirectLight::read_irradiance() const {
  return (is_ray_traced() ? by_rays_ : gather_.targets()).irradiance.read();
}

std::int64_t IndirectLight::memory_bytes() const {
  std::int64_t bytes = gpu_scene_.memory_bytes() + generator_.memory_bytes() +
                       gather_.memory_bytes() + blur_.memory_bytes();
  if (maps_) bytes += opengl::size_bytes_of(maps_->distances().shape());
  if (hard_maps_) bytes += hard_maps_->memory_bytes();
  if (imperfect_maps_) bytes += imperfect_maps_->memory_bytes();
  if (surfaces_) bytes += surfaces_->memory_bytes();
  for (const opengl::Texture* texture :
       {&shade_.radiance(), &by_rays_.irradiance, &by_rays_.glossy}) {
    if (!texture->is_empty()) bytes += opengl::size_bytes_of(texture->shape());
  }
  return bytes;
}

}  // namespace renderers::instant_radiosity
