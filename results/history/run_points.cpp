#include "results/history/run_points.h"

#include <algorithm>

#include <fmt/format.h>

#include "results/comparison/row_pairs.h"
#include "results/run_values.h"

namespace results::history {

namespace {

constexpr const char* kTimes[] = {"total_s", "next_frame_s", "new_view_s"};

/// The points of one row.
class RowPoints {
 public:
  RowPoints(const RunValues& values, std::size_t index, std::vector<RunPoint>& points)
      : values_(values), index_(index), row_(values.summary().rows[index]), points_(points) {}

  void add_all() {
    for (const char* time : kTimes) add(Quantity::Kind::time, time, "s");
    add(Quantity::Kind::time, "peak_memory_bytes", "bytes");
    for (const std::string& stage : comparison::stages_of(values_.run(), row_)) {
      add(Quantity::Kind::stage, stage, "s");
    }
    for (const ScoreSummary& score : row_.scores) add_score(score);
  }

 private:
  void add(Quantity::Kind kind, const std::string& name, const char* unit) {
    Quantity quantity;
    quantity.kind = kind;
    quantity.name = name;
    quantity.text = name;
    quantity.unit = unit;
    quantity.is_first_frame = name == "total_s";
    add_estimate(quantity, values_.estimate(index_, quantity), Direction::lower);
  }

  void add_score(const ScoreSummary& score) {
    Quantity quantity;
    quantity.kind = Quantity::Kind::score;
    quantity.name = score.metric;
    quantity.against = score.against;
    quantity.text = score.against == "full" ? score.metric + "@full" : score.metric;
    Direction better = Direction::lower;
    if (const metrics::MetricDescription* info = metric_info_of(score.metric)) {
      quantity.unit = info->unit;
      if (info->better == metrics::Better::higher) better = Direction::higher;
    }
    add_estimate(quantity, values_.estimate(index_, quantity), better);
  }

  void add_estimate(const Quantity& quantity, const std::optional<Estimate>& value,
                    Direction better) {
    if (!value) return;
    const auto& cells = values_.run().cells;
    const auto measured = std::ranges::find_if(
        row_.records, [&](std::size_t i) { return is_success(cells[i].render.status); });
    if (measured == row_.records.end()) return;
    points_.push_back({row_.scene, row_.method, row_.budget, device_of(cells[*measured]),
                       quantity.text, quantity.unit, better, *value});
  }

  /// Times of several jobs at once are a series of their own.
  static std::string device_of(const CellRecord& record) {
    if (record.jobs == 1) return record.render.device;
    return fmt::format("{}, {} jobs", record.render.device, record.jobs);
  }

  const RunValues& values_;
  std::size_t index_;
  const SummaryRow& row_;
  std::vector<RunPoint>& points_;
};

}  // namespace

std::vector<RunPoint> points_of(const Run& run) {
  std::vector<RunPoint> points;
  const RunValues values(run);
  for (std::size_t i = 0; i < values.summary().rows.size(); ++i) {
    if (!values.summary().rows[i].records.empty()) RowPoints(values, i, points).add_all();
  }
  return points;
}

}  // namespace results::history
