#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/run_record.h"
#include "results/search_record.h"

namespace results {

/// A run folder (DESIGN section 4): run.json, suite.resolved.yaml, cells.jsonl, metrics.jsonl,
/// images/, maps/, report/. One writer at a time, held by a lock file.
class RunFolder {
 public:
  /// Opens an existing folder, or makes it. Takes the lock.
  /// @throws base::InputError if another process holds it (names pid and machine), or if the folder
  ///   cannot be written
  static RunFolder open_for_writing(const std::filesystem::path& folder);
  RunFolder(RunFolder&&) noexcept;
  ~RunFolder();

  const std::filesystem::path& path() const { return path_; }
  /// Replaces run.json. Readers use these keys and do without those that are absent:
  /// {"schema":1,"run","suite","summary","profile","command",
  ///  "environment":{run_environment()},"viewing":{to_json(ViewingConditions)},
  ///  "scenes":[{"id","size_px":[W,H],"exposure_ev","frame"}],"methods":[{"id"}],
  ///  "budgets":["64spp"],
  ///  "metrics":["flip"],"planned_cells":[{"cell","scene","method","budget","seed"}],
  ///  "references":[{"scene","frame","transport","geometry_clamp","hash"} or {..., "reason"}],
  ///  "state":"running|complete|interrupted","updated_utc"}
  /// "scenes" ... "metrics" give the order of tables; "exposure_ev" of a scene overrides
  /// "viewing"'s; planned cells without a record are shown as "not yet".
  void write_run_json(const nlohmann::ordered_json& run);
  void write_resolved_suite(const std::string& yaml);
  /// Appends one line and flushes it to the disk, from any thread; a line that an earlier process
  /// left cut is ended first. @throws base::InputError with the system's reason; nothing is left
  /// half-written
  void append(const CellRecord& record);
  void append(const MetricRecord& record);
  void append(const CheckpointScore& record);
  void append(const SearchRecord& record);
  /// A line of cells.jsonl of another kind of run.
  void append_cell(const nlohmann::ordered_json& record);
  /// Folder of a cell's images and logs; made on first use.
  std::filesystem::path cell_folder(const std::string& cell) const;

 private:
  RunFolder(std::filesystem::path path, int lock_fd);
  void append_line_to(const char* file, const nlohmann::ordered_json& record);
  std::filesystem::path path_;
  int lock_fd_ = -1;
  std::unique_ptr<std::mutex> mutex_;  ///< one line at a time
};

/// Everything stored about a run.
struct Run {
  std::filesystem::path folder;
  std::shared_ptr<const nlohmann::ordered_json> info;  ///< run.json, never null
  std::string resolved_suite;                          ///< suite.resolved.yaml
  std::vector<CellRecord> cells;      ///< the last record of a (cell, repetition, frame) wins
  std::vector<MetricRecord> metrics;  ///< the last record of a (cell, frame, against, metric) wins
  /// The last record of a (cell, checkpoint, against, metric) wins.
  std::vector<CheckpointScore> checkpoint_scores;
  std::vector<SearchRecord> searches;  ///< the last record of a (scene, method, budget) wins
  std::size_t unreadable_lines = 0;    ///< a line cut by a crash is skipped and counted
};
/// What `kind` in run.json says: "images" (also where nothing is said), "psychophysics".
std::string run_kind(const std::filesystem::path& folder);
/// Reads a run; works while it is still being written.
/// @throws base::InputError if the folder is no run, or one of another kind than "images"
Run load_run(const std::filesystem::path& folder);

/// `--results DIR`, else $DISCERN_RESULTS, else results/ of the checkout.
std::filesystem::path results_root(const std::string& option);

/// A new name for a run of a suite: <results>/runs/<suite>/<utc>-<id>, after those of all runs that
/// are there.
std::filesystem::path new_run_folder(const std::filesystem::path& results_root,
                                     const std::string& suite);
/// The newest run of a suite, or of all; empty path if there is none.
std::filesystem::path newest_run(const std::filesystem::path& results_root,
                                 const std::string& suite);
/// The newest of a profile; "" if there is none.
std::filesystem::path newest_run_of_profile(const std::filesystem::path& results_root,
                                            const std::string& suite, const std::string& profile);
/// A run by path, by id, by suite name (newest) or "last". @throws base::InputError
std::filesystem::path find_run(const std::filesystem::path& results_root, const std::string& name);

}  // namespace results
