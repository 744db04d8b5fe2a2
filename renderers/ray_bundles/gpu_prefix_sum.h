#pragma once

#include <cstdint>
#include <memory>

#include "renderers/opengl/buffer.h"
#include "renderers/opengl/context.h"

namespace renderers::ray_bundles {

/// What the numbers come to, std430; sums end at 2^32 - 1.
struct CountTotals {
  std::uint32_t sum = 0;   ///< of what counts of each
  std::uint32_t most = 0;  ///< greatest number
  std::uint32_t over = 0;  ///< sum of what does not count
};

/// Where lists of given lengths begin that stand one behind the other, on the device: shaders/
/// prefix_sum.comp.glsl.
class GpuPrefixSum {
 public:
  explicit GpuPrefixSum(std::shared_ptr<opengl::Context> context);

  /// @param counts  32-bit words  @param count  how many of them, >= 1
  /// @param most    what counts of each at most
  /// @param starts  out: `count` starts and the end of the last list
  /// @return waits for the device
  CountTotals run(const opengl::Buffer& counts, std::int64_t count, std::uint32_t most,
                  opengl::Buffer& starts);

 private:
  std::shared_ptr<opengl::Context> context_;
  opengl::Buffer runs_;
  opengl::Buffer totals_;
};

}  // namespace renderers::ray_bundles
