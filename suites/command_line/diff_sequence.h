#pragma once

#include <vector>

#include "suites/command_line/diff_scores.h"

namespace suites::command_line {

/// Scores test sequences frame by frame; one frame of each and those that a metric looks back on
/// are in memory. Settings that a metric would choose by each reference frame are the same for all.
/// @param choices  must outlive the result, whose reference is named by its pattern
/// @throws base::InputError, also for a file that is missing, before anything is scored
DiffOutcome diff_sequences(const DiffArguments& arguments,
                           const std::vector<metrics::AnyMetricChoice>& choices);

}  // namespace suites::command_line
