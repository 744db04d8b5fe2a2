#include "renderers/opengl/geometry_buffer.h"

#include <cassert>
#include <utility>

#include "perception/base/errors.h"
#include "renderers/opengl/gl_functions.h"
#include "renderers/opengl/program.h"
#include "renderers/opengl/shader_files.h"

namespace renderers::opengl {

namespace {

/// Nearest visible distance over the scene's diagonal.
constexpr float kNear = 1e-5F;
/// Far end of orthographic depth over the largest distance in the scene, so that rounding cuts
/// nothing off.
constexpr float kFarMargin = 1.01F;

TextureShape shape_of(TextureFormat format, int width_px, int height_px) {
  TextureShape shape;
  shape.format = format;
  shape.width_px = width_px;
  shape.height_px = height_px;
  return shape;
}

/// Bounds of the scene's distance along the view's axis, m.
float farthest_m(const View& view, const scene::Box& box) {
  float farthest = 0.0F;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 point((corner & 1) != 0 ? box.greatest.x : box.least.x,
                          (corner & 2) != 0 ? box.greatest.y : box.least.y,
                          (corner & 4) != 0 ? box.greatest.z : box.least.z);
    farthest = std::max(farthest, glm::dot(view.forward, point - view.origin));
  }
  return farthest;
}

void set_view(Program& program, const View& view, const scene::Box& bounds,
              const glm::ivec2& size_px) {
  const float near_m = kNear * bounds.diagonal_m();
  const float far_m = std::max(near_m, kFarMargin * farthest_m(view, bounds));
  program.set("clip_from_world", clip_from_world(view, near_m, far_m));
  program.set("view_origin", view.origin);
  program.set("view_forward", view.forward);
  program.set("corner", (view.center.x - view.half_width) * view.right +
                            (view.center.y + view.half_height) * view.up);
  program.set("step_right", 2.0F * view.half_width / static_cast<float>(size_px.x) * view.right);
  program.set("step_down", -2.0F * view.half_height / static_cast<float>(size_px.y) * view.up);
  program.set("is_orthographic", view.is_orthographic ? 1 : 0);
}

}  // namespace

GeometryBuffer::GeometryBuffer(std::shared_ptr<Context> context, int width_px, int height_px)
    : context_(std::move(context)),
      width_px_(width_px),
      height_px_(height_px),
      position_(context_, shape_of(TextureFormat::rgba32f, width_px, height_px)),
      geometric_normal_(context_, shape_of(TextureFormat::rgba32f, width_px, height_px)),
      shading_normal_(context_, shape_of(TextureFormat::rgba32f, width_px, height_px)),
      albedo_(context_, shape_of(TextureFormat::rgba32f, width_px, height_px)),
      depth_(context_, shape_of(TextureFormat::depth32f, width_px, height_px)) {
  const Functions& gl = context_->use();
  gl.CreateFramebuffers(1, &framebuffer_);
  const Texture* targets[] = {&position_, &geometric_normal_, &shading_normal_, &albedo_};
  GLenum attachments[4];
  for (GLuint i = 0; i < 4; ++i) {
    attachments[i] = GL_COLOR_ATTACHMENT0 + i;
    gl.NamedFramebufferTexture(framebuffer_, attachments[i], targets[i]->id(), 0);
  }
  gl.NamedFramebufferTexture(framebuffer_, GL_DEPTH_ATTACHMENT, depth_.id(), 0);
  gl.NamedFramebufferDrawBuffers(framebuffer_, 4, attachments);
  if (gl.CheckNamedFramebufferStatus(framebuffer_, GL_DRAW_FRAMEBUFFER) !=
      GL_FRAMEBUFFER_COMPLETE) {
    gl.DeleteFramebuffers(1, &framebuffer_);
    throw UnsupportedError(context_->facts().renderer +
                           " cannot draw into four textures of 32-bit floats");
  }
}

GeometryBuffer::~GeometryBuffer() { context_->use().DeleteFramebuffers(1, &framebuffer_); }

void GeometryBuffer::render(const GpuScene& scene, const View& view) {
  assert(scene.context() == context_);
  const Functions& gl = context_->use();
  const float nothing[4] = {0.0F, 0.0F, 0.0F, 0.0F};
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  gl.Viewport(0, 0, width_px_, height_px_);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_GREATER);
  gl.DepthMask(GL_TRUE);
  for (GLint i = 0; i < 4; ++i) gl.ClearNamedFramebufferfv(framebuffer_, GL_COLOR, i, nothing);
  gl.ClearNamedFramebufferfv(framebuffer_, GL_DEPTH, 0, nothing);

  if (scene.triangle_count() > 0) {
    Program& program = context_->program({shader_files(),
                                          {"renderers/opengl/shaders/geometry.vert.glsl",
                                           "renderers/opengl/shaders/geometry.frag.glsl"}});
    set_view(program, view, scene.bounds(), {width_px_, height_px_});
    program.storage(0, scene.triangles());
    program.storage(1, scene.materials());
    program.storage(2, scene.texels());
    program.draw_triangles(0, 3 * scene.triangle_count());
  }
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  context_->check("drawing the geometry buffer");
}

std::int64_t GeometryBuffer::memory_bytes() const {
  std::int64_t bytes = 0;
  for (const Texture* texture :
       {&position_, &geometric_normal_, &shading_normal_, &albedo_, &depth_}) {
    bytes += size_bytes_of(texture->shape());
  }
  return bytes;
}

}  // namespace renderers::opengl
