#pragma once

#include <functional>
#include <string>
#include <vector>

#include "results/psychophysics/experiment.h"
#include "suites/psychophysics/psychophysics_suite.h"
#include "suites/suite_runner.h"

namespace suites::psychophysics {

/// One question: an experiment's stimulus and a model, by their places in the suite.
struct PlannedQuestion {
  const SuiteExperiment* experiment = nullptr;
  const Trial* trial = nullptr;
  const SuiteModel* model = nullptr;
};

/// Every stimulus x model, experiments first, of those whose "<experiment>.<stimulus>.<model>"
/// matches a filter (ECMAScript regex; "" for all). @throws base::InputError for a bad filter
std::vector<PlannedQuestion> plan_questions(const PsychophysicsSuite& suite,
                                            const std::string& filter);

/// Asks every model about every stimulus and keeps the answers in a run folder; running again goes
/// on where an earlier run of the same suite, build and machine stopped.
///
/// `finished_repetitions` of the outcome counts answers; `skipped_cells` those that are no question
/// for their model.
/// @param report  called from one thread
RunOutcome run_psychophysics(const PsychophysicsSuite& suite, const RunOptions& options,
                             const std::function<void(const Progress&)>& report);

}  // namespace suites::psychophysics
