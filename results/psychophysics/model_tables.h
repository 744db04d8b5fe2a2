#pragma once

#include <string>
#include <vector>

#include "results/psychophysics/model_summary.h"
#include "results/tables.h"

namespace results::psychophysics {

/// A row of what people show, then one per model that has anything to say of it: thresholds found,
/// misfit, by halves where the stimuli have them, and every phenomenon. Models with nothing to say
/// are named in a note.
Table model_table(const Experiment& experiment, const std::vector<ModelSummary>& summaries);

/// One row per model, by its misfit on the calibration halves of all experiments together: the
/// first one is the calibrated model, its misfit on the held-out halves is what that is worth.
/// Empty if no stimulus belongs to a half.
Table calibration_table(const PsychophysicsRun& run);

/// One row per stimulus: observed, and what each of the models says with its residual.
Table stimulus_table(const PsychophysicsRun& run, const Experiment& experiment);

/// "yes 0.63", "no 12.0 dB": what the model makes of a phenomenon; "-" for nothing.
std::string format_verdict(const PhenomenonVerdict& verdict);

/// A phenomenon's value in its unit: "0.56", "12.9 dB", "0.95", "17 of 21".
std::string format_phenomenon_value(const Phenomenon& phenomenon, double value);

}  // namespace results::psychophysics
