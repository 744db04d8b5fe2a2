#pragma once

#include <filesystem>

#include "results/psychophysics/psychophysics_run.h"

namespace tests {

/// A run of two models on three thresholds and one elevation: "exact" says what people say, "lax"
/// 6 dB more of thresholds and 3 dB less of the elevation; "silent" has no answer at all.
results::psychophysics::PsychophysicsRun synthetic_experiment(const std::filesystem::path& folder);

results::psychophysics::PredictionRecord prediction(const std::string& stimulus,
                                                    const std::string& model, double db);

}  // namespace tests
