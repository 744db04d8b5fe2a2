#pragma once

#include <cstdint>
#include <memory>
#include <variant>

#include "renderers/contract/stage_timer.h"
#include "renderers/opengl/gpu_scene.h"
#include "renderers/scene/scene.h"
#include "renderers/shadow_maps/hard_maps.h"
#include "renderers/shadow_maps/hemicube_maps.h"
#include "renderers/shadow_maps/vertex_maps.h"

namespace renderers::shadow_maps {

/// How hemispherical maps are filled: `HardMaps`, `HemicubeMaps` or `VertexMaps`.
enum class DepthBackend { exact, hemicube, vertex };

/// Fills hemispherical maps in the way chosen.
class MapFiller {
 public:
  /// @param vertex  for `DepthBackend::vertex` alone
  /// @throws UnsupportedError if the device lacks the layer choice asked for
  MapFiller(std::shared_ptr<opengl::Context> context, DepthBackend backend,
            const VertexMapSettings& vertex);

  /// A new state of the scene, before `fill`. Stages of `VertexMaps::load`, else none.
  /// @throws UnsupportedError as VertexMaps::load
  void load(const scene::Scene& scene, StageTimer& timer);
  /// Draws the triangles into layers [0, count), seen from origins [first, first + count), and
  /// clears the rest.
  /// @throws UnsupportedError as HemicubeMaps::fill; base::DeviceError if the device fails
  void fill(HemisphereMaps& maps, const opengl::GpuScene& scene, const MapOrigins& origins,
            int first, int count);
  /// Triangles that go through the rasteriser or the shaders per map; those of the scene, but for
  /// `DepthBackend::vertex`, which cuts them.
  int triangle_count(const opengl::GpuScene& scene) const;
  /// Draw calls that fill so many maps; 0 for `DepthBackend::exact`, which computes.
  int draw_count(int maps) const;
  std::int64_t memory_bytes() const;

 private:
  std::variant<HardMaps, HemicubeMaps, VertexMaps> maps_;
};

}  // namespace renderers::shadow_maps
