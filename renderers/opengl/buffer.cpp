#include "renderers/opengl/buffer.h"

#include <cassert>
#include <utility>

#include <fmt/core.h>

#include "renderers/opengl/gl_functions.h"

namespace renderers::opengl {

namespace {

constexpr std::size_t kWord_bytes = 4;

std::size_t whole_words(std::size_t size_bytes) {
  const std::size_t words = (size_bytes + kWord_bytes - 1) / kWord_bytes;
  return std::max<std::size_t>(1, words) * kWord_bytes;
}

}  // namespace

Buffer::Buffer(std::shared_ptr<Context> context, std::size_t size_bytes)
    : context_(std::move(context)), size_bytes_(size_bytes) {
  const std::size_t allocated_bytes = whole_words(size_bytes);
  const auto limit_bytes = static_cast<std::size_t>(context_->limits().storage_block_bytes);
  if (allocated_bytes > limit_bytes) {
    throw UnsupportedError(fmt::format("a buffer of {} bytes is needed; {} allows {}", size_bytes,
                                       context_->facts().renderer, limit_bytes));
  }
  context_->check("working, before a buffer was made");
  const Functions& gl = context_->use();
  gl.CreateBuffers(1, &id_);
  gl.NamedBufferStorage(id_, static_cast<GLsizeiptr>(allocated_bytes), nullptr,
                        GL_DYNAMIC_STORAGE_BIT);
  try {
    context_->check(fmt::format("making a buffer of {} bytes", size_bytes));
  } catch (...) {
    gl.DeleteBuffers(1, &id_);
    throw;
  }
}

Buffer::~Buffer() {
  if (id_ != 0) context_->use().DeleteBuffers(1, &id_);
}

Buffer::Buffer(Buffer&& other) noexcept
    : context_(std::move(other.context_)),
      id_(std::exchange(other.id_, 0)),
      size_bytes_(std::exchange(other.size_bytes_, 0)) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(context_, other.context_);
  std::swap(id_, other.id_);
  std::swap(size_bytes_, other.size_bytes_);
  return *this;
}

void Buffer::reserve(std::shared_ptr<Context> context, std::size_t size_bytes) {
  if (id_ != 0 && context_ == context && size_bytes <= size_bytes_) return;
  *this = Buffer();  // the old one goes first: both may not fit
  *this = Buffer(std::move(context), size_bytes);
}

void Buffer::fill(std::uint32_t word) {
  assert(id_ != 0);
  context_->use().ClearNamedBufferData(id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

void Buffer::write_bytes(const void* data, std::size_t size_bytes, std::size_t offset_bytes) {
  assert(offset_bytes + size_bytes <= whole_words(size_bytes_));
  if (size_bytes == 0) return;
  context_->use().NamedBufferSubData(id_, static_cast<GLintptr>(offset_bytes),
                                     static_cast<GLsizeiptr>(size_bytes), data);
}

void Buffer::read_bytes(void* data, std::size_t size_bytes, std::size_t offset_bytes) const {
  assert(offset_bytes + size_bytes <= whole_words(size_bytes_));
  if (size_bytes == 0) return;
  context_->use().GetNamedBufferSubData(id_, static_cast<GLintptr>(offset_bytes),
                                        static_cast<GLsizeiptr>(size_bytes), data);
}

}  // namespace renderers::opengl
