#include "suites/cell_progress.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "perception/base/quantile.h"
#include "results/statistics.h"

namespace suites {
namespace {

using results::Status;

bool is_final(Status status) {
  return status == Status::timeout || status == Status::out_of_memory ||
         status == Status::unsupported || status == Status::skipped;
}

bool is_skip(Status status) { return status == Status::unsupported || status == Status::skipped; }

const std::string kNone;

}  // namespace

std::string device_text(const results::RenderRecord& record) {
  if (!record.gl_platform) return record.device;
  return fmt::format("{} ({})", record.device, *record.gl_platform);
}

bool ends_sequence(Status status) {
  return !results::is_success(status) && status != Status::non_finite;
}

void CellProgress::add(const results::CellRecord& record) {
  const results::RenderRecord& render = record.render;
  Repetition& repetition = repetitions_[record.repetition];
  repetition.frames[render.frame] = render.status;
  if (results::is_success(render.status)) {
    if (device_.empty()) device_ = device_text(render);
    // A sequence is judged by its following frames.
    const bool is_sequence = frame_count_ > 1;
    if (is_sequence == render.next_frame_s.has_value()) {
      repetition.time_s[render.frame] = timed_s(render);
    }
  }
  if (checkpoints_.empty() && results::is_success(render.status)) {
    checkpoints_ = record.checkpoints;
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

/// One per repetition.
std::vector<double> CellProgress::times_s() const {
  std::vector<double> times;
  for (const auto& [number, repetition] : repetitions_) {
    std::vector<double> of_frames;
    for (const auto& [frame, time_s] : repetition.time_s) of_frames.push_back(time_s);
    if (!of_frames.empty()) times.push_back(base::median(of_frames));
  }
  return times;
}

bool CellProgress::needs_more(const MeasurePlan& plan) const {
  if (any_status(is_final)) return false;
  const auto count = static_cast<int>(repetitions());
  const bool has_unfinished = repetitions_.size() > static_cast<std::size_t>(count);
  if (count < plan.min_repetitions || has_unfinished) return true;
  if (count >= plan.max_repetitions || has_failed()) return false;
  if (longest_prepare_s_ > kLongPrepare_s) return false;
  const std::vector<double> times = times_s();
  if (times.size() < results::kFewestForMedianInterval) return true;
  const results::Estimate median = results::median_with_interval(times);
  return median.high - median.low > plan.until_relative_spread * median.value;
}

}  // namespace suites
