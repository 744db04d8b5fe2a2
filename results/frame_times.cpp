#include "results/frame_times.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "perception/base/quantile.h"

namespace results {

FrameTimes frame_times(const std::vector<CellRecord>& cells, std::span<const std::size_t> records) {
  std::map<std::pair<std::string, int>, std::vector<double>> by_repetition;
  std::map<int, std::vector<double>> by_frame;
  std::vector<std::pair<double, std::size_t>> all;
  for (const std::size_t index : records) {
    const RenderRecord& render = cells[index].render;
    const bool is_timed = is_success(render.status) && render.next_frame_s.has_value();
    if (!is_timed || !std::isfinite(*render.next_frame_s)) continue;
    by_repetition[{cells[index].cell, cells[index].repetition}].push_back(*render.next_frame_s);
    by_frame[render.frame].push_back(*render.next_frame_s);
    all.emplace_back(*render.next_frame_s, index);
  }
  FrameTimes times;
  if (all.empty()) return times;
  std::vector<double> p50_s;
  std::vector<double> p95_s;
  for (const auto& [repetition, values] : by_repetition) {
    p50_s.push_back(base::median(values));
    p95_s.push_back(base::quantile(values, 0.95));
  }
  times.p50_s = median_with_interval(p50_s);
  times.p95_s = median_with_interval(p95_s);
  for (const auto& [frame, values] : by_frame) {
    times.frames.push_back({frame, median_with_interval(values)});
  }
  std::sort(all.begin(), all.end());
  times.typical = all[(all.size() - 1) / 2].second;
  return times;
}

}  // namespace results
