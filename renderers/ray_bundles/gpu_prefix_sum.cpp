#include "renderers/ray_bundles/gpu_prefix_sum.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "renderers/opengl/program.h"
#include "renderers/ray_bundles/gpu_dispatch.h"

namespace renderers::ray_bundles {

GpuPrefixSum::GpuPrefixSum(std::shared_ptr<opengl::Context> context)
    : context_(std::move(context)), totals_(context_, sizeof(CountTotals)) {}

CountTotals GpuPrefixSum::run(const opengl::Buffer& counts, std::int64_t count, std::uint32_t most,
                              opengl::Buffer& starts) {
  assert(count > 0);
  // The single thread's runs and those in the runs balance.
  const auto length = std::max<std::int64_t>(
      16, static_cast<std::int64_t>(std::ceil(std::sqrt(static_cast<double>(count)))));
  const std::int64_t run_count = (count + length - 1) / length;
  starts.reserve(context_, static_cast<std::size_t>(count + 1) * sizeof(std::uint32_t));
  runs_.reserve(context_, static_cast<std::size_t>(run_count) * sizeof(CountTotals));
  for (const char* step : {"SUMS", "RUNS", "STARTS"}) {
    opengl::Program& program = compute_program(*context_, "prefix_sum", {{step, "1"}});
    program.storage(0, counts);
    program.storage(1, starts);
    program.storage(2, runs_);
    program.storage(3, totals_);
    program.set("count", static_cast<std::uint32_t>(count));
    program.set("run_length", static_cast<std::uint32_t>(length));
    program.set("run_count", static_cast<std::uint32_t>(run_count));
    program.set("most", most);
    dispatch_items(program, run_count);
  }
  return totals_.read<CountTotals>(1).front();
}

}  // namespace renderers::ray_bundles
