#pragma once

#include <memory>

#include "renderers/opengl/gpu_scene.h"
#include "renderers/opengl/texture.h"
#include "renderers/opengl/view.h"

namespace renderers::opengl {

/// The nearest surfaces of a view, by the rasteriser: a camera's G-buffer, or a reflective shadow
/// map when the view is a light's (Dachsbacher and Stamminger 2005).
class GeometryBuffer {
 public:
  GeometryBuffer(std::shared_ptr<Context> context, int width_px, int height_px);

  /// Draws all triangles, both sides.
  void render(const GpuScene& scene, const View& view);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  /// xyz world space, m; w: 1 on a surface, 0 where there is none.
  const Texture& position() const { return position_; }
  /// xyz geometric normal, unit length, on the viewer's side; w: material index as a float.
  const Texture& geometric_normal() const { return geometric_normal_; }
  /// xyz shading normal, unit length, on the side of the geometric normal; w: 0.
  const Texture& shading_normal() const { return shading_normal_; }
  /// rgb diffuse reflectance, texture included (bilinear, level 0); w: 1 if the material is glossy.
  const Texture& albedo() const { return albedo_; }
  std::int64_t memory_bytes() const;
  const std::shared_ptr<Context>& context() const { return context_; }

 private:
  std::shared_ptr<Context> context_;
  int width_px_;
  int height_px_;
  Texture position_;
  Texture geometric_normal_;
  Texture shading_normal_;
  Texture albedo_;
  Texture depth_;
  std::uint32_t framebuffer_ = 0;

 public:
  ~GeometryBuffer();
  GeometryBuffer(const GeometryBuffer&) = delete;
  GeometryBuffer& operator=(const GeometryBuffer&) = delete;
};

}  // namespace renderers::opengl
