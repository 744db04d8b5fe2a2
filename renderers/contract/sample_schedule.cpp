#include "renderers/contract/sample_schedule.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace renderers {

SampleSchedule::SampleSchedule(const RenderJob& job, std::int64_t default_samples)
    : samples_(job.samples.value_or(default_samples)), budget_s_(job.time_budget_s) {
  // A time budget alone ends the picture; the parameter's default must not end it before.
  if (job.time_budget_s && !job.samples) samples_ = std::numeric_limits<std::int32_t>::max();
}

std::optional<SampleRange> SampleSchedule::next(std::int64_t done, double used_s) const {
  if (done >= samples_) return std::nullopt;
  const auto power = static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(done) + 1));
  std::int64_t end = std::min(samples_, power);
  if (budget_s_ && done > 0) {
    const double sample_s = used_s / static_cast<double>(done);
    const double left = (*budget_s_ - used_s) / sample_s;
    constexpr double kLeastShareOfASample = 0.5;
    if (left < kLeastShareOfASample) return std::nullopt;
    constexpr double kShareOfTheRest = 0.5;
    const auto step = static_cast<std::int64_t>(std::min(kShareOfTheRest * left, 1e9));
    end = std::min(end, done + std::max<std::int64_t>(1, step));
  }
  return SampleRange{done, end};
}

bool SampleSchedule::is_checkpoint(std::int64_t done) {
  return std::has_single_bit(static_cast<std::uint64_t>(done));
}

}  // namespace renderers
