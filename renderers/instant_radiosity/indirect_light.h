#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "renderers/contract/renderer.h"
#include "renderers/instant_radiosity/instant_radiosity_settings.h"
#include "renderers/many_lights/gather.h"
#include "renderers/many_lights/geometry_aware_blur.h"
#include "renderers/many_lights/ray_gather.h"
#include "renderers/many_lights/shade.h"
#include "renderers/many_lights/surface_image.h"
#include "renderers/many_lights/virtual_light_generator.h"
#include "renderers/opengl/geometry_buffer.h"
#include "renderers/opengl/gpu_scene.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/shadow_maps/hard_maps.h"
#include "renderers/shadow_maps/imperfect_maps.h"

namespace renderers::instant_radiosity {

/// One set of virtual lights through one point of every pixel.
struct LightSet {
  int index = 0;              ///< continues the lights' sequences
  glm::vec2 offset_px{0.0F};  ///< of the point from the pixel's centre
};

/// Rays of all sets so far.
struct VisibilityCounts {
  std::uint64_t rays = 0;
  std::uint64_t occluded = 0;
  std::uint64_t maps = 0;
};

/// The light of one bounce on the device: virtual lights, who sees them, gather, blur, shading.
class IndirectLight {
 public:
  /// @throws UnsupportedError if maps of the sizes asked for do not fit the device
  IndirectLight(std::shared_ptr<opengl::Context> context, const Settings& settings);

  /// A new state of the scene. Stages `triangles`, `upload`, `points` under whatever is open.
  void load(const scene::Scene& scene, StageTimer& timer);
  /// Forgets what of earlier scenes `load` would go on from.
  void restart() {
    if (imperfect_maps_) imperfect_maps_->restart();
  }
  /// A set of virtual lights, if it is not the one at hand. Stage `lights`.
  void make_lights(int set, StageTimer& timer);

  /// An empty picture. @param clamp  of the geometry term, 1/m2; 0: none
  void begin(const RenderJob& job, double clamp);
  /// Adds a set to the picture. Stages `lights`, `visibility`, `shadow`, `gather`, `filter`.
  /// @param rays  of the same scene; needed with visibility `ray`
  void add(const LightSet& set, const ray_tracing::RayScene* rays, StageTimer& timer);

  /// The last set's surfaces on the CPU; read at the first call.
  const many_lights::SurfaceImage& surfaces();
  /// Mean of the sets added so far; rgba, W/(m2 sr), waits for the device.
  std::vector<float> read_radiance() const;
  /// Irradiance of the last set after the blur; rgba, W/m2, waits for the device.
  std::vector<float> read_irradiance() const;

  /// Points of imperfect maps whose triangles are gone (ImperfectMaps::points_left_behind).
  std::size_t imperfect_points_left_behind() const {
    return imperfect_maps_ ? imperfect_maps_->points_left_behind() : 0;
  }
  const VisibilityCounts& counts() const { return counts_; }
  const many_lights::VirtualLightGenerator& generator() const { return generator_; }
  const opengl::GpuScene& scene() const { return gpu_scene_; }
  std::int64_t memory_bytes() const;

 private:
  void draw_surfaces(const LightSet& set, StageTimer& timer);
  void gather(const ray_tracing::RayScene* rays, StageTimer& timer);
  void gather_with_maps(StageTimer& timer);
  void gather_with_rays(const ray_tracing::RayScene& rays, StageTimer& timer);
  void blur(StageTimer& timer);
  many_lights::GatherTargets& light() { return is_ray_traced() ? by_rays_ : gather_.targets(); }
  bool is_ray_traced() const { return settings_.visibility == Visibility::ray; }

  std::shared_ptr<opengl::Context> context_;
  Settings settings_;
  const scene::Scene* scene_ = nullptr;
  opengl::GpuScene gpu_scene_;
  many_lights::VirtualLightGenerator generator_;
  int lights_set_ = -1;  ///< the set whose lights the generator holds; -1: none
  int point_set_ = 0;    ///< of the generator's emitters

  std::optional<shadow_maps::HemisphereMaps> maps_;
  std::optional<shadow_maps::HardMaps> hard_maps_;
  std::optional<shadow_maps::ImperfectMaps> imperfect_maps_;

  many_lights::GatherSettings gather_settings_;
  many_lights::Gather gather_;
  many_lights::GatherTargets by_rays_;
  many_lights::GeometryAwareBlur blur_;
  many_lights::Shade shade_;
  scene::Camera camera_;
  int sets_ = 0;
  std::unique_ptr<opengl::GeometryBuffer> surfaces_;
  std::optional<many_lights::SurfaceImage> surface_image_;
  VisibilityCounts counts_;
};

}  // namespace renderers::instant_radiosity
