#pragma once

#include <cstdint>
#include <memory>

#include <glm/vec2.hpp>

#include "renderers/opengl/texture.h"

namespace renderers::opengl {

/// What draws go into: textures of one size, or nothing but a size for shaders that write images.
/// Of arrays every layer is attached, of which gl_Layer chooses, or one.
class Framebuffer {
 public:
  Framebuffer() = default;
  /// @param color, depth  null for none; at least one is given
  /// @throws UnsupportedError if the device cannot draw into these formats
  Framebuffer(std::shared_ptr<Context> context, const Texture* color, const Texture* depth);
  /// One layer of an array as depth. @throws as above
  Framebuffer(std::shared_ptr<Context> context, const Texture& depth, int layer);
  /// No textures. @param layers  0: none to choose from
  Framebuffer(std::shared_ptr<Context> context, const glm::ivec2& size_px, int layers);
  ~Framebuffer();
  Framebuffer(Framebuffer&& other) noexcept;
  Framebuffer& operator=(Framebuffer&& other) noexcept;

  std::uint32_t id() const { return id_; }
  const glm::ivec2& size_px() const { return size_px_; }
  const std::shared_ptr<Context>& context() const { return context_; }

 private:
  void require_complete();

  std::shared_ptr<Context> context_;
  std::uint32_t id_ = 0;
  glm::ivec2 size_px_{0};
};

/// `nearer`: greater values win, as depth is reversed in this kit's projections; cleared to 0.
enum class DepthTest { none, nearer };

/// `add`: what is drawn is added to what is there.
enum class Blending { none, add };

/// A pass of the rasteriser: while this lives, draws go into the framebuffer, at first into all of
/// it.
class RasterPass {
 public:
  /// @param clip_distances  how many gl_ClipDistance the shaders write
  RasterPass(const Framebuffer& target, DepthTest depth_test, int clip_distances,
             Blending blending = Blending::none);
  ~RasterPass();
  RasterPass(const RasterPass&) = delete;
  RasterPass& operator=(const RasterPass&) = delete;

  /// Draws go into this rectangle.
  void viewport(const glm::ivec2& corner_px, const glm::ivec2& size_px);

 private:
  Context& context_;
  int clip_distances_;
  Blending blending_;
};

}  // namespace renderers::opengl
