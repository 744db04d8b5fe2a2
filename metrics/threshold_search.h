#pragma once

#include <functional>
#include <optional>
#include <string>

#include "metrics/metric_list.h"
#include "perception/stimuli.h"

namespace metrics {

/// Where a threshold is looked for.
struct SearchRange {
  double lowest = 1e-5;        ///< > 0
  double largest = 1.0;        ///< > lowest
  double precision_db = 0.05;  ///< > 0, of 20 log10(contrast)
};

struct FoundThreshold {
  /// Contrast of the criterion; absent if it is not reached at the largest contrast, or is passed
  /// at the lowest one already.
  std::optional<double> contrast;
  bool is_below_range = false;  ///< seen at the lowest contrast
  int evaluations = 0;
};

/// The contrast at which a growing response reaches a criterion, by bisection of its logarithm; of
/// a response that falls again, one of its crossings.
/// @param response  of a contrast; NaN counts as not reached
FoundThreshold find_threshold(const std::function<double(double contrast)>& response,
                              double criterion, const SearchRange& range);

/// What of a metric's score tells whether a difference is seen.
struct Readout {
  MetricChoice metric;
  std::string detail;  ///< a detail of the score; "" for its value
};

/// How far the score of a pair is from that of identical images: > 0 where the metric sees a
/// difference, whichever way it is better. @throws base::InputError for a detail the metric lacks,
/// naming those it has, and as `score`
double response_to(const perception::StimulusPair& pair, const Readout& readout,
                   const ViewingConditions& viewing);

}  // namespace metrics
