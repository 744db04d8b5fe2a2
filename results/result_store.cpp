#include "results/result_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "perception/base/units.h"
#include "results/json_fields.h"

namespace results {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

constexpr const char* kLockName = "lock";

[[noreturn]] void fail(const fs::path& path, const std::string& action, int error) {
  throw base::InputError(
      fmt::format("{}: cannot {}: {}", path.string(), action, std::strerror(error)));
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail(folder, "make the folder", error.value());
}

std::string host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "an unknown machine";
  return name.data();
}

/// Closes a descriptor at the end of the scope.
class File {
 public:
  explicit File(int fd) : fd_(fd) {}
  ~File() {
    if (fd_ >= 0) close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int fd() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

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
  if (file.fd() < 0) fail(path, "write the lock", errno);
  if (flock(file.fd(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) fail_locked(folder);
    fail(path, "take the lock", errno);
  }
  const ordered_json holder{{"pid", getpid()}, {"host", host_name()}, {"since", base::utc_now()}};
  const std::string text = to_line(holder) + "\n";
  if (ftruncate(file.fd(), 0) != 0 || write(file.fd(), text.data(), text.size()) < 0) {
    fail(path, "write the lock", errno);
  }
  return file.release();
}

bool ends_with_newline(int fd, off_t size) {
  char last = '\n';
  return size == 0 || (pread(fd, &last, 1, size - 1) == 1 && last == '\n');
}

/// One write call for the whole line, so that other readers never see two lines mixed.
void append_line(const fs::path& path, std::string line) {
  const File file(open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  if (file.fd() < 0) fail(path, "append", errno);
  struct stat before {};
  if (fstat(file.fd(), &before) != 0) fail(path, "append", errno);
  line += '\n';
  if (!ends_with_newline(file.fd(), before.st_size)) line.insert(0, 1, '\n');

  const ssize_t written = write(file.fd(), line.data(), line.size());
  if (written < 0) fail(path, "append", errno);
  if (static_cast<std::size_t>(written) < line.size()) {
    // The disk is full: take back the part that was written.
    if (ftruncate(file.fd(), before.st_size) != 0) fail(path, "take back half a line", errno);
    fail(path, "append", ENOSPC);
  }
  if (fdatasync(file.fd()) != 0 && errno != EINVAL) fail(path, "flush to the disk", errno);
}

/// Calls use(json) for every line; returns how many are not JSON, i.e. were cut by a crash.
/// @throws base::InputError with file and line for what `use` refuses
template <class Use>
std::size_t read_lines(const fs::path& path, const Use& use) {
  std::ifstream file(path);
  std::size_t unreadable = 0;
  int line_number = 0;
  for (std::string line; std::getline(file, line);) {
    ++line_number;
    if (line.empty()) continue;
    const ordered_json json = ordered_json::parse(line, nullptr, false);
    if (json.is_discarded()) {
      ++unreadable;
      continue;
    }
    try {
      use(json);
    } catch (const base::InputError& error) {
      throw base::InputError(base::Place{path.string(), line_number, 0}, error.what());
    }
  }
  return unreadable;
}

std::string text_or_empty(const fs::path& path) {
  return fs::exists(path) ? base::read_text_file(path) : std::string();
}

ordered_json read_run_json(const fs::path& path) {
  const std::string text = text_or_empty(path);
  if (text.empty()) return ordered_json::object();
  ordered_json json = ordered_json::parse(text, nullptr, false);
  if (!json.is_object()) {
    throw base::InputError(fmt::format("{}: not a JSON object; is it a run?", path.string()));
  }
  return json;
}

/// Takes lines in as they come; a later one of the same key replaces the earlier one in place.
template <class Record, class Key>
class LastOfEachKey {
 public:
  explicit LastOfEachKey(std::vector<Record>& records) : records_(records) {}
  void add(const Key& key, Record record) {
    const auto [entry, is_new] = index_of_.emplace(key, records_.size());
    if (is_new) records_.emplace_back();
    records_[entry->second] = std::move(record);
  }

 private:
  std::vector<Record>& records_;
  std::map<Key, std::size_t> index_of_;
};

/// A repetition of a sequence that was interrupted is made again, under the same number.
using CellKey = std::tuple<std::string, int, int>;

CellKey key_of(const CellRecord& record) {
  return {record.cell, record.repetition, record.render.frame};
}

using MetricKey = std::array<std::string, 4>;

MetricKey key_of(const MetricRecord& record) {
  return {record.cell, std::to_string(record.frame), record.against, record.metric};
}

}  // namespace

RunFolder RunFolder::open_for_writing(const fs::path& folder) {
  make_folder(folder);
  const int lock_fd = take_lock(folder);
  return RunFolder(folder, lock_fd);
}

RunFolder::RunFolder(fs::path path, int lock_fd) : path_(std::move(path)), lock_fd_(lock_fd) {}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_(std::move(other.path_)), lock_fd_(std::exchange(other.lock_fd_, -1)) {}

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

void RunFolder::append(const CellRecord& record) {
  append_line(path_ / "cells.jsonl", to_line(to_json(record)));
}

void RunFolder::append(const MetricRecord& record) {
  append_line(path_ / "metrics.jsonl", to_line(to_json(record)));
}

fs::path RunFolder::cell_folder(const std::string& cell) const {
  fs::path folder = path_ / "images" / cell;
  make_folder(folder);
  return folder;
}

Run load_run(const fs::path& folder) {
  const bool is_run = fs::exists(folder / "run.json") || fs::exists(folder / "cells.jsonl");
  if (!is_run) {
    throw base::InputError(
        fmt::format("{}: not a run; a run folder holds run.json and cells.jsonl", folder.string()));
  }
  Run run;
  run.folder = folder;
  run.info = std::make_shared<const ordered_json>(read_run_json(folder / "run.json"));
  run.resolved_suite = text_or_empty(folder / "suite.resolved.yaml");
  LastOfEachKey<CellRecord, CellKey> cells(run.cells);
  run.unreadable_lines = read_lines(folder / "cells.jsonl", [&](const ordered_json& json) {
    CellRecord record = cell_record_from_json(json);
    const CellKey key = key_of(record);
    cells.add(key, std::move(record));
  });
  LastOfEachKey<MetricRecord, MetricKey> metrics(run.metrics);
  run.unreadable_lines += read_lines(folder / "metrics.jsonl", [&](const ordered_json& json) {
    MetricRecord record = metric_record_from_json(json);
    const MetricKey key = key_of(record);
    metrics.add(key, std::move(record));
  });
  return run;
}

}  // namespace results
