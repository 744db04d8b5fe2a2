#pragma once

#include <cstdint>
#include <string>

#include "renderers/opengl/context.h"

namespace renderers::ray_bundles {

/// What bundles on a device take of its limits.
struct DeviceNeeds {
  std::int64_t block_bytes = 0;     ///< largest storage block
  std::int64_t storage_blocks = 0;  ///< of one compute shader
};

/// Storage blocks of the shader with most, `order_lines.comp.glsl` for lists and
/// `receive_light.comp.glsl` for the exchange. OpenGL 4.5 guarantees 8.
inline constexpr std::int64_t kListStorageBlocks = 9;
inline constexpr std::int64_t kExchangeStorageBlocks = 13;

/// What a device lacks, as half a sentence; empty: nothing.
/// @param device  its name
std::string lacking(const DeviceNeeds& needs, const opengl::Limits& limits,
                    const std::string& device);

}  // namespace renderers::ray_bundles
