#include "renderers/opengl/framebuffer.h"

#include <cassert>
#include <utility>

#include "renderers/contract/devices.h"
#include "renderers/opengl/gl_functions.h"

namespace renderers::opengl {

Framebuffer::Framebuffer(std::shared_ptr<Context> context, const Texture* color,
                         const Texture* depth)
    : context_(std::move(context)) {
  assert(color != nullptr || depth != nullptr);
  const TextureShape& shape = (color != nullptr ? color : depth)->shape();
  assert(depth == nullptr || depth->shape().layers == shape.layers);
  size_px_ = {shape.width_px, shape.height_px};
  const Functions& gl = context_->use();
  gl.CreateFramebuffers(1, &id_);
  gl.NamedFramebufferDrawBuffer(id_, color != nullptr ? GL_COLOR_ATTACHMENT0 : GL_NONE);
  if (color != nullptr) gl.NamedFramebufferTexture(id_, GL_COLOR_ATTACHMENT0, color->id(), 0);
  if (depth != nullptr) gl.NamedFramebufferTexture(id_, GL_DEPTH_ATTACHMENT, depth->id(), 0);
  require_complete();
}

Framebuffer::Framebuffer(std::shared_ptr<Context> context, const Texture& depth, int layer)
    : context_(std::move(context)), size_px_(depth.shape().width_px, depth.shape().height_px) {
  assert(layer >= 0 && layer < depth.shape().layers);
  const Functions& gl = context_->use();
  gl.CreateFramebuffers(1, &id_);
  gl.NamedFramebufferDrawBuffer(id_, GL_NONE);
  gl.NamedFramebufferTextureLayer(id_, GL_DEPTH_ATTACHMENT, depth.id(), 0, layer);
  require_complete();
}

Framebuffer::Framebuffer(std::shared_ptr<Context> context, const glm::ivec2& size_px, int layers)
    : context_(std::move(context)), size_px_(size_px) {
  const Functions& gl = context_->use();
  gl.CreateFramebuffers(1, &id_);
  gl.NamedFramebufferDrawBuffer(id_, GL_NONE);
  gl.NamedFramebufferParameteri(id_, GL_FRAMEBUFFER_DEFAULT_WIDTH, size_px.x);
  gl.NamedFramebufferParameteri(id_, GL_FRAMEBUFFER_DEFAULT_HEIGHT, size_px.y);
  gl.NamedFramebufferParameteri(id_, GL_FRAMEBUFFER_DEFAULT_LAYERS, layers);
  require_complete();
}

void Framebuffer::require_complete() {
  const Functions& gl = context_->use();
  if (gl.CheckNamedFramebufferStatus(id_, GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return;
  gl.DeleteFramebuffers(1, &id_);
  throw UnsupportedError(context_->facts().renderer + " cannot draw into these textures");
}

Framebuffer::~Framebuffer() {
  if (id_ != 0) context_->use().DeleteFramebuffers(1, &id_);
}

Framebuffer::Framebuffer(Framebuffer&& other) noexcept
    : context_(std::move(other.context_)),
      id_(std::exchange(other.id_, 0)),
      size_px_(other.size_px_) {}

Framebuffer& Framebuffer::operator=(Framebuffer&& other) noexcept {
  std::swap(context_, other.context_);
  std::swap(id_, other.id_);
  std::swap(size_px_, other.size_px_);
  return *this;
}

RasterPass::RasterPass(const Framebuffer& target, DepthTest depth_test, int clip_distances,
                       Blending blending)
    : context_(*target.context()), clip_distances_(clip_distances), blending_(blending) {
  const Functions& gl = context_.use();
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target.id());
  viewport({0, 0}, target.size_px());
  if (depth_test == DepthTest::nearer) {
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_GREATER);
    gl.DepthMask(GL_TRUE);
  } else {
    gl.Disable(GL_DEPTH_TEST);
  }
  for (int i = 0; i < clip_distances_; ++i) {
    gl.Enable(GL_CLIP_DISTANCE0 + static_cast<GLenum>(i));
  }
  if (blending_ == Blending::add) {
    gl.Enable(GL_BLEND);
    gl.BlendFunc(GL_ONE, GL_ONE);
  }
}

RasterPass::~RasterPass() {
  const Functions& gl = context_.use();
  if (blending_ == Blending::add) gl.Disable(GL_BLEND);
  for (int i = 0; i < clip_distances_; ++i) {
    gl.Disable(GL_CLIP_DISTANCE0 + static_cast<GLenum>(i));
  }
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
}

void RasterPass::viewport(const glm::ivec2& corner_px, const glm::ivec2& size_px) {
  context_.use().Viewport(corner_px.x, corner_px.y, size_px.x, size_px.y);
}

}  // namespace renderers::opengl
