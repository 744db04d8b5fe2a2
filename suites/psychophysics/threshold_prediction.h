#pragma once

#include "results/psychophysics/prediction_record.h"
#include "suites/psychophysics/psychophysics_suite.h"

namespace suites::psychophysics {

/// What a model says of a trial: status, reason, threshold, samples, evaluations.
///
/// A trial that is no question for the model is `unsupported`; a target that is not seen at the
/// largest contrast, or is seen at the lowest, is `ok` without a threshold.
/// @param suite  where the model's anchor is looked up
/// @throws Interrupted
results::psychophysics::PredictionRecord predict(const SuiteModel& model, const Trial& trial,
                                                 const PsychophysicsSuite& suite);

}  // namespace suites::psychophysics
