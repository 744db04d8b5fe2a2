#include "suites/cell_progress.h"

#include <algorithm>
#include <cmath>

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

const std::string kNone;

}  // namespace

bool ends_sequence(Status status) {
  return !results::is_success(status) && status != Status::non_finite;
}

void CellProgress::add(const results::CellRecord& record) {
  const results::RenderRecord& render = record.render;
  repetitions_[record.repetition].frames[render.frame] = render.status;
  const bool is_first_frame = !render.next_frame_s && std::isfinite(render.total_s);
  if (is_first_frame && results::is_success(render.status)) {
    total_s_[record.repetition] = render.total_s;
  }
  if (std::isfinite(render.prepare_s)) {
    longest_prepare_s_ = std::max(longest_prepare_s_, render.prepare_s);
  }
  if (!render.image.empty()) images_.try_emplace(render.frame, render.image, render.pixel_hash);
}

bool CellProgress::is_finished(const Repetition& repetition) const {
  const auto& frames = repetition.frames;
  return frames.size() >= frame_count_ ||
         std::any_of(frames.begin(), frames.end(),
                     [](const auto& frame) { return ends_sequence(frame.second); });
}

template <class Predicate>
bool CellProgress::any_status(const Predicate& predicate) const {
  return std::any_of(repetitions_.begin(), repetitions_.end(), [&](const auto& repetition) {
    const auto& frames = repetition.second.frames;
    return std::any_of(frames.begin(), frames.end(),
                       [&](const auto& frame) { return predicate(frame.second); });
  });
}

int CellProgress::next_repetition() const {
  for (const auto& [number, repetition] : repetitions_) {
    if (!is_finished(repetition)) return number;
  }
  return repetitions_.empty() ? 0 : repetitions_.rbegin()->first + 1;
}

std::size_t CellProgress::repetitions() const {
  return static_cast<std::size_t>(
      std::count_if(repetitions_.begin(), repetitions_.end(),
                    [&](const auto& repetition) { return is_finished(repetition.second); }));
}

bool CellProgress::has_failed() const { return any_status(results::is_failure); }

bool CellProgress::was_skipped() const { return any_status(is_skip); }

const std::string& CellProgress::image(int frame) const {
  const auto found = images_.find(frame);
  return found == images_.end() ? kNone : found->second.image;
}

const std::string& CellProgress::pixel_hash(int frame) const {
  const auto found = images_.find(frame);
  return found == images_.end() ? kNone : found->second.pixel_hash;
}

bool CellProgress::needs_more(const MeasurePlan& plan) const {
  if (any_status(is_final)) return false;
  const auto count = static_cast<int>(repetitions());
  const bool has_unfinished = repetitions_.size() > static_cast<std::size_t>(count);
  if (count < plan.min_repetitions || has_unfinished) return true;
  if (count >= plan.max_repetitions || has_failed()) return false;
  if (longest_prepare_s_ > kLongPrepare_s) return false;
  if (total_s_.size() < results::kFewestForMedianInterval) return true;
  std::vector<double> times;
  for (const auto& [repetition, total_s] : total_s_) times.push_back(total_s);
  const results::Estimate median = results::median_with_interval(times);
  return median.high - median.low > plan.until_relative_spread * median.value;
}

}  // namespace suites
