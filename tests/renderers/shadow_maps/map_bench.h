#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "renderers/opengl/gpu_scene.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/shadow_maps/hard_maps.h"
#include "renderers/shadow_maps/hemicube_maps.h"
#include "renderers/shadow_maps/hemisphere_maps.h"
#include "renderers/shadow_maps/imperfect_maps.h"
#include "renderers/shadow_maps/vertex_maps.h"

/// Shadow maps of small scenes on the device, and what rays say about them.
namespace renderers::test {

/// An element of a MapOrigins buffer of stride 2.
struct Origin {
  glm::vec4 position{0.0F};  ///< w: 0 for an empty map
  glm::vec4 axis{0.0F};
};
Origin origin_at(const glm::vec3& position, const glm::vec3& axis);

/// One context for all tests of the process.
std::shared_ptr<opengl::Context> shared_context();

/// A scene on the device and ready for rays.
class MapBench {
 public:
  explicit MapBench(const scene::Scene& scene,
                    std::shared_ptr<opengl::Context> context = shared_context());

  shadow_maps::HemisphereMaps hard_maps(int size_px, const std::vector<Origin>& origins,
                                        const shadow_maps::HardMapSettings& settings = {},
                                        shadow_maps::HardMapWork* work = nullptr) const;
  shadow_maps::HemisphereMaps hemicube_maps(
      int size_px, const std::vector<Origin>& origins,
      const shadow_maps::HemicubeMapSettings& settings = {}) const;
  shadow_maps::HemisphereMaps imperfect_maps(
      int size_px, const std::vector<Origin>& origins,
      const shadow_maps::ImperfectMapSettings& settings = {}) const;

  shadow_maps::HemisphereMaps vertex_maps(
      int size_px, const std::vector<Origin>& origins,
      const shadow_maps::VertexMapSettings& settings = {}) const;

  const scene::Scene& scene() const { return scene_; }
  const ray_tracing::RayScene& rays() const { return rays_; }
  const opengl::GpuScene& gpu() const { return gpu_; }
  const std::shared_ptr<opengl::Context>& context() const { return context_; }
  float diagonal_m() const { return gpu_.bounds().diagonal_m(); }

 private:
  std::shared_ptr<opengl::Context> context_;
  StageTimer timer_;
  scene::Scene scene_;
  ray_tracing::RayScene rays_;
  opengl::GpuScene gpu_;
};

/// Origins spread over the scene's surfaces, each on the front side of its triangle.
std::vector<Origin> origins_on_surfaces(const scene::Scene& scene, int count);

/// A point whose visibility from the origin of a layer is asked for.
struct Lookup {
  glm::vec4 receiver{0.0F};  ///< w: layer
  glm::vec4 normal{0.0F};    ///< xyz, unit length; w: 0
};

/// hemisphere_visibility of shaders/hemisphere_map.glsl for each lookup.
std::vector<float> visibilities(const shadow_maps::HemisphereMaps& maps,
                                const std::vector<Origin>& origins,
                                const std::vector<Lookup>& lookups,
                                const shadow_maps::LookupBias& bias);

/// Distance from a map's centre along the ray of a position, by Embree; infinity without a hit.
float ray_distance(const MapBench& bench, const Origin& origin, float near_m,
                   const glm::dvec2& position);

/// Values of a layer's texels as metres, row-major.
std::vector<float> distances_of(const shadow_maps::HemisphereMaps& maps, int layer);

}  // namespace renderers::test
