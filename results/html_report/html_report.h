#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "results/html_report/float_store.h"
#include "results/result_store.h"

namespace results::html_report {

/// One offline HTML file of a run: overview matrix, per scene images side by side and a viewer for
/// their floats, error maps on one fixed scale per metric with a colour bar, stage bars with the
/// unattributed rest, gates, failures, provenance. A pure function of the stored results.
std::string html_report(const Run& run);

struct ReportOptions {
  Split split = Split::automatic;
  std::uint64_t split_above_bytes = kSplitAboveBytes;  ///< of automatic: of its data, as text
};

struct ReportFiles {
  std::filesystem::path index;
  bool is_split = false;
  std::uint64_t data_bytes = 0;  ///< float images, as text
};

/// Writes <run>/report/index.html atomically, and if it is split the float images and previews to
/// <run>/report/data/, where the page looks for them as they are asked for.
ReportFiles write_report(const Run& run, const ReportOptions& options = {});

/// Whether the page that is there shows all that is stored: it is newer than the run's records, its
/// baseline, and this program.
bool is_report_current(const Run& run);
std::filesystem::path report_file(const Run& run);

}  // namespace results::html_report
