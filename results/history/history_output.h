#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/history/history_index.h"
#include "results/history/step_detection.h"

namespace results::history {

/// A series with its steps.
struct Trend {
  Series series;
  std::vector<Step> steps;
};
Trend trend_of(Series series, double least_effect);
/// One of each, in order; on all cores.
std::vector<Trend> trends_of(std::vector<Series> series, double least_effect);

/// "▁▁▂█": the newest values, at most `width` of them, between the least and the greatest.
std::string sparkline(const Series& series, std::size_t width);

/// A row per trend: scene, method, budget, runs, first and last value, a line of the values, the
/// last step with run and commit; where devices differ they are told.
Table trend_table(const std::vector<Trend>& trends);
/// A list of {"scene","method","budget","device","unit","points":[...],"steps":[...]}.
nlohmann::ordered_json to_json(const std::vector<Trend>& trends);

}  // namespace results::history
