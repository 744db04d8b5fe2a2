#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderers/contract/stage_timer.h"
#include "renderers/opengl/framebuffer.h"
#include "renderers/opengl/gpu_scene.h"
#include "renderers/scene/scene.h"
#include "renderers/shadow_maps/hemisphere_maps.h"

namespace renderers::shadow_maps {

/// Who chooses the layer that a triangle is drawn into: the vertex shader of one instanced draw
/// (ARB_shader_viewport_layer_array), a geometry shader behind it, or a draw for every layer.
/// `automatic`: the first of them that the device can do. Distances are the same
/// (but for their last bits, where a driver rounds otherwise behind a geometry shader).
enum class LayerChoice { automatic, vs_layer, gs_layer, per_layer };

struct VertexMapSettings {
  float near_share = kNearShare;  ///< as in HardMapSettings
  /// Longest edge of the pieces that triangles are cut into, share of the diagonal of the scene's
  /// bounds; 0: they are not cut.
  float edge_share = 0.04F;
  LayerChoice layer_choice = LayerChoice::automatic;
};

/// Fills hemispherical maps by projecting vertices, as the ordinary rasteriser does it: quick, and
/// wrong by as much as edges are long.
///
/// An edge that subtends the angle phi at the centre is drawn as a chord of its arc: off by up to
/// size / 2 (1 - cos(phi / 2)) texels at the rim, and distances between ends at the same distance
/// are too great by about 1 - cos(phi / 2) of themselves [derived]: 10 degrees are half a texel of
/// 256 and 0.4 %. Pieces near a centre subtend large angles whatever their size. The horizon cuts
/// them where the height, taken as linear over the map, is 0, which is right for small ones only.
/// Texels at the rim that nothing covers take the distance of one inwards of them.
///
/// Source: Brabec et al. 2002, "Shadow Mapping for Hemispherical and Omnidirectional Light
/// Sources", recalled.
class VertexMaps {
 public:
  /// @throws UnsupportedError for vs_layer on a device without it
  explicit VertexMaps(std::shared_ptr<opengl::Context> context,
                      const VertexMapSettings& settings = {});

  /// Cuts the triangles of a scene's state. Stages `tessellation` and `upload` under whatever stage
  /// is open.
  /// @throws UnsupportedError if the pieces do not fit into a storage block of the device; says how
  ///   many do
  void load(const scene::Scene& scene, StageTimer& timer);

  /// Draws what was loaded into layers [0, count), seen from origins [first, first + count), and
  /// clears the rest.
  /// @param scene  the same state as was loaded
  /// @throws base::DeviceError if the device fails
  void fill(HemisphereMaps& maps, const opengl::GpuScene& scene, const MapOrigins& origins,
            int first, int count);

  int piece_count() const { return piece_count_; }
  /// Draw calls that fill so many maps: one, or one each with `LayerChoice::per_layer`.
  int draw_count(int maps) const;
  std::int64_t memory_bytes() const;

 private:
  void reserve(const HemisphereMaps& maps);
  void draw(opengl::Program& program, int count);

  std::shared_ptr<opengl::Context> context_;
  VertexMapSettings settings_;
  opengl::Buffer vertices_;
  opengl::Buffer triangles_;
  int piece_count_ = 0;
  opengl::Texture depth_;
  std::vector<opengl::Framebuffer> targets_;  ///< of all layers, or one each
};

}  // namespace renderers::shadow_maps
