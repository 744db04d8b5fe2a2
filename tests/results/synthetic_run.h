#pragma once

#include <filesystem>
#include <string>

#include "results/result_store.h"

namespace test_results {

/// A record with a value in every field, none of them the default.
results::RenderRecord full_render_record();
results::CellRecord full_cell_record();
results::MetricRecord full_metric_record();

/// A successful repetition of a cell with stages that add up to total_s.
results::CellRecord timed_cell(const std::string& scene, const std::string& method,
                               std::uint64_t seed, double total_s);

/// Writes a finished run with images, references and maps under <root>: scenes "box" and
/// "<script>alert(1)</script>", methods "pt8" (2 seeds, 2 repetitions), "direct-only" (one
/// repetition) and "broken" (crash with a log; unsupported). Two planned cells are still missing.
/// @return the run folder
std::filesystem::path write_synthetic_run(const std::filesystem::path& root, int width_px,
                                          int height_px);

}  // namespace test_results
