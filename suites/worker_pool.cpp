#include "suites/worker_pool.h"

#include <unistd.h>

#include <algorithm>
#include <array>

namespace suites {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 2> kLogNames{"stdout.log", "stderr.log"};

OpenJob open_job_of(const PlannedCell& cell, const Suite& suite, const RunOptions& options) {
  OpenJob job;
  job.scene_file = fs::absolute(cell.scene->file);
  job.scene_overlays = cell.scene->overlays();
  job.frame = cell.scene->frames.first;
  job.is_sequence = cell.scene->frames.is_sequence;
  job.size_px = cell.scene->size_px;
  job.renderer = cell.method->choice.info->name;
  job.preset = cell.method->choice.preset;
  job.parameters = cell.method->choice.parameters.entries();
  job.threads = options.threads;
  job.platform = options.platform;
  job.warmups = suite.measure.warmup;
  return job;
}

}  // namespace

struct WorkerPool::Entry {
  const SuiteScene* scene = nullptr;
  const SuiteMethod* method = nullptr;
  OpenJob open;
  double timeout_s = 0.0;
  std::int64_t memory_bytes = 0;
  std::unique_ptr<WorkerProcess> process;
  std::uint64_t last_use = 0;
  fs::path log_folder;          ///< of the cell the worker was started for
  std::vector<fs::path> links;  ///< to its logs
};

std::int64_t idle_memory_bytes() {
  return static_cast<std::int64_t>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE) / 4;
}

WorkerPool::WorkerPool(const Suite& suite, const RunOptions& options)
    : suite_(suite), options_(options), idle_memory_bytes_(suites::idle_memory_bytes()) {}

WorkerPool::~WorkerPool() { close_all(); }

void WorkerPool::start(Entry& entry, const fs::path& cell_folder) {
  WorkerOptions options;
  options.executable =
      options_.worker_executable.empty() ? base::this_program() : options_.worker_executable;
  // A cell that linked to another's logs keeps writing where they are.
  entry.log_folder = cell_folder;
  if (fs::is_symlink(cell_folder / kLogNames[0])) {
    entry.log_folder = fs::weakly_canonical(cell_folder / kLogNames[0]).parent_path();
    if (entry.log_folder.parent_path() != fs::weakly_canonical(cell_folder).parent_path()) {
      throw base::InputError({(cell_folder / kLogNames[0]).string()},
                             "links to a file out of the run; accepted: another cell's log");
    }
  }
  options.stdout_file = entry.log_folder / kLogNames[0];
  options.stderr_file = entry.log_folder / kLogNames[1];
  options.timeout_s = entry.timeout_s;
  options.memory_bytes = entry.memory_bytes;
  options.is_interrupted = [] { return interrupt_requested.load(); };
  entry.process = std::make_unique<WorkerProcess>(options, entry.open);
}

void WorkerPool::close(Entry& entry) {
  if (entry.process == nullptr) return;
  entry.process->close();
  entry.process.reset();
  std::error_code error;
  for (const char* name : kLogNames) {
    const fs::path log = entry.log_folder / name;
    if (!fs::exists(log, error) || fs::file_size(log, error) > 0) continue;
    // Links first: a kill in between leaves none to a log that is gone.
    for (const fs::path& folder : entry.links) fs::remove(folder / name, error);
    fs::remove(log, error);
  }
  entry.links.clear();
}

void WorkerPool::link_logs(Entry& entry, const fs::path& cell_folder) {
  if (cell_folder == entry.log_folder) return;
  std::error_code error;
  for (const char* name : kLogNames) {
    if (fs::exists(fs::symlink_status(cell_folder / name, error))) continue;
    fs::create_symlink(fs::path("..") / entry.log_folder.filename() / name, cell_folder / name,
                       error);
  }
  if (std::find(entry.links.begin(), entry.links.end(), cell_folder) == entry.links.end()) {
    entry.links.push_back(cell_folder);
  }
}

void WorkerPool::make_room(const Entry& kept) {
  for (;;) {
    std::int64_t sum_bytes = 0;
    Entry* oldest = nullptr;
    for (const auto& entry : entries_) {
      if (entry.get() == &kept || entry->process == nullptr) continue;
      sum_bytes += entry->process->resident_bytes();
      if (oldest == nullptr || entry->last_use < oldest->last_use) oldest = entry.get();
    }
    if (oldest == nullptr || sum_bytes <= idle_memory_bytes_) return;
    close(*oldest);
  }
}

WorkerProcess& WorkerPool::worker(const PlannedCell& cell, const fs::path& cell_folder) {
  auto found = std::find_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
    return entry->scene == cell.scene && entry->method == cell.method;
  });
  if (found == entries_.end()) {
    auto entry = std::make_unique<Entry>();
    entry->scene = cell.scene;
    entry->method = cell.method;
    entry->open = open_job_of(cell, suite_, options_);
    entry->timeout_s = cell.measure.timeout_s;
    entry->memory_bytes = cell.measure.memory_bytes;
    found = entries_.insert(entries_.end(), std::move(entry));
  }
  Entry& entry = **found;
  make_room(entry);
  if (entry.process == nullptr || !entry.process->is_alive()) start(entry, cell_folder);
  link_logs(entry, cell_folder);
  entry.last_use = ++uses_;
  return *entry.process;
}

void WorkerPool::close_all() {
  for (const auto& entry : entries_) close(*entry);
  entries_.clear();
}

}  // namespace suites
