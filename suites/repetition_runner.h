#pragma once

#include <string>
#include <vector>

#include "results/result_store.h"
#include "suites/cell_progress.h"
#include "suites/worker_pool.h"

namespace suites {

/// Runs single repetitions of planned cells in workers and stores what became of them.
class RepetitionRunner {
 public:
  /// @param scenes  one per suite scene; the arguments must live as long as this
  RepetitionRunner(const Suite& suite, const std::vector<renderers::scene::Scene>& scenes,
                   const RunOptions& options, results::RunFolder& folder);

  /// Runs the cell's next repetition and appends its record to the run.
  /// @throws Interrupted if it was stopped; nothing is stored then
  void run(const PlannedCell& cell, CellProgress& progress);
  /// Ends the workers: nothing of the scene is needed any more.
  void close_workers() { pool_.close_all(); }

 private:
  results::CellRecord begin_record(const PlannedCell& cell, int repetition) const;
  RenderOrder order_of(const PlannedCell& cell, const CellProgress& progress) const;
  void take_answer(WorkerAnswer answer, const PlannedCell& cell, const CellProgress& progress,
                   results::CellRecord& record) const;

  const Suite& suite_;
  const std::vector<renderers::scene::Scene>& scenes_;
  const RunOptions& options_;
  results::RunFolder& folder_;
  WorkerPool pool_;
  std::string machine_;
};

}  // namespace suites
