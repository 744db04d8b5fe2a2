#pragma once

#include <filesystem>
#include <string>

#include "results/psychophysics/psychophysics_run.h"

namespace results::html_report {

/// The page of a run of kind psychophysics: what people saw and what the models say. A pure
/// function of the stored results.
std::string psychophysics_page(const psychophysics::PsychophysicsRun& run);

/// Writes <run>/report/index.html. @return its path
std::filesystem::path write_report(const psychophysics::PsychophysicsRun& run);

}  // namespace results::html_report
