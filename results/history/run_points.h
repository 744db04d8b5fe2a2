#pragma once

#include <string>
#include <vector>

#include "results/result_store.h"
#include "results/statistics.h"
#include "results/tables.h"

namespace results::history {

/// One number of a run that trends are drawn of.
struct RunPoint {
  std::string scene;
  std::string method;
  std::string budget;
  std::string device;
  std::string quantity;
  std::string unit;
  Direction better = Direction::lower;
  Estimate value;
};

/// Times, top-level stages, peak memory and scores (own and full) of every row that has them.
std::vector<RunPoint> points_of(const Run& run);

}  // namespace results::history
