#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "results/result_store.h"
#include "suites/canary.h"
#include "suites/cell_progress.h"
#include "suites/worker_pool.h"

namespace suites {

/// One frame of a probe.
struct ProbedFrame {
  results::RenderRecord record;
  std::filesystem::path image;
};

/// A repetition that is measured to find a setting and not kept.
struct ProbeOutcome {
  std::vector<ProbedFrame> frames;
  std::string failure;  ///< "" if every frame is there
};

/// Runs single repetitions of planned cells in workers and stores what became of them.
class RepetitionRunner {
 public:
  /// The arguments must live as long as this.
  RepetitionRunner(const Suite& suite, const RunOptions& options, results::RunFolder& folder);

  /// Runs the cell's next repetition and appends its record to the run, of a sequence one record
  /// per frame, each as soon as it is there. The sequence ends with a frame that fails. What comes
  /// back from another device than the cell's first success is recorded as `unsupported`.
  /// @param show  called after every frame with the part of the repetition that is done
  /// @throws Interrupted if it was stopped; nothing is stored of the frame at hand then
  void run(const PlannedCell& cell, CellProgress& progress,
           const std::function<void(double)>& show = {});
  /// One repetition that leaves no record; its images stand until the next probe of the cell. Of a
  /// sequence, its first frames (kProbedFrames of them).
  /// @throws Interrupted
  ProbeOutcome probe(const PlannedCell& cell);
  static constexpr std::size_t kProbedFrames = 4;
  /// Removes the images of the cell's last probe.
  void end_probes(const PlannedCell& cell) const;

  /// Ends the workers: nothing of the scene is needed any more.
  void close_workers() { pool_.close_all(); }

 private:
  results::CellRecord begin_record(const PlannedCell& cell, int repetition,
                                   const PlannedFrame& frame) const;
  RenderOrder order_of(const PlannedCell& cell, const CellProgress& progress, int repetition,
                       const PlannedFrame& frame) const;
  void take_answer(WorkerAnswer answer, const PlannedCell& cell, const CellProgress& progress,
                   results::CellRecord& record) const;
  results::CellRecord run_frame(const PlannedCell& cell, const CellProgress& progress,
                                int repetition, const PlannedFrame& frame);

  const Suite& suite_;
  const RunOptions& options_;
  results::RunFolder& folder_;
  WorkerPool pool_;
  Canary canary_;
  std::string machine_;
};

}  // namespace suites
