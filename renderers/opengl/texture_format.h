#pragma once

#include <cstdint>

#include "renderers/opengl/texture.h"

namespace renderers::opengl {

/// What OpenGL calls a format; the numbers are its enumerators.
struct FormatFacts {
  std::uint32_t internal = 0;
  std::uint32_t channel_names = 0;  ///< of values that go to and from it
  std::uint32_t value_type = 0;
  int channels = 0;
  int texel_bytes = 0;
};

const FormatFacts& format_facts(TextureFormat format);

}  // namespace renderers::opengl
