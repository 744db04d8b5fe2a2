#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "renderers/opengl/context.h"

namespace renderers::opengl {

enum class TextureFormat { r16f, r32f, r32ui, rgba8_snorm, rgba16f, rgba32f, rgba32i, depth32f };

struct TextureShape {
  TextureFormat format = TextureFormat::rgba32f;
  int width_px = 0;
  int height_px = 0;
  int layers = 0;  ///< 0: a plain 2D texture; else a 2D array
  int levels = 1;

  friend bool operator==(const TextureShape&, const TextureShape&) = default;
};

/// Bytes of all levels and layers.
std::int64_t size_bytes_of(const TextureShape& shape);

/// A 2D texture or 2D array on the device. Sampling: nearest, edges clamped, unless changed.
/// Rows on the device count from the bottom as OpenGL's do for raster passes; this kit flips
/// projections instead, so that row 0 is the top of the picture everywhere.
class Texture {
 public:
  Texture() = default;
  /// @throws UnsupportedError beyond the device's sizes, naming size and limit
  Texture(std::shared_ptr<Context> context, const TextureShape& shape);
  ~Texture();
  Texture(Texture&& other) noexcept;
  Texture& operator=(Texture&& other) noexcept;

  /// Keeps the texture if it has this shape already, else makes it anew.
  void reshape(std::shared_ptr<Context> context, const TextureShape& shape);

  const TextureShape& shape() const { return shape_; }
  std::uint32_t id() const { return id_; }
  bool is_empty() const { return id_ == 0; }

  /// Sets all texels of a level; for r32ui the value's bits are those of `word`.
  void clear(const float (&rgba)[4]);
  void clear_words(std::uint32_t word);
  /// All texels of level 0 (every layer), rows top first, as many floats a texel as the format has
  /// channels; not for formats of integers.
  void write(std::span<const float> texels);
  /// Same order; waits for the device. @param layer  -1: all
  std::vector<float> read(int level = 0, int layer = -1) const;
  std::vector<std::uint32_t> read_words(int layer = -1) const;  ///< r32ui, rgba32i (its bits)
  void set_linear_filter(bool between_levels);

 private:
  /// Numbers in a level; @param layer  -1: all
  std::size_t values_in(int level, int layer) const;
  void read_values(int level, int layer, void* values, std::size_t size_bytes) const;

  std::shared_ptr<Context> context_;
  std::uint32_t id_ = 0;
  TextureShape shape_;
};

}  // namespace renderers::opengl
