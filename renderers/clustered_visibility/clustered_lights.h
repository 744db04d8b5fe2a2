#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "renderers/clustered_visibility/clustered_visibility_settings.h"
#include "renderers/clustered_visibility/convolution_maps.h"
#include "renderers/clustered_visibility/light_clusters.h"
#include "renderers/contract/stage_timer.h"
#include "renderers/many_lights/gather.h"
#include "renderers/opengl/gpu_scene.h"
#include "renderers/shadow_maps/map_filler.h"

namespace renderers::clustered_visibility {

/// Virtual point lights in clusters, with the shadows of each cluster.
class ClusteredLights {
 public:
  /// @throws UnsupportedError if maps of the sizes asked for do not fit the device
  ClusteredLights(std::shared_ptr<opengl::Context> context, const Settings& settings);

  /// Forgets the clusters that a warm start would begin with.
  void restart() { clusters_.restart(); }
  /// A new state of the scene, before `make`. Stages of `VertexMaps::load`, if it is used.
  void load(const scene::Scene& scene, StageTimer& timer);
  /// Clusters the lights, draws and filters a shadow map per cluster. Stages `cluster`, `shadow`,
  /// `filter/basis`. Everything stays on the device.
  /// @param lights    VirtualLight, as many as the settings' virtual_lights; read, not kept
  /// @param clusters  to make, at most the settings' number; 0: that number
  void make(const opengl::Buffer& lights, const opengl::GpuScene& scene, int clusters,
            StageTimer& timer);

  /// Sorts the lights of `make` for gathers of another interleave than the settings'.
  void sort_runs(const opengl::Buffer& lights, const opengl::GpuScene& scene, int interleave) {
    clusters_.sort_runs({.lights = &lights,
                         .count = settings_.virtual_lights,
                         .bounds = scene.bounds(),
                         .only = settings_.only_val},
                        interleave);
  }

  /// Adds their light to a gather. Not for visibility `oracle`.
  void gather(const opengl::GeometryBuffer& surfaces, const opengl::GpuScene& scene,
              const many_lights::GatherSettings& settings, many_lights::Gather& gather) const {
    gather_with(settings_.area, surfaces, scene, settings, gather);
  }
  /// The same with another test in the same maps.
  void gather_with(const AreaVisibilitySettings& area, const opengl::GeometryBuffer& surfaces,
                   const opengl::GpuScene& scene, const many_lights::GatherSettings& settings,
                   many_lights::Gather& gather) const;

  const LightClusters& clusters() const { return clusters_; }
  /// Shadows of the area lights; not for visibility `oracle`.
  AreaShadows shadows() const;
  const shadow_maps::MapFiller& filler() const { return filler_; }
  /// Of the layers that receivers look into: filtered ones, else those of distances.
  std::int64_t layer_bytes() const;
  /// Of the layers of distances, which filtered ones are made from.
  std::int64_t distance_bytes() const;
  std::int64_t memory_bytes() const;

 private:
  std::shared_ptr<opengl::Context> context_;
  Settings settings_;
  LightClusters clusters_;
  shadow_maps::MapFiller filler_;
  std::optional<shadow_maps::HemisphereMaps> maps_;
  std::optional<ConvolutionMaps> filtered_;
  std::optional<MomentMaps> moments_;
};

}  // namespace renderers::clustered_visibility
