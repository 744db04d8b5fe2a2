#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "renderers/contract/stage_timer.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/context.h"
#include "renderers/ray_bundles/gpu_bundle_lists.h"
#include "renderers/ray_bundles/gpu_prefix_sum.h"
#include "renderers/ray_bundles/light_solution.h"
#include "renderers/ray_bundles/radiance_exchange.h"

namespace renderers::ray_bundles {

/// `Scatter` and `LightSolution::receive` on the device: lists and light stay there until they are
/// asked for.
///
/// Every texel gathers the crossings that lie in it, in the order of the lines: no sum depends on
/// the order in which a device runs its threads. Feeds growing_step and running_mean, Lambert
/// lobes, senders by the means of their texels.
class GpuExchange {
 public:
  /// Light as the solution has it now. @param texels  one for each of the solution's
  /// @throws UnsupportedError if the device's storage blocks do not hold it
  GpuExchange(std::shared_ptr<opengl::Context> context, std::span<const ExchangeTexel> texels,
              std::span<const glm::vec3> albedos, const LightSolution& solution);

  /// Light that texels emit from here on: the solution's.
  void set_emitted(const LightSolution& solution);

  /// Between the solution's `begin_direction` and `end_direction`, instead of an exchange on the
  /// CPU. @return crossings
  std::uint64_t exchange(const GpuBundleLists& lists, const BundleFrame& frame,
                         const EndLight& ends, float weight, const LightSolution& solution);

  /// Gives the solution what it received. Waits for the device.
  void fetch(LightSolution& solution) const;
  /// Of all directions. Waits for the device.
  /// @throws UnsupportedError if the device has ended loops before texels had all their light: too
  ///   many lines through one of them for a software driver
  ExchangeCounts counts() const;
  std::int64_t memory_bytes() const;

 private:
  void begin_window(const LightSolution& solution);
  void run_over_lines(const char* pass, const GpuBundleLists& lists, std::uint32_t line_count);
  void receive(const BundleFrame& frame, const EndLight& ends, float weight,
               const LightSolution& solution);

  std::shared_ptr<opengl::Context> context_;
  std::size_t texel_count_;
  std::int64_t window_begin_ = 0;
  opengl::Buffer texels_;
  opengl::Buffer albedos_;
  opengl::Buffer known_;
  opengl::Buffer emitted_;
  opengl::Buffer sent_;
  opengl::Buffer next_sent_;
  opengl::Buffer feed_;
  opengl::Buffer direct_;
  opengl::Buffer window_;
  opengl::Buffer older_;
  opengl::Buffer counts_;
  opengl::Buffer links_;
  opengl::Buffer texel_counts_;
  opengl::Buffer texel_starts_;
  opengl::Buffer texel_nodes_;
  GpuPrefixSum prefix_sum_;
};

}  // namespace renderers::ray_bundles
