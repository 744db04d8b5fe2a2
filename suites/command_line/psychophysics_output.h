#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "results/psychophysics/psychophysics_run.h"
#include "suites/psychophysics/psychophysics_runner.h"
#include "suites/psychophysics/psychophysics_suite.h"

namespace suites::command_line {

/// {"schema","status","kind","suite","summary","file","experiments","models","cells"}:
/// schemas/psychophysics-check.json.
nlohmann::ordered_json check_json(const psychophysics::PsychophysicsSuite& suite,
                                  const std::vector<psychophysics::PlannedQuestion>& questions);
/// The same for a person.
std::string check_text(const psychophysics::PsychophysicsSuite& suite,
                       const std::vector<psychophysics::PlannedQuestion>& questions);

/// [{"id","models":[{"model","stimuli","thresholds","rms_db",...,"phenomena":[...]}]}]
nlohmann::ordered_json summary_json(const results::psychophysics::PsychophysicsRun& run);
/// A table per experiment, and the calibration where there is one.
std::string summary_text(const results::psychophysics::PsychophysicsRun& run);

}  // namespace suites::command_line
