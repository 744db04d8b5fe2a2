#include "results/result_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "perception/base/units.h"
#include "results/json_fields.h"
#include "results/run_files.h"

namespace results {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

constexpr const char* kLockName = "lock";

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail_file(folder, "make the folder", error.value());
}

std::string host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "an unknown machine";
  return name.data();
}

[[noreturn]] void fail_locked(const fs::path& folder) {
  std::string holder = "another process";
  try {
    const ordered_json json = ordered_json::parse(base::read_text_file(folder / kLockName));
    holder = fmt::format("process {} on {} since {}", json.at("pid").get<std::int64_t>(),
                         json.at("host").get<std::string>(), json.at("since").get<std::string>());
  } catch (const std::exception&) {
    // The holder has taken the lock and not yet written its name: the message does without it.
  }
  throw base::InputError(fmt::format(
      "{}: the run is being written by {}; wait for its end, or stop it", folder.string(), holder));
}

int take_lock(const fs::path& folder) {
  const fs::path path = folder / kLockName;
  File file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
  if (file.fd() < 0) fail_file(path, "write the lock", errno);
  if (flock(file.fd(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) fail_locked(folder);
    fail_file(path, "take the lock", errno);
  }
  const ordered_json holder{{"pid", getpid()}, {"host", host_name()}, {"since", base::utc_now()}};
  const std::string text = to_line(holder) + "\n";
  if (ftruncate(file.fd(), 0) != 0 || write(file.fd(), text.data(), text.size()) < 0) {
    fail_file(path, "write the lock", errno);
  }
  return file.release();
}

/// A repetition of a sequence that was interrupted is made again, under the same number.
using CellKey = std::tuple<std::string, int, int>;

CellKey key_of(const CellRecord& record) {
  return {record.cell, record.repetition, record.render.frame};
}

using MetricKey = std::array<std::string, 4>;

MetricKey key_of(const MetricRecord& record) {
  return {record.cell, std::to_string(record.frame), record.against, record.metric};
}

using CheckpointKey = std::tuple<std::string, int, std::string, std::string>;

CheckpointKey key_of(const CheckpointScore& record) {
  return {record.score.cell, record.checkpoint, record.score.against, record.score.metric};
}

using SearchKey = std::array<std::string, 3>;

SearchKey key_of(const SearchRecord& record) {
  return {record.scene, record.method, record.budget};
}

/// Reads a file of records, of which the last one of each key counts.
/// @return how many lines were cut by a crash
template <class Record, class Read>
std::size_t read_records(const fs::path& path, const Read& read, std::vector<Record>& records) {
  using Key = decltype(key_of(std::declval<Record>()));
  LastOfEachKey<Record, Key> last(records);
  return read_lines(path, [&](const ordered_json& json) {
    Record record = read(json);
    const Key key = key_of(record);
    last.add(key, std::move(record));
  });
}

}  // namespace

RunFolder RunFolder::open_for_writing(const fs::path& folder) {
  make_folder(folder);
  require_no_links(folder);
  const int lock_fd = take_lock(folder);
  return RunFolder(folder, lock_fd);
}

RunFolder::RunFolder(fs::path path, int lock_fd)
    : path_(std::move(path)), lock_fd_(lock_fd), mutex_(std::make_unique<std::mutex>()) {}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_(std::move(other.path_)),
      lock_fd_(std::exchange(other.lock_fd_, -1)),
      mutex_(std::move(other.mutex_)) {}

RunFolder::~RunFolder() {
  if (lock_fd_ >= 0) close(lock_fd_);  // gives up the lock, as the end of the process would
}

void RunFolder::write_run_json(const ordered_json& run) {
  const auto replace = ordered_json::error_handler_t::replace;
  base::write_text_file(path_ / "run.json", run.dump(2, ' ', false, replace) + "\n");
}

void RunFolder::write_resolved_suite(const std::string& yaml) {
  base::write_text_file(path_ / "suite.resolved.yaml", yaml);
}

void RunFolder::append_line_to(const char* file, const ordered_json& record) {
  const std::lock_guard lock(*mutex_);
  append_line(path_ / file, to_line(record));
}

void RunFolder::append(const CellRecord& record) { append_line_to("cells.jsonl", to_json(record)); }

void RunFolder::append(const MetricRecord& record) {
  append_line_to("metrics.jsonl", to_json(record));
}

void RunFolder::append(const CheckpointScore& record) {
  append_line_to("convergence.jsonl", to_json(record));
}

void RunFolder::append(const SearchRecord& record) {
  append_line_to("searches.jsonl", to_json(record));
}

void RunFolder::append_cell(const ordered_json& record) { append_line_to("cells.jsonl", record); }

fs::path RunFolder::cell_folder(const std::string& cell) const {
  fs::path folder = path_ / "images" / cell;
  make_folder(folder);
  return folder;
}

std::string run_kind(const fs::path& folder) {
  require_run(folder);
  const ordered_json info = read_run_json(folder);
  const auto kind = info.find("kind");
  return kind != info.end() && kind->is_string() ? kind->get<std::string>() : "images";
}

Run load_run(const fs::path& folder) {
  if (const std::string kind = run_kind(folder); kind != "images") {
    throw base::InputError(
        fmt::format("{}: a run of kind {}; accepted here: a run of images", folder.string(), kind));
  }
  Run run;
  run.folder = folder;
  run.info = std::make_shared<const ordered_json>(read_run_json(folder));
  run.resolved_suite = text_or_empty(folder / "suite.resolved.yaml");
  run.unreadable_lines =
      read_records(folder / "cells.jsonl", cell_record_from_json, run.cells) +
      read_records(folder / "metrics.jsonl", metric_record_from_json, run.metrics) +
      read_records(folder / "convergence.jsonl", checkpoint_score_from_json,
                   run.checkpoint_scores) +
      read_records(folder / "searches.jsonl", search_record_from_json, run.searches);
  return run;
}

}  // namespace results
