#pragma once

#include <filesystem>
#include <string>

#include "results/result_store.h"

namespace results::html_report {

/// One offline HTML file of a run: overview matrix, per scene images side by side, error maps on
/// one fixed scale per metric with a colour bar, stage bars with the unattributed rest, failures,
/// provenance. A pure function of the stored results.
std::string html_report(const Run& run);

/// Writes <run>/report/index.html atomically and returns its path.
std::filesystem::path write_report(const Run& run);

}  // namespace results::html_report
