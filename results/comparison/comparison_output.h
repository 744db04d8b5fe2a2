#pragma once

#include <nlohmann/json_fwd.hpp>

#include "results/comparison/comparison.h"
#include "results/tables.h"

namespace results::comparison {

/// "- worse", "+ better", "= same", "? inconclusive", "x invalid", ". not measured": verdicts that
/// are told apart without colour.
std::string format_verdict(Verdict verdict);

/// Verdict, scene, method, budget, quantity (under the title given), values, change, q, reason.
Table table_of(const std::vector<Change>& changes, const char* quantity_title);

/// A row per change, or only those that are better, worse or invalid.
Table change_table(const Comparison& comparison, bool only_changed);
/// Stages of rows whose time changed; no rows if there are none.
Table stage_table(const Comparison& comparison);
/// Geometric means over scenes; no rows for a single scene.
Table overall_table(const Comparison& comparison);
/// "2 worse, 1 better, 40 same, 3 inconclusive"
std::string format_counts(const Comparison& comparison);

nlohmann::ordered_json to_json(const Change& change);
/// {"counts","changes":[...],"stages":[...],"overall":[...],"notes"}
nlohmann::ordered_json to_json(const Comparison& comparison);

}  // namespace results::comparison
