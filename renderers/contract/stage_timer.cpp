#include "renderers/contract/stage_timer.h"

#include <ctime>

#include <algorithm>
#include <cassert>

namespace renderers {

namespace {

double seconds_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

bool is_nested(std::string_view path) { return path.find('/') != std::string_view::npos; }

}  // namespace

double steady_seconds() { return seconds_of(CLOCK_MONOTONIC); }

double process_cpu_seconds() { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }

std::string to_string(Phase phase) {
  switch (phase) {
    case Phase::prepare:
      return "prepare";
    case Phase::update:
      return "update";
    case Phase::render:
      return "render";
    case Phase::new_view:
      return "new_view";
  }
  return "render";
}

std::string to_string(StageClock clock) {
  switch (clock) {
    case StageClock::steady:
      return "steady";
    case StageClock::finish:
      return "finish";
    case StageClock::gpu_query:
      return "gpu-query";
  }
  return "steady";
}

StageTimer::Stage::Stage(StageTimer& timer, std::string_view name)
    : timer_(timer),
      record_(0),
      parent_path_length_(timer.open_path_.size()),
      wall_start_s_(0.0),
      cpu_start_s_(0.0) {
  record_ = timer_.open(name);
  cpu_start_s_ = process_cpu_seconds();
  wall_start_s_ = steady_seconds();
}

StageTimer::Stage::~Stage() {
  StageRecord& record = timer_.records_[record_];
  record.wall_s += steady_seconds() - wall_start_s_;
  record.cpu_s += process_cpu_seconds() - cpu_start_s_;
  record.calls += 1;
  timer_.open_path_.resize(parent_path_length_);
}

void StageTimer::Stage::add_bytes(std::int64_t cpu, std::int64_t gpu) {
  timer_.records_[record_].bytes_cpu += cpu;
  timer_.records_[record_].bytes_gpu += gpu;
}

void StageTimer::Stage::add_gpu_s(double gpu_s, StageClock clock) {
  StageRecord& record = timer_.records_[record_];
  assert(record.gpu_s < 0.0 || record.clock == clock);
  record.gpu_s = std::max(0.0, record.gpu_s) + gpu_s;
  record.clock = clock;
}

std::size_t StageTimer::open(std::string_view name) {
  if (!open_path_.empty()) open_path_ += '/';
  open_path_ += name;
  const auto found = std::find_if(records_.begin(), records_.end(), [&](const StageRecord& r) {
    return r.phase == phase_ && r.path == open_path_;
  });
  if (found != records_.end()) return static_cast<std::size_t>(found - records_.begin());
  StageRecord record;
  record.phase = phase_;
  record.path = open_path_;
  records_.push_back(std::move(record));
  return records_.size() - 1;
}

double StageTimer::top_level_s(Phase phase) const {
  double sum_s = 0.0;
  for (const StageRecord& record : records_) {
    if (record.phase == phase && !is_nested(record.path)) sum_s += record.wall_s;
  }
  return sum_s;
}

double StageTimer::wall_of(std::string_view path) const {
  double sum_s = 0.0;
  for (const StageRecord& record : records_) {
    if (record.path == path) sum_s += record.wall_s;
  }
  return sum_s;
}

}  // namespace renderers
