#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "suites/command_line/suite_selection.h"
#include "suites/cost_records.h"

namespace suites::command_line {

/// What each profile of a suite would cost.
struct ProfileCosts {
  struct Row {
    std::string profile;  ///< "" for the suite without one
    CostEstimate estimate;
  };
  std::string machine;
  StoredCosts measured;  ///< what the rows are estimated from
  std::vector<Row> rows;
};

/// Plans every profile of the selected suite with the selection's other options, and the suite as
/// it is where no profile is selected.
/// @param planned  the plan of the selection; its scenes are not loaded again
ProfileCosts profile_costs(const SuiteSelection& selection, const PlannedSuite& planned,
                           const std::filesystem::path& results_root);

/// {"machine","runs","references","unreadable","left_out":["scores"],"profiles":[{"profile",
///  "cells","repetitions":[least, most],"references","seconds":[least, most],
///  "references_seconds","from":{"same_scene","same_renderer","time_budget"},
///  "unmeasured":{"cells","references"}}]}; seconds are those of what was measured.
nlohmann::ordered_json costs_json(const ProfileCosts& costs);

/// A table with a row per profile, and what it is made from.
std::string costs_text(const ProfileCosts& costs);

}  // namespace suites::command_line
