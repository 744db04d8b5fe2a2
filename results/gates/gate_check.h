#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/comparison/row_changes.h"
#include "results/gates/gate.h"
#include "results/run_values.h"
#include "results/tables.h"

namespace results::gates {

enum class Outcome { passed, failed, inconclusive, not_measured };
std::string to_string(Outcome outcome);

/// What a gate says of one row. `change.verdict`: worse = failed, better and same = passed.
struct GateEntry {
  std::size_t gate = 0;  ///< index into GateReport::gates
  comparison::Change change;
};
Outcome outcome_of(const comparison::Change& change);

struct GateReport {
  std::vector<Gate> gates;
  std::vector<GateEntry> entries;  ///< by gate, rows in the order of the run
  std::vector<std::string> notes;

  std::size_t count(Outcome outcome) const;
  /// Failed if one row failed; else inconclusive if one is; else not measured if one is not; a gate
  /// that concerns no row is not measured.
  Outcome outcome(std::size_t gate) const;
  /// The same over all gates.
  Outcome overall() const;
};

/// Changes are tested as in comparison.h, with false discoveries controlled over the changes of
/// all gates together. A limit fails where the interval of a score over seeds, or of a median time,
/// lies beyond it; where it reaches across, the gate is inconclusive.
/// @param baseline  null: gates that need one are `not_measured`
/// @param why_none  what to do about that, a note
GateReport check_gates(const std::vector<Gate>& gates, const RunValues* baseline,
                       const RunValues& run, const std::string& why_none);

/// A row per entry that did not pass, then counts; `all`: of every entry.
Table gate_table(const GateReport& report, bool all);

/// {"outcome","counts","entries":[{"gate","outcome","scene","method","budget","quantity",...}]}
nlohmann::ordered_json to_json(const GateReport& report);

}  // namespace results::gates
