#include "renderers/clustered_visibility/clustered_lights.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "renderers/clustered_visibility/loop_turns.h"
#include "renderers/opengl/gpu_stage.h"

namespace renderers::clustered_visibility {

using opengl::GpuStage;

namespace {

/// Lights of a pixel's run per area light from which a visibility is asked for ahead of them
/// (gather.glsl). Measured on Mesa's software driver, 1024 lights, 30 area lights: 34 lights a
/// group gather 7 to 11 times as fast.
constexpr int kLongGroup = 4;

}  // namespace

ClusteredLights::ClusteredLights(std::shared_ptr<opengl::Context> context, const Settings& settings)
    : context_(std::move(context)),
      settings_(settings),
      clusters_(context_, settings.clusters),
      filler_(context_, settings.depth, settings.vertex_maps) {
  if (!settings.has_maps()) return;
  maps_.emplace(context_, settings.shadow_map_px, settings.clusters.clusters);
  const int layers = settings.clusters.clusters;
  if (settings.visibility == Visibility::cssm) {
    filtered_.emplace(context_, settings.shadow_map_px, layers, settings.convolution);
  }
  if (settings.visibility == Visibility::msm) {
    moments_.emplace(context_, settings.shadow_map_px, layers);
  }
}

void ClusteredLights::load(const scene::Scene& scene, StageTimer& timer) {
  if (maps_) filler_.load(scene, timer);
}

void ClusteredLights::make(const opengl::Buffer& lights, const opengl::GpuScene& scene,
                           int clusters, StageTimer& timer) {
  {
    const GpuStage stage(*context_, timer, "cluster");
    const ClusterInput input{&lights, settings_.virtual_lights, scene.bounds(), clusters,
                             settings_.only_val};
    clusters_.update(input);
    clusters_.sort_runs(input, settings_.interleave);
    context_->check("clustering lights");
  }
  if (!maps_) return;
  {
    const GpuStage stage(*context_, timer, "shadow");
    filler_.fill(*maps_, scene, {&clusters_.area_lights(), kAreaLightStride}, 0,
                 clusters_.used_clusters());
  }
  if (!filtered_ && !moments_) return;
  const auto filter = timer.stage("filter");
  const GpuStage stage(*context_, timer, "basis");
  if (filtered_) filtered_->make(*maps_, clusters_.area_lights());
  if (moments_) moments_->make(*maps_, clusters_.area_lights());
}

void ClusteredLights::gather_with(const AreaVisibilitySettings& area,
                                  const opengl::GeometryBuffer& surfaces,
                                  const opengl::GpuScene& scene,
                                  const many_lights::GatherSettings& settings,
                                  many_lights::Gather& gather) const {
  const AreaShadows shadows = this->shadows();
  many_lights::GatherVisibility visibility = gather_visibility(area, shadows);
  const int count = settings_.virtual_lights;
  // Of a pixel; the longest.
  const int classes = settings.interleave * settings.interleave;
  const int run = (count + classes - 1) / classes;
  if (run >= kLongGroup * clusters_.used_clusters()) {
    visibility.defines.emplace_back("WITH_LONG_GROUPS", "1");
  }
  const int most =
      most_lights_at_once(area, shadows.filtered).value_or(run > kMostTurns ? kMostTurns : count);
  for (int first = 0; first < count; first += most) {
    gather.add(surfaces, scene,
               {.lights = &clusters_.sorted(),
                .count = count,
                .first = first,
                .batch = std::min(most, count - first),
                .visibility = &visibility},
               settings);
  }
}

AreaShadows ClusteredLights::shadows() const {
  assert(maps_);
  return {clusters_.area_lights(), *maps_, filtered_ ? &*filtered_ : nullptr,
          moments_ ? &*moments_ : nullptr};
}

std::int64_t ClusteredLights::layer_bytes() const {
  if (filtered_) return filtered_->layer_bytes();
  if (moments_) return moments_->layer_bytes();
  return distance_bytes();
}

std::int64_t ClusteredLights::distance_bytes() const {
  return maps_ ? opengl::size_bytes_of(maps_->distances().shape()) : 0;
}

std::int64_t ClusteredLights::memory_bytes() const {
  std::int64_t bytes = clusters_.memory_bytes() + filler_.memory_bytes();
  bytes += distance_bytes();
  if (filtered_) bytes += filtered_->memory_bytes();
  if (moments_) bytes += moments_->memory_bytes();
  return bytes;
}

}  // namespace renderers::clustered_visibility
