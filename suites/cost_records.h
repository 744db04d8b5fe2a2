#pragma once

#include <filesystem>
#include <string>

#include "suites/cost_estimate.h"

namespace suites {

/// What this machine measured, and how much of it could not be read.
struct StoredCosts {
  CostRecords records;
  std::size_t runs = 0;
  std::size_t unreadable = 0;  ///< runs and references that are damaged or of another version
};

/// The newest run of each suite and all references under a results folder that a machine made.
StoredCosts load_costs(const std::filesystem::path& results_root, const std::string& machine);

}  // namespace suites
