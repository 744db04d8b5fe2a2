#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "perception/base/document.h"

/// What a suite does not let pass: limits of numbers, and of their change since the baseline.
namespace results::gates {

/// Share of a row's time from which on `stage: each` concerns a stage, unless a gate names another;
/// ours.
inline constexpr double kLeastShare = 0.1;

/// One entry of `gates:`.
struct Gate {
  std::string text;      ///< as messages name it: "visible-difference worse by 5%"
  std::string quantity;  ///< as claims name it: "flip.p99@full", "total_s", "stage.gather"
  bool is_score = false;
  /// Concerns every top-level stage that takes at least `share` of its row's time; `quantity` is
  /// "stage.each" then.
  bool is_each_stage = false;
  double share = kLeastShare;
  /// Least relative change for the worse, since the baseline; a share.
  std::optional<double> worse_by;
  double alpha = 0.01;            ///< share of false alarms among the changes of all gates together
  std::optional<double> at_most;  ///< limits that need no baseline
  std::optional<double> at_least;
  std::vector<std::string> scenes;   ///< ids, with or without sweep values; empty: all
  std::vector<std::string> methods;  ///< likewise
  base::Place place;                 ///< of the quantity's name; no line where not read from a file

  bool needs_baseline() const { return worse_by.has_value(); }
};

/// Reads the list `gates:` of a suite:
/// `{metric: NAME[.DETAIL], against: own|full, worse_by: SHARE, alpha: SHARE}`,
/// `{stage: total|next_frame|new_view|PATH, slower_by: SHARE}`, `{stage: each, slower_by: SHARE,
/// share: SHARE}`, and with limits `at_most: NUMBER` (a time in units, "2s"), `at_least: NUMBER`;
/// each with `scenes`, `methods`.
/// @throws base::InputError with file:line:column
std::vector<Gate> read_gates(const base::Node& list);

/// Fields as in a suite: reading them back gives the same gates.
nlohmann::ordered_json to_json(const std::vector<Gate>& gates);

/// "val" names "val" and "val[vals=30]".
bool names(const std::vector<std::string>& ids, const std::string& id);

}  // namespace results::gates
