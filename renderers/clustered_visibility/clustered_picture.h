#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "renderers/clustered_visibility/clustered_lights.h"
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

/// Rays of the last picture, visibility `oracle` only.
struct OracleRays {
  std::uint64_t traced = 0;
  std::uint64_t occluded = 0;
};

/// The indirect light of a scene on the device: lights in clusters once per state of the scene,
/// then any number of pictures of it.
class ClusteredPicture {
 public:
  /// @throws UnsupportedError if maps of the sizes asked for do not fit the device
  ClusteredPicture(std::shared_ptr<opengl::Context> context, const Settings& settings);

  /// Forgets the clusters that a warm start would begin with.
  void restart() { lights_.restart(); }
  /// A new state of the scene. Stages `triangles`, `tessellation` and `upload` under whatever is
  /// open.
  void load(const scene::Scene& scene, StageTimer& timer);
  /// Its lights, their clusters and shadows. Stages `lights`, `cluster`, `shadow`, `filter`.
  void make_lights(StageTimer& timer);

  /// Draws a picture. Stages `visibility`, `gather`, `filter`, `transport`; nothing is read
  /// back but for visibility `oracle`.
  /// @param clamp  of the geometry term, 1/m2; 0: none
  /// @param rays   of the same scene; needed with visibility `oracle`
  void draw(const RenderJob& job, double clamp, const ray_tracing::RayScene* rays,
            StageTimer& timer);

  /// Of the last picture, which the device must have made: rgba, row-major, top row first.
  std::vector<float> read_radiance() const { return shade_.radiance().read(); }     ///< W/(m2 sr)
  std::vector<float> read_irradiance() const { return light().irradiance.read(); }  ///< W/m2
  const many_lights::SurfaceImage& surfaces();
  const opengl::GeometryBuffer& geometry() const { return *surfaces_; }

  const OracleRays& oracle_rays() const { return oracle_rays_; }
  const ClusteredLights& lights() const { return lights_; }
  const many_lights::VirtualLightGenerator& generator() const { return generator_; }
  const opengl::GpuScene& scene() const { return gpu_scene_; }
  std::int64_t memory_bytes() const;

 private:
  void draw_surfaces(const RenderJob& job, StageTimer& timer);
  void gather(const many_lights::GatherSettings& settings, const ray_tracing::RayScene* rays,
              StageTimer& timer);
  void gather_by_rays(const many_lights::GatherSettings& settings,
                      const ray_tracing::RayScene& rays, StageTimer& timer);
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
  many_lights::Gather gather_;
  many_lights::GatherTargets by_rays_;
  many_lights::GeometryAwareBlur blur_;
  many_lights::Shade shade_;
  std::unique_ptr<opengl::GeometryBuffer> surfaces_;
  std::optional<many_lights::SurfaceImage> surface_image_;
  OracleRays oracle_rays_;
};

}  // namespace renderers::clustered_visibility
