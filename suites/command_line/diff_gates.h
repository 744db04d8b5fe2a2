#pragma once

#include <string>
#include <vector>

#include "metrics/metric_list.h"

namespace suites::command_line {

/// A limit of `diff`: --fail-above NAME=V, --fail-below NAME=V.
struct DiffGate {
  std::string text;    ///< "flip=0.1"
  std::string metric;  ///< the text given to --metric, or the metric's name
  std::string detail;  ///< "" for the value
  double limit = 0.0;
  bool is_upper = true;
};

/// @throws base::InputError if a gate names no metric asked for, is no number, or would fail the
///   better images (--fail-above of a metric where higher is better)
std::vector<DiffGate> parse_gates(const std::vector<std::string>& above,
                                  const std::vector<std::string>& below,
                                  const std::vector<metrics::AnyMetricChoice>& choices);

/// True if the gate is about this metric.
bool concerns(const DiffGate& gate, const metrics::AnyMetricChoice& choice);

/// True if the score is on the wrong side of the limit. NaN is not: it is a failure of its own.
/// @throws base::InputError if the score lacks the detail
bool is_violated(const DiffGate& gate, const metrics::Score& score);

}  // namespace suites::command_line
