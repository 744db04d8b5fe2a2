#pragma once

#include <cstdint>
#include <string>

#include "renderers/opengl/context.h"

namespace renderers::ray_bundles {

/// What bundles on a device take of its limits.
struct DeviceNeeds {
  std::int64_t block_bytes = 0;      ///< largest storage block
  std::int64_t storage_blocks = 0;   ///< of one compute shader
  std::int64_t vertex_blocks = 0;    ///< of one vertex shader
  std::int64_t fragment_blocks = 0;  ///< of one fragment shader
  std::int64_t bindings = 0;         ///< places that blocks are bound to
};

/// Of lists, drawn or traced. The shader with most blocks is `order_lines.comp.glsl`. OpenGL 4.5
/// guarantees 8 of compute and fragment shaders and 8 bindings, none of vertex shaders.
constexpr DeviceNeeds list_needs(bool is_traced, std::int64_t block_bytes = 0) {
  return {block_bytes, 9, is_traced ? 0 : 1, is_traced ? 0 : 3, is_traced ? 9 : 11};
}
/// Of the exchange: `receive_light.comp.glsl`.
inline constexpr DeviceNeeds kExchangeNeeds{0, 13, 0, 0, 13};

/// What a device lacks, as half a sentence; empty: nothing.
/// @param device  its name
std::string lacking(const DeviceNeeds& needs, const opengl::Limits& limits,
                    const std::string& device);

}  // namespace renderers::ray_bundles
