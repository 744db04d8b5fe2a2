#pragma once

#include <filesystem>
#include <string>

#include "suites/suite_runner.h"

namespace suites {

/// What a suite's runs are known by.
struct SuiteIdentity {
  std::string name;
  std::string resolved;  ///< the text of suite.resolved.yaml
};

/// The run folder that a suite's results belong to.
///
/// `options.run_folder` if it is given (it must hold the same resolved suite, or nothing yet). Else
/// the newest run of the suite whose resolved file, build, machine, threads and platform are the
/// same, whether it is finished or not; with `force`, or if there is none, a new folder's name.
///
/// @throws base::InputError if the folder asked for holds another suite's or another build's
/// results
std::filesystem::path choose_run_folder(const SuiteIdentity& suite, const RunOptions& options);

}  // namespace suites
