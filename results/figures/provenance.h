#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/figures/figure_spec.h"
#include "results/result_store.h"

namespace results::figures {

/// Where a figure comes from, a line each: suite, run, time, tool and commit, machine.
std::vector<std::string> provenance_lines(const FigureSpec& figure, const Run& run);

/// Puts the lines into a finished file: of a SVG as its <metadata>, of a PDF as comments after its
/// end, which is then repeated, so that readers find it.
/// @throws base::InputError if the file is neither
void stamp(const std::filesystem::path& file, const std::vector<std::string>& lines);

}  // namespace results::figures
