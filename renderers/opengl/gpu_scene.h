#pragma once

#include <cstdint>
#include <memory>

#include <glm/vec4.hpp>

#include "perception/base/hash.h"
#include "renderers/contract/stage_timer.h"
#include "renderers/opengl/buffer.h"
#include "renderers/scene/scene.h"

namespace renderers::opengl {

/// A triangle in world space, std430 (`Triangle` of shaders/scene.glsl).
struct GpuTriangle {
  glm::vec4 position[3];       ///< xyz; w: u of the vertex
  glm::vec4 normal[3];         ///< xyz: shading normal, unit length, front side; w: v of the vertex
  glm::vec4 geometric_normal;  ///< xyz: unit length, front side; w: bits of the material's index
};

/// A material, std430 (`Material` of shaders/scene.glsl).
struct GpuMaterial {
  glm::vec4 albedo;         ///< rgb; w: bits of the texture's first texel, -1 without a texture
  glm::vec4 lobe;           ///< rgb: its albedo; w: exponent of Phong, or -alpha of GGX
  glm::vec4 emission;       ///< rgb (textures of emission are not on the device); w: unused
  glm::ivec4 texture_size;  ///< width, height of the albedo texture, 0, 0
};

/// The scene's triangles, materials and textures as storage buffers (bindings 0, 1, 2 of
/// shaders/scene.glsl). Buffers are kept when the next frame fits into them.
class GpuScene {
 public:
  explicit GpuScene(std::shared_ptr<Context> context);

  /// Stages `triangles` and `upload` under whatever stage is open.
  /// @throws UnsupportedError if the scene does not fit into the device's storage blocks
  void load(const scene::Scene& scene, StageTimer& timer);

  const Buffer& triangles() const { return triangles_; }
  const Buffer& materials() const { return materials_; }
  const Buffer& texels() const { return texels_; }
  int triangle_count() const { return triangle_count_; }
  const scene::Box& bounds() const { return bounds_; }
  bool has_glossy() const { return has_glossy_; }
  /// True if a surface has a lobe of GGX.
  bool has_ggx() const { return has_ggx_; }
  std::int64_t memory_bytes() const;
  const std::shared_ptr<Context>& context() const { return context_; }

 private:
  std::shared_ptr<Context> context_;
  Buffer triangles_;
  Buffer materials_;
  Buffer texels_;
  int triangle_count_ = 0;
  scene::Box bounds_;
  bool has_glossy_ = false;
  bool has_ggx_ = false;
  base::Hash texel_hash_;  ///< of what `texels_` holds
};

}  // namespace renderers::opengl
