#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/result_store.h"
#include "suites/cell_progress.h"
#include "suites/progress_meter.h"
#include "suites/reference_images.h"
#include "suites/repetition_runner.h"
#include "suites/run_description.h"
#include "suites/run_plan.h"
#include "suites/scoring.h"
#include "suites/suite_runner.h"

namespace suites {

/// One session on one run folder: what was there, what is done now. Holds the folder's lock.
class RunSession {
 public:
  RunSession(const Suite& suite, const RunOptions& options, const std::filesystem::path& folder,
             const std::function<void(const Progress&)>& report);
  ~RunSession();

  /// References, repetitions, scores: whatever is missing.
  RunOutcome run();
  /// Scores what is missing. @return how many were made
  std::size_t evaluate();

 private:
  void read_earlier_work();
  void describe_stored_references();
  std::set<std::size_t> needed_references() const;
  void check_references(const PlannedCell& cell, const CellProgress& progress) const;
  bool needs_more(std::size_t cell) const;
  std::size_t repetitions_to_come(std::size_t cell) const;
  bool has_work();
  bool says_the_same(const nlohmann::ordered_json& stored) const;
  void plan_progress();
  void write_info(RunState state);
  void make_references();
  void make_reference(const PlannedReference& planned);
  void run_repetitions();
  void solve_budgets(const SuiteScene& scene, RepetitionRunner& runner);
  void apply_search(const results::SearchRecord& search);
  void run_rounds(const std::vector<std::size_t>& cells, RepetitionRunner& runner);
  void run_repetitions_in_jobs();
  std::vector<std::vector<std::size_t>> cells_by_worker() const;
  void run_one(std::size_t cell, RepetitionRunner& runner);
  void make_scores();
  ScoringInput scoring_input() {
    return {suite_, plan_, chosen_, progress_, references_, known_scores_};
  }
  RunOutcome outcome() const;
  void plan_scores(const PlannedCell& cell, std::size_t count);

  const Suite& suite_;
  const RunOptions& options_;
  std::vector<SceneStates> scenes_;
  RunPlan plan_;
  results::RunFolder folder_;
  ReferenceStore references_;
  ProgressMeter meter_;
  std::vector<std::size_t> chosen_;  ///< cells that the filter leaves
  std::vector<CellProgress> progress_;
  std::vector<results::MetricRecord> known_scores_;
  std::vector<results::CheckpointScore> known_checkpoint_scores_;
  std::unique_ptr<nlohmann::ordered_json> info_;               ///< run.json
  std::shared_ptr<const nlohmann::ordered_json> stored_info_;  ///< as found; null for a new run
  std::vector<std::size_t> planned_scores_;                    ///< of each chosen cell
  std::size_t new_repetitions_ = 0;
  std::size_t failed_references_ = 0;
  std::size_t failed_scores_ = 0;
  bool was_interrupted_ = false;
  std::mutex mutex_;  ///< of the meter and the counts, beside other jobs
  std::atomic<bool> has_job_failed_ = false;
};

}  // namespace suites
