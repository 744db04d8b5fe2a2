#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/figures/figure_spec.h"
#include "results/figures/file_metadata.h"
#include "results/result_store.h"

namespace results::figures {

/// Where a figure comes from: figure, suite, run, time, tool and commit, machine.
Metadata provenance_of(const FigureSpec& figure, const Run& run);
/// The same, a line each.
std::vector<std::string> lines_of(const Metadata& provenance);

/// Puts them into a finished file, SVG, PDF or PNG by its extension.
/// @throws base::InputError if the file is none
void stamp(const std::filesystem::path& file, const Metadata& provenance);

}  // namespace results::figures
