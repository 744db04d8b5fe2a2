#pragma once

#include <string>
#include <vector>

#include "results/history/history_output.h"

namespace results::html_report {

/// One quantity of every row of a suite, over its runs.
struct QuantityTrends {
  std::string quantity;  ///< as claims name it: "total_s", "flip@full"
  std::vector<history::Trend> trends;
};

/// What a trend page is of: runs of one profile on one machine.
struct TrendSource {
  std::string suite;
  std::string profile;
  std::string machine;
};

/// One offline page: every step of every quantity, the newest first, then a table per quantity with
/// a line per row. A pure function of the series; without JavaScript it can be read as it is.
std::string trend_page(const TrendSource& source, const std::vector<QuantityTrends>& quantities);

}  // namespace results::html_report
