#include "metrics/threshold_search.h"

#include <cassert>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "perception/base/errors.h"

namespace metrics {

FoundThreshold find_threshold(const std::function<double(double)>& response, double criterion,
                              const SearchRange& range) {
  assert(range.lowest > 0.0 && range.largest > range.lowest && range.precision_db > 0.0);
  FoundThreshold found;
  const auto is_seen = [&](double log_contrast) {
    ++found.evaluations;
    return response(std::pow(10.0, log_contrast)) >= criterion;
  };
  double low = std::log10(range.lowest);
  double high = std::log10(range.largest);
  if (!is_seen(high)) return found;
  if (is_seen(low)) {
    found.is_below_range = true;
    return found;
  }
  constexpr double kDbPerDecade = 20.0;
  while ((high - low) * kDbPerDecade > range.precision_db) {
    const double middle = 0.5 * (low + high);
    (is_seen(middle) ? high : low) = middle;
  }
  found.contrast = std::pow(10.0, 0.5 * (low + high));
  return found;
}

double response_to(const perception::StimulusPair& pair, const Readout& readout,
                   const ViewingConditions& viewing) {
  ScoreOptions options;
  options.with_map = false;
  const Score scored = score(readout.metric, {pair.reference, pair.test}, viewing, options);
  if (readout.detail.empty()) {
    const double identical = readout.metric.info->identical_value;
    // Where identical pictures are infinitely good (psnr), an error grows as the score falls.
    if (std::isinf(identical)) return -scored.value;
    return std::abs(scored.value - identical);
  }
  std::vector<std::string> known;
  for (const NamedValue& detail : scored.details) {
    if (detail.name == readout.detail) return detail.value;
    known.push_back(detail.name);
  }
  throw base::InputError(base::unknown_name(fmt::format("detail of {}", readout.metric.info->name),
                                            readout.detail, known));
}

}  // namespace metrics
