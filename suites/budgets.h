#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "metrics/metric.h"
#include "perception/base/document.h"
#include "renderers/renderer_list.h"

namespace suites {

/// A score that a budget asks for: one of the suite's image metrics, against the own transport.
struct ErrorTarget {
  std::string metric;  ///< as the suite writes it
  double at = 0.0;
  friend bool operator==(const ErrorTarget&, const ErrorTarget&) = default;
};

/// How much work a cell gets. `fixed`, none of these: the renderer's parameters decide.
struct Budget {
  std::optional<std::int64_t> samples;
  std::optional<double> time_s;
  std::string time_of;  ///< as long as this method takes; "" unless it is a budget of equal time
  std::optional<ErrorTarget> error;
  /// "64spp" (samples), "10s", "time-of-pt", "relmse=0.05", "fixed"
  std::string name() const;
  friend bool operator==(const Budget&, const Budget&) = default;
};

/// What is changed to meet a budget by time or error: `samples`, or a parameter that is a number.
struct SearchedSetting {
  std::string name = "samples";
  double from = 1.0;
  double to = 65536.0;
  bool is_whole = true;
  friend bool operator==(const SearchedSetting&, const SearchedSetting&) = default;
};

/// Reads `budgets`: [{samples: 64}, {samples: [16, 64]}, {time: 10s}, {time: {of: pt}},
/// {error: {metric: relmse, at: [0.1, 0.01]}}, fixed].
/// @throws base::InputError with the place for anything else, and for a budget that is listed twice
std::vector<Budget> read_budgets(const base::Node& node);

/// Reads `search`: {setting: vpls, from: 16, to: 65536}; `setting` alone for samples or for the
/// whole range that the parameter declares.
/// @throws base::InputError: no such parameter, not a number, no positive bounds
SearchedSetting read_search(const base::Node& node, const renderers::RendererInfo& renderer);

/// Whether a metric's values fall to 0 as the images get alike.
bool is_error(const metrics::MetricDescription& metric);

/// Whether a setting has to be found for the budget: always by error and for an equal time; a time
/// in seconds is left to a progressive renderer's own clock unless the method declares `search`.
bool is_searched(const Budget& budget, bool has_search);

}  // namespace suites
