#pragma once

#include <filesystem>
#include <vector>

namespace suites {

/// Makes one run of several that each did a part of the same suite (`--filter`), in a new folder;
/// the parts stay. Records, scores, searches and curves are put behind each other, images and maps
/// copied.
///
/// @param parts  run folders, at least two
/// @return the new folder, <results>/runs/<suite>/<utc>-<id>
/// @throws base::InputError, before anything is written, if what was measured, the profile, build,
///   machine, threads or platform differ, a part is not complete, or a cell is in two of them
std::filesystem::path merge_runs(const std::filesystem::path& results_root,
                                 const std::vector<std::filesystem::path>& parts);

}  // namespace suites
