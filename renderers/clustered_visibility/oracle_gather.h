#pragma once

#include <cstdint>

#include "renderers/clustered_visibility/clustered_lights.h"
#include "renderers/many_lights/ray_gather.h"
#include "renderers/many_lights/surface_image.h"
#include "renderers/opengl/buffer.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::clustered_visibility {

/// A set of virtual point lights on the device and its clusters.
struct LightSet {
  const opengl::Buffer* lights = nullptr;  ///< VirtualLight
  const ClusteredLights* clusters = nullptr;
  int only = -1;  ///< cluster whose lights alone are lit; -1: all
};

struct OracleRays {
  std::uint64_t traced = 0;
  std::uint64_t occluded = 0;

  OracleRays& operator+=(const OracleRays& other) {
    traced += other.traced;
    occluded += other.occluded;
    return *this;
  }
};

/// Where visibility `oracle` gathers.
struct OracleReceivers {
  const scene::Scene& scene;
  const many_lights::SurfaceImage& surfaces;
  const ray_tracing::RayScene& rays;  ///< of the same scene
};

/// Light of a set at surfaces: of each cluster the mean visibility of its lights, by rays. Reads
/// the set back in stage `transfer`.
/// @param light_count  of the set
many_lights::GatheredLight gather_by_oracle(const OracleReceivers& receivers, const LightSet& set,
                                            int light_count,
                                            const many_lights::GatherSettings& settings,
                                            StageTimer& timer);

/// Adds light at the same surfaces, its rays too.
void add_light(const many_lights::GatheredLight& added, many_lights::GatheredLight& sum);

}  // namespace renderers::clustered_visibility
