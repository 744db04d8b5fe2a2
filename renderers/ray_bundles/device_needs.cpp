#include "renderers/ray_bundles/device_needs.h"

#include <fmt/format.h>

namespace renderers::ray_bundles {

std::string lacking(const DeviceNeeds& needs, const opengl::Limits& limits,
                    const std::string& device) {
  if (needs.storage_blocks > limits.storage_blocks) {
    return fmt::format("the shaders take {} storage blocks and {} allows {}", needs.storage_blocks,
                       device, limits.storage_blocks);
  }
  if (needs.block_bytes > limits.storage_block_bytes) {
    return fmt::format("the scene takes {} bytes and {} allows a storage block {}",
                       needs.block_bytes, device, limits.storage_block_bytes);
  }
  return {};
}

}  // namespace renderers::ray_bundles
