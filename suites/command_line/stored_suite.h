#pragma once

#include <string>

#include "results/result_store.h"
#include "suites/suite_file.h"

namespace suites::command_line {

/// A suite as its file is now, with one of its runs.
struct StoredSuite {
  Suite suite;  ///< without a profile: only its claims and figures matter
  results::Run run;
};

/// @param run  as `find_run` takes it; "": the newest run of the suite
/// @throws base::InputError if there is no run of the suite, or the one named is of another
StoredSuite load_stored_suite(const std::string& suite, const std::string& run,
                              const std::string& results_option);

}  // namespace suites::command_line
