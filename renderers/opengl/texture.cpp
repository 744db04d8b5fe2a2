#include "renderers/opengl/texture.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include <fmt/core.h>

#include "renderers/opengl/gl_functions.h"
#include "renderers/opengl/texture_format.h"

namespace renderers::opengl {

namespace {

[[maybe_unused]] bool has_integers(const TextureShape& shape) {
  return shape.format == TextureFormat::r32ui || shape.format == TextureFormat::rgba32i;
}

int layer_count(const TextureShape& shape) { return std::max(1, shape.layers); }
int level_size(int size_px, int level) { return std::max(1, size_px >> level); }

std::int64_t texel_count(const TextureShape& shape, int level) {
  return static_cast<std::int64_t>(level_size(shape.width_px, level)) *
         level_size(shape.height_px, level);
}

std::string description_of(const TextureShape& shape) {
  return shape.layers == 0 ? fmt::format("a texture of {} x {}", shape.width_px, shape.height_px)
                           : fmt::format("a texture of {} x {}, {} layers", shape.width_px,
                                         shape.height_px, shape.layers);
}

void check_limits(const Context& context, const TextureShape& shape) {
  const Limits& limits = context.limits();
  const std::int64_t size_px = std::max(shape.width_px, shape.height_px);
  if (size_px > limits.texture_size_px) {
    throw UnsupportedError(fmt::format("{} is needed; {} allows {} a side", description_of(shape),
                                       context.facts().renderer, limits.texture_size_px));
  }
  if (shape.layers > limits.array_layers) {
    throw UnsupportedError(fmt::format("{} is needed; {} allows {} layers", description_of(shape),
                                       context.facts().renderer, limits.array_layers));
  }
}

/// Makes the texture's store; its id.
GLuint make_store(const Functions& gl, const TextureShape& shape) {
  const GLenum format = format_facts(shape.format).internal;
  GLuint id = 0;
  if (shape.layers == 0) {
    gl.CreateTextures(GL_TEXTURE_2D, 1, &id);
    gl.TextureStorage2D(id, shape.levels, format, shape.width_px, shape.height_px);
  } else {
    gl.CreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
    gl.TextureStorage3D(id, shape.levels, format, shape.width_px, shape.height_px, shape.layers);
  }
  return id;
}

}  // namespace

const FormatFacts& format_facts(TextureFormat format) {
  static constexpr FormatFacts kFacts[]{
      {GL_R16F, GL_RED, GL_FLOAT, 1, 2},
      {GL_R32F, GL_RED, GL_FLOAT, 1, 4},
      {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 1, 4},
      {GL_RGBA8_SNORM, GL_RGBA, GL_BYTE, 4, 4},
      {GL_RGBA16F, GL_RGBA, GL_FLOAT, 4, 8},
      {GL_RGBA32F, GL_RGBA, GL_FLOAT, 4, 16},
      {GL_RGBA32I, GL_RGBA_INTEGER, GL_INT, 4, 16},
      {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 1, 4}};
  return kFacts[static_cast<std::size_t>(format)];
}

std::int64_t size_bytes_of(const TextureShape& shape) {
  std::int64_t texels = 0;
  for (int level = 0; level < shape.levels; ++level) texels += texel_count(shape, level);
  return texels * layer_count(shape) * format_facts(shape.format).texel_bytes;
}

Texture::Texture(std::shared_ptr<Context> context, const TextureShape& shape)
    : context_(std::move(context)), shape_(shape) {
  assert(shape.width_px > 0 && shape.height_px > 0 && shape.layers >= 0 && shape.levels > 0);
  check_limits(*context_, shape);
  context_->check("working, before a texture was made");
  const Functions& gl = context_->use();
  id_ = make_store(gl, shape);
  gl.TextureParameteri(id_, GL_TEXTURE_MIN_FILTER,
                       shape.levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
  gl.TextureParameteri(id_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl.TextureParameteri(id_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TextureParameteri(id_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  try {
    context_->check("making " + description_of(shape));
  } catch (...) {
    gl.DeleteTextures(1, &id_);
    throw;
  }
}

Texture::~Texture() {
  if (id_ != 0) context_->use().DeleteTextures(1, &id_);
}

Texture::Texture(Texture&& other) noexcept
    : context_(std::move(other.context_)),
      id_(std::exchange(other.id_, 0)),
      shape_(std::exchange(other.shape_, TextureShape{})) {}

Texture& Texture::operator=(Texture&& other) noexcept {
  std::swap(context_, other.context_);
  std::swap(id_, other.id_);
  std::swap(shape_, other.shape_);
  return *this;
}

void Texture::reshape(std::shared_ptr<Context> context, const TextureShape& shape) {
  if (id_ != 0 && context_ == context && shape_ == shape) return;
  *this = Texture();  // the old one goes first: both may not fit
  *this = Texture(std::move(context), shape);
}

void Texture::clear(const float (&rgba)[4]) {
  assert(!has_integers(shape_));
  const FormatFacts& facts = format_facts(shape_.format);
  const GLenum channels = facts.channels == 4 ? GLenum{GL_RGBA} : facts.channel_names;
  const Functions& gl = context_->use();
  for (int level = 0; level < shape_.levels; ++level) {
    gl.ClearTexImage(id_, level, channels, GL_FLOAT, rgba);
  }
}

void Texture::clear_words(std::uint32_t word) {
  assert(shape_.format == TextureFormat::r32ui);
  const Functions& gl = context_->use();
  for (int level = 0; level < shape_.levels; ++level) {
    gl.ClearTexImage(id_, level, GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
  }
}

void Texture::write(std::span<const float> texels) {
  assert(!has_integers(shape_));
  const FormatFacts& facts = format_facts(shape_.format);
  assert(texels.size() ==
         static_cast<std::size_t>(texel_count(shape_, 0) * layer_count(shape_) * facts.channels));
  const Functions& gl = context_->use();
  if (shape_.layers == 0) {
    gl.TextureSubImage2D(id_, 0, 0, 0, shape_.width_px, shape_.height_px, facts.channel_names,
                         GL_FLOAT, texels.data());
  } else {
    gl.TextureSubImage3D(id_, 0, 0, 0, 0, shape_.width_px, shape_.height_px, shape_.layers,
                         facts.channel_names, GL_FLOAT, texels.data());
  }
}

std::vector<float> Texture::read(int level, int layer) const {
  assert(!has_integers(shape_));
  std::vector<float> texels(values_in(level, layer));
  if (shape_.format == TextureFormat::rgba8_snorm) {
    // As bytes: NVIDIA's driver converts them to (2 c + 1) / 255, which shaders do not see.
    std::vector<std::int8_t> steps(texels.size());
    read_values(level, layer, steps.data(), steps.size());
    std::ranges::transform(steps, texels.begin(), [](std::int8_t step) {
      return std::max(static_cast<float>(step) / 127.0F, -1.0F);
    });
    return texels;
  }
  read_values(level, layer, texels.data(), texels.size() * sizeof(float));
  return texels;
}

std::vector<std::uint32_t> Texture::read_words(int layer) const {
  assert(has_integers(shape_));
  std::vector<std::uint32_t> texels(values_in(0, layer));
  read_values(0, layer, texels.data(), texels.size() * sizeof(std::uint32_t));
  return texels;
}

std::size_t Texture::values_in(int level, int layer) const {
  assert(level >= 0 && level < shape_.levels && layer < layer_count(shape_));
  const std::int64_t layers = layer < 0 ? layer_count(shape_) : 1;
  return static_cast<std::size_t>(texel_count(shape_, level) * layers *
                                  format_facts(shape_.format).channels);
}

void Texture::read_values(int level, int layer, void* values, std::size_t size_bytes) const {
  const FormatFacts& facts = format_facts(shape_.format);
  const Functions& gl = context_->use();
  const int begin = std::max(layer, 0);
  const int end = layer < 0 ? layer_count(shape_) : layer + 1;
  const std::size_t layer_bytes = size_bytes / static_cast<std::size_t>(end - begin);
  // Layer by layer: OpenGL counts a transfer's bytes in 31 bits.
  for (int each = begin; each < end; ++each) {
    gl.GetTextureSubImage(
        id_, level, 0, 0, each, level_size(shape_.width_px, level),
        level_size(shape_.height_px, level), 1, facts.channel_names, facts.value_type,
        static_cast<GLsizei>(layer_bytes),
        static_cast<std::byte*>(values) + static_cast<std::size_t>(each - begin) * layer_bytes);
  }
}

void Texture::set_linear_filter(bool between_levels) {
  const Functions& gl = context_->use();
  gl.TextureParameteri(id_, GL_TEXTURE_MIN_FILTER,
                       between_levels ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
  gl.TextureParameteri(id_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

}  // namespace renderers::opengl
