#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "renderers/clustered_visibility/cluster_growth.h"
#include "renderers/clustered_visibility/clustered_lights.h"
#include "renderers/clustered_visibility/light_bounces.h"
#include "renderers/clustered_visibility/oracle_gather.h"
#include "renderers/contract/renderer.h"
#include "renderers/many_lights/gather.h"
#include "renderers/many_lights/geometry_aware_blur.h"
#include "renderers/many_lights/shade.h"
#include "renderers/many_lights/surface_image.h"
#include "renderers/many_lights/virtual_light_generator.h"
#include "renderers/opengl/geometry_buffer.h"
#include "renderers/opengl/gpu_scene.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::clustered_visibility {

/// The indirect light of a scene on the device: sets of lights in clusters, one per bounce, once
/// per state of the scene, then any number of pictures of it.
class ClusteredPicture {
 public:
  /// @throws UnsupportedError if maps of the sizes asked for do not fit the device
  ClusteredPicture(std::shared_ptr<opengl::Context> context, const Settings& settings);

  /// Forgets the clusters that a warm start would begin with.
  void restart() {
    lights_.restart();
    bounces_.restart();
  }
  /// A new state of the scene. Stages `triangles`, `tessellation` and `upload` under whatever is
  /// open.
  void load(const scene::Scene& scene, StageTimer& timer);
  /// Its lights, their clusters and shadows: of the first bounce in stages `lights`, `cluster`,
  /// `shadow`, `filter`, of the others as LightBounces::make. If the number of clusters follows the
  /// picture, `draw` makes all but the first lights, and `preview`.
  /// @param clamp  of the geometry term between bounces, 1/m2; 0: none
  /// @param rays   of the same scene; needed with visibility `oracle`
  void make_lights(double clamp, const ray_tracing::RayScene* rays, StageTimer& timer);

  /// Draws a picture. Stages `visibility`, `gather` (of several bounces `gather/bounce_1` and so
  /// on), `filter`, `transport`; nothing is read back but for visibility `oracle`.
  /// @param clamp, rays  as above, at the picture's surfaces
  void draw(const RenderJob& job, double clamp, const ray_tracing::RayScene* rays,
            StageTimer& timer);

  /// Of the last picture, which the device must have made: rgba, row-major, top row first.
  std::vector<float> read_radiance() const { return shade_.radiance().read(); }     ///< W/(m2 sr)
  std::vector<float> read_irradiance() const { return light().irradiance.read(); }  ///< W/m2
  const many_lights::SurfaceImage& surfaces();
  const opengl::GeometryBuffer& geometry() const { return *surfaces_; }

  /// Of the last picture and the bounces before it.
  OracleRays oracle_rays() const;
  const ClusteredLights& lights() const { return lights_; }  ///< of the first bounce
  const LightBounces& bounces() const { return bounces_; }   ///< those after it
  const ClusterGrowth& growth() const { return growth_; }
  const many_lights::VirtualLightGenerator& generator() const { return generator_; }
  const opengl::GpuScene& scene() const { return gpu_scene_; }
  std::int64_t memory_bytes() const;

 private:
  void make_bounces(double clamp, const ray_tracing::RayScene* rays, StageTimer& timer);
  void draw_surfaces(const RenderJob& job, StageTimer& timer);
  void gather(const many_lights::GatherSettings& settings, const ray_tracing::RayScene* rays,
              StageTimer& timer);
  void gather_by_rays(const many_lights::GatherSettings& settings,
                      const ray_tracing::RayScene& rays, StageTimer& timer);
  /// Of every bounce.
  std::vector<LightSet> sets() const;
  void blur(bool with_glossy, StageTimer& timer);
  many_lights::GatherTargets& light() {
    return settings_.has_maps() ? gather_.targets() : by_rays_;
  }
  const many_lights::GatherTargets& light() const {
    return settings_.has_maps() ? gather_.targets() : by_rays_;
  }

  std::shared_ptr<opengl::Context> context_;
  Settings settings_;
  const scene::Scene* scene_ = nullptr;
  opengl::GpuScene gpu_scene_;
  many_lights::VirtualLightGenerator generator_;
  ClusteredLights lights_;
  ClusterGrowth growth_;
  LightBounces bounces_;
  many_lights::Gather gather_;
  many_lights::GatherTargets by_rays_;
  many_lights::GeometryAwareBlur blur_;
  many_lights::Shade shade_;
  std::unique_ptr<opengl::GeometryBuffer> surfaces_;
  std::optional<many_lights::SurfaceImage> surface_image_;
  OracleRays oracle_rays_;
};

}  // namespace renderers::clustered_visibility
