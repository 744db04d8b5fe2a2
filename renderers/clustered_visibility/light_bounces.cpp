#include "renderers/clustered_visibility/light_bounces.h"

#include <cassert>
#include <string>
#include <utility>

#include "renderers/opengl/gpu_stage.h"

namespace renderers::clustered_visibility {

using opengl::GpuStage;

std::string bounce_name(std::size_t index) { return "bounce_" + std::to_string(index + 1); }

LightBounces::LightBounces(std::shared_ptr<opengl::Context> context, const Settings& settings)
    : context_(std::move(context)), settings_(settings), gather_(context_) {
  for (int bounce = 2; bounce <= settings.bounces; ++bounce) {
    bounces_.push_back(std::make_unique<Bounce>(context_, settings));
  }
}

void LightBounces::restart() {
  for (const auto& bounce : bounces_) bounce->clusters.restart();
}

void LightBounces::load(const scene::Scene& scene, StageTimer& timer) {
  for (const auto& bounce : bounces_) bounce->clusters.load(scene, timer);
}

void LightBounces::make(const opengl::Buffer& lights, ClusteredLights& clusters,
                        const BounceInput& input, StageTimer& timer) {
  oracle_rays_ = {};
  if (bounces_.empty()) return;
  const auto stage = timer.stage("lights");
  place_points(input, timer);
  const opengl::Buffer* source_lights = &lights;
  ClusteredLights* source_clusters = &clusters;
  for (std::size_t i = 0; i < bounces_.size(); ++i) {
    const auto bounce_stage = timer.stage(bounce_name(i + 1));
    Bounce& bounce = *bounces_[i];
    const opengl::Texture& irradiance =
        gather({*source_lights, *source_clusters}, bounce.points, input, timer);
    {
      const GpuStage emit(*context_, timer, "emit");
      bounce.points.emit(irradiance);
    }
    bounce.clusters.make(bounce.points.lights(), input.gpu_scene, input.clusters, timer);
    source_lights = &bounce.points.lights();
    source_clusters = &bounce.clusters;
  }
}

void LightBounces::place_points(const BounceInput& input, StageTimer& timer) {
  const GpuStage stage(*context_, timer, "points");
  for (std::size_t i = 0; i < bounces_.size(); ++i) {
    bounces_[i]->points.place(
        shadow_maps::surface_points(input.scene, static_cast<int>(i), settings_.virtual_lights),
        input.gpu_scene);
  }
}

const opengl::Texture& LightBounces::gather(const Source& source, const ReEmission& points,
                                            const BounceInput& input, StageTimer& timer) {
  // Every light at every point; lobes reflect at the last surface alone (DESIGN, `diffuse`).
  many_lights::GatherSettings settings;
  settings.interleave = 1;
  settings.geometry_clamp = static_cast<float>(input.clamp);
  if (!settings_.has_maps()) {
    gather_by_rays(source, points, input, settings, timer);
    return by_rays_.irradiance;
  }
  const GpuStage stage(*context_, timer, "gather");
  AreaVisibilitySettings area = settings_.area;
  area.test = AreaTest::hard;
  source.clusters.sort_runs(source.lights, input.gpu_scene, settings.interleave);
  gather_.begin(points.receivers(), settings);
  source.clusters.gather_with(area, points.receivers(), input.gpu_scene, settings, gather_);
  source.clusters.sort_runs(source.lights, input.gpu_scene, settings_.interleave);
  return gather_.targets().irradiance;
}

void LightBounces::gather_by_rays(const Source& source, const ReEmission& points,
                                  const BounceInput& input,
                                  const many_lights::GatherSettings& settings, StageTimer& timer) {
  assert(input.rays);
  const auto stage = timer.stage("gather");
  const many_lights::SurfaceImage surfaces = many_lights::read_surfaces(points.receivers());
  const many_lights::GatheredLight gathered =
      gather_by_oracle({input.scene, surfaces, *input.rays}, {&source.lights, &source.clusters},
                       settings_.virtual_lights, settings, timer);
  oracle_rays_ += {gathered.rays, gathered.occluded};
  many_lights::write_light(context_, points.receivers(), gathered, by_rays_);
}

std::int64_t LightBounces::layer_bytes() const {
  std::int64_t bytes = 0;
  for (const auto& bounce : bounces_) bytes += bounce->clusters.layer_bytes();
  return bytes;
}

std::int64_t LightBounces::memory_bytes() const {
  std::int64_t bytes = gather_.memory_bytes();
  for (const auto& bounce : bounces_) {
    bytes += bounce->points.memory_bytes() + bounce->clusters.memory_bytes();
  }
  if (!by_rays_.irradiance.is_empty()) {
    bytes += opengl::size_bytes_of(by_rays_.irradiance.shape());
  }
  return bytes;
}

}  // namespace renderers::clustered_visibility
