#include "suites/cell_progress.h"

#include <algorithm>

#include "results/statistics.h"

namespace suites {
namespace {

using results::Status;

/// Where prepare takes longer it is repeated `min` times only (DESIGN section 3, clock).
constexpr double kLongPrepare_s = 10.0;
bool is_final(Status status) {
  return status == Status::timeout || status == Status::out_of_memory ||
         status == Status::unsupported || status == Status::skipped;
}

bool is_skip(Status status) { return status == Status::unsupported || status == Status::skipped; }

bool is_failure(Status status) { return !results::is_success(status) && !is_skip(status); }

}  // namespace

void CellProgress::add(const results::CellRecord& record) {
  const results::RenderRecord& render = record.render;
  statuses_.push_back(render.status);
  next_repetition_ = std::max(next_repetition_, record.repetition + 1);
  longest_prepare_s_ = std::max(longest_prepare_s_, render.prepare_s);
  if (results::is_success(render.status)) total_s_.push_back(render.total_s);
  if (!image_.empty() || render.image.empty()) return;
  image_ = render.image;
  pixel_hash_ = render.pixel_hash;
  frame_ = render.frame;
}

bool CellProgress::has_failed() const {
  return std::any_of(statuses_.begin(), statuses_.end(), is_failure);
}

bool CellProgress::was_skipped() const {
  return std::any_of(statuses_.begin(), statuses_.end(), is_skip);
}

bool CellProgress::needs_more(const MeasurePlan& plan) const {
  if (std::any_of(statuses_.begin(), statuses_.end(), is_final)) return false;
  const auto count = static_cast<int>(statuses_.size());
  if (count < plan.min_repetitions) return true;
  if (count >= plan.max_repetitions || has_failed()) return false;
  if (longest_prepare_s_ > kLongPrepare_s) return false;
  if (total_s_.size() < results::kFewestForMedianInterval) return true;
  const results::Estimate median = results::median_with_interval(total_s_);
  return median.high - median.low > plan.until_relative_spread * median.value;
}

}  // namespace suites
