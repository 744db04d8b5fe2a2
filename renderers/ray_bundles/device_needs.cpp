#include "renderers/ray_bundles/device_needs.h"

#include <fmt/format.h>

namespace renderers::ray_bundles {

std::string lacking(const DeviceNeeds& needs, const opengl::Limits& limits,
                    const std::string& device) {
  struct Count {
    std::int64_t needed;
    std::int64_t allowed;
    const char* what;
  };
  for (const Count& count :
       {Count{needs.storage_blocks, limits.storage_blocks, "storage blocks"},
        Count{needs.vertex_blocks, limits.vertex_storage_blocks,
              "storage blocks in the vertex stage"},
        Count{needs.fragment_blocks, limits.fragment_storage_blocks,
              "storage blocks in the fragment stage"},
        Count{needs.bindings, limits.storage_bindings, "bindings of storage blocks"}}) {
    if (count.needed <= count.allowed) continue;
    return fmt::format("the shaders take {} {} and {} allows {}", count.needed, count.what, device,
                       count.allowed);
  }
  if (needs.block_bytes > limits.storage_block_bytes) {
    return fmt::format("the scene takes {} bytes and {} allows a storage block {}",
                       needs.block_bytes, device, limits.storage_block_bytes);
  }
  return {};
}

}  // namespace renderers::ray_bundles
