#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "renderers/clustered_visibility/clustered_lights.h"
#include "renderers/clustered_visibility/oracle_gather.h"
#include "renderers/clustered_visibility/re_emission.h"
#include "renderers/contract/stage_timer.h"
#include "renderers/many_lights/gather.h"
#include "renderers/many_lights/virtual_light_generator.h"
#include "renderers/opengl/gpu_scene.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/scene/scene.h"

namespace renderers::clustered_visibility {

/// Stage of a set's work: bounce_1, bounce_2, ... @param index  0: the first set
std::string bounce_name(std::size_t index);

/// A state of the scene, and what light is bounded by.
struct BounceInput {
  const scene::Scene& scene;
  const opengl::GpuScene& gpu_scene;            ///< of the same state
  double clamp = 0.0;                           ///< of the geometry term, 1/m2; 0: none
  const ray_tracing::RayScene* rays = nullptr;  ///< of the same scene; visibility `oracle` only
  int clusters = 0;                             ///< of every set, as ClusteredLights::make
};

/// The sets of virtual lights of the bounces after the first, each with clusters and shadows of its
/// own. A set is what surface points re-emit (re_emission.h) of the light of the set before it; no
/// light is dealt twice, and each set is as large as the first.
///
/// With maps, points see an area light by one test in its map (AreaTest::hard), whatever the
/// picture's: what soft shadows leak next to blockers would light the insides of solids, and be
/// re-emitted. Nothing of a band shows in sums over so many points. Measured in cornell-horse-17k:
/// flux of bounces 2 to 4 over that by rays 1.00, 1.05, 1.14, with the picture's cssm 1.06, 1.23,
/// 1.56.
class LightBounces {
 public:
  /// @throws UnsupportedError if maps of the sizes asked for do not fit the device
  LightBounces(std::shared_ptr<opengl::Context> context, const Settings& settings);

  /// Forgets the clusters that a warm start would begin with.
  void restart();
  /// A new state of the scene, before `make`. Stages of ClusteredLights::load.
  void load(const scene::Scene& scene, StageTimer& timer);
  /// Makes the sets. Everything stays on the device but for visibility `oracle`. Stages
  /// `lights/points`, and under `lights/bounce_2` and on: `gather`, `emit`, those of
  /// ClusteredLights::make.
  /// @param lights    the first set's, VirtualLight
  /// @param clusters  that have made them
  void make(const opengl::Buffer& lights, ClusteredLights& clusters, const BounceInput& input,
            StageTimer& timer);

  /// Sets after the first.
  std::size_t count() const { return bounces_.size(); }
  LightSet set(std::size_t index) const {
    return {&bounces_[index]->points.lights(), &bounces_[index]->clusters};
  }
  const ReEmission& points(std::size_t index) const { return bounces_[index]->points; }
  /// Rays of the last `make`, visibility `oracle` only.
  const OracleRays& oracle_rays() const { return oracle_rays_; }
  std::int64_t layer_bytes() const;  ///< as ClusteredLights::layer_bytes
  std::int64_t memory_bytes() const;

 private:
  struct Bounce {
    Bounce(const std::shared_ptr<opengl::Context>& context, const Settings& settings)
        : points(context, settings.virtual_lights), clusters(context, settings) {}
    ReEmission points;  ///< that receive and emit
    ClusteredLights clusters;
  };
  struct Source {
    const opengl::Buffer& lights;
    ClusteredLights& clusters;
  };

  void place_points(const BounceInput& input, StageTimer& timer);
  /// Light of a set at a bounce's points. @return irradiance, W/m2
  const opengl::Texture& gather(const Source& source, const ReEmission& points,
                                const BounceInput& input, StageTimer& timer);
  void gather_by_rays(const Source& source, const ReEmission& points, const BounceInput& input,
                      const many_lights::GatherSettings& settings, StageTimer& timer);

  std::shared_ptr<opengl::Context> context_;
  Settings settings_;
  std::vector<std::unique_ptr<Bounce>> bounces_;
  many_lights::Gather gather_;
  many_lights::GatherTargets by_rays_;
  OracleRays oracle_rays_;
};

}  // namespace renderers::clustered_visibility
