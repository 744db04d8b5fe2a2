#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "renderers/contract/stage_timer.h"
#include "renderers/many_lights/gather_settings.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/geometry_buffer.h"
#include "renderers/opengl/gpu_scene.h"
#include "renderers/opengl/program.h"
#include "renderers/opengl/shader_source.h"
#include "renderers/opengl/texture.h"
#include "renderers/shadow_maps/hemisphere_maps.h"

namespace renderers::many_lights {

/// How the pixels' work is laid out; the results are the same.
enum class GatherOrder {
  in_place,    ///< work groups of one class, which scatter to their pixels
  naive,       ///< pixel by pixel in the picture's order
  split_merge  ///< surfaces sorted by class into buffers, results sorted back
};

/// Light at each pixel, on the device.
struct GatherTargets {
  opengl::Texture irradiance;  ///< rgba32f: W/m2; w: 1 where there is a surface with lights
  opengl::Texture
      glossy;  ///< rgba32f: radiance reflected by lobes, W/(m2 sr); w: 1 on lobes with lights
};

/// A technique's own answer to who sees a light.
struct GatherVisibility {
  std::span<const opengl::ShaderFile> files;  ///< that hold the shader and all it includes
  /// Path of a compute shader that includes gather.glsl and defines its `light_visibility`.
  std::string shader;
  opengl::Defines defines;  ///< WITH_VISIBILITY among them
  bool is_costly = false;   ///< next to loading a light: a thread makes one pixel then
  std::function<void(opengl::Program&)> bind;  ///< sets what the shader declares beyond it
};

/// Lights, and which of them to work on.
struct GatherLights {
  const opengl::Buffer* lights = nullptr;  ///< VirtualLight
  int count = 0;                           ///< N
  int first = 0;                           ///< of this batch
  int batch = 0;                           ///< lights of this batch
  /// Layer l belongs to light first + l; null: nothing casts shadows.
  const shadow_maps::HemisphereMaps* maps = nullptr;
  shadow_maps::LookupBias bias{};
  const GatherVisibility* visibility = nullptr;  ///< in place of `maps`
};

/// Sums the light of virtual lights at the pixels of a geometry buffer, in a compute pass; formula
/// in virtual_light.h, interleaving in gather_settings.h.
class Gather {
 public:
  explicit Gather(std::shared_ptr<opengl::Context> context);

  /// Makes the targets as large as the surfaces, all zero.
  void begin(const opengl::GeometryBuffer& surfaces, const GatherSettings& settings);
  /// Adds a batch of lights to the targets; of interleaved pixels those whose run meets the batch.
  /// @param scene  for the receivers' materials, with_glossy only
  void add(const opengl::GeometryBuffer& surfaces, const opengl::GpuScene& scene,
           const GatherLights& lights, const GatherSettings& settings,
           GatherOrder order = GatherOrder::in_place);

  const GatherTargets& targets() const { return targets_; }
  /// For what is done in place, the blur.
  GatherTargets& targets() { return targets_; }
  std::int64_t memory_bytes() const;

 private:
  struct Work;

  enum class Lobe { diffuse, glossy };  ///< of the receivers

  void run(const Work& work, GatherOrder order, Lobe lobe);
  void bind_lights(opengl::Program& program, const Work& work) const;
  void dispatch_classes(opengl::Program& program, const Work& work, const glm::ivec2& tile) const;
  void split(const Work& work);
  void merge(const Work& work);

  std::shared_ptr<opengl::Context> context_;
  GatherTargets targets_;
  opengl::Texture split_surfaces_[4];  ///< position, normals, albedo, sorted by class
  GatherTargets split_targets_;
};

}  // namespace renderers::many_lights
