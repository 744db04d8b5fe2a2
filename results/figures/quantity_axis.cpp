#include "results/figures/quantity_axis.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "results/figures/figure_rows.h"

namespace results::figures {

namespace {

/// An interval that comes near 0 would stretch a logarithmic axis without end.
constexpr double kFarthestInterval = 10.0;

/// Whether a noise floor belongs on the axis: it may lengthen it by half.
bool is_near(double floor, const std::vector<double>& values, bool is_log) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (is_log) {
    if (floor <= 0.0) return false;
    const double span = std::max(std::log10(*most / *least), 1.0);
    return floor > *least * std::pow(10.0, -0.75 * span) && floor < *most * 10.0;
  }
  const double span = std::max(*most - *least, 0.1 * std::abs(*most));
  return floor > *least - span && floor < *most + 0.5 * span;
}

}  // namespace

void add_note(std::vector<std::string>& notes, const std::string& note) { add_once(notes, note); }

bool is_log_axis(std::optional<bool> asked, const Quantity& quantity,
                 const std::vector<double>& values) {
  if (asked) return *asked;
  if (!is_error(quantity)) return spans_a_decade(values);
  return std::all_of(values.begin(), values.end(), [](double value) { return value > 0.0; });
}

ChartAxis axis_of_points(const std::vector<ChartLine>& lines, Estimate ChartPoint::*side,
                         const Quantity& quantity, std::optional<bool> asked,
                         std::vector<std::string>& notes) {
  std::vector<double> values;
  for (const ChartLine& line : lines) {
    if (line.look == LineLook::floor) continue;
    for (const ChartPoint& point : line.points) values.push_back((point.*side).value);
  }
  const bool is_log = is_log_axis(asked, quantity, values);
  const auto lost = std::count_if(values.begin(), values.end(),
                                  [&](double value) { return is_log && value <= 0.0; });
  if (lost > 0) {
    add_note(notes,
             fmt::format("{} value{} of {} at or below 0 {} no place on a logarithmic axis.", lost,
                         lost == 1 ? "" : "s", quantity.text, lost == 1 ? "has" : "have"));
    std::erase_if(values, [](double value) { return value <= 0.0; });
  }
  std::vector<double> shown = values;
  for (const ChartLine& line : lines) {
    for (const ChartPoint& point : line.points) {
      const Estimate& estimate = point.*side;
      if (line.look == LineLook::floor) {
        if (values.empty()) continue;
        if (is_near(estimate.value, values, is_log)) {
          shown.push_back(estimate.value);
        } else if (side == &ChartPoint::y) {
          add_note(notes, fmt::format("Reference noise of {} is at {:.2g}, beyond the axis.",
                                      quantity.text, estimate.value));
        }
        continue;
      }
      shown.push_back(is_log ? std::max(estimate.low, estimate.value / kFarthestInterval)
                             : estimate.low);
      shown.push_back(estimate.high);
    }
  }
  ChartAxis axis = fitted_axis(shown, is_log, AxisStart::at_values);
  axis.title = axis_title(quantity);
  return axis;
}

std::optional<double> noise_floor_of(const FigureRun& run, std::size_t row,
                                     const Quantity& quantity) {
  if (quantity.kind != Quantity::Kind::score || !quantity.detail.empty()) return std::nullopt;
  const ScoreSummary* score = run.summary().rows[row].find_score(quantity.name, quantity.against);
  return score == nullptr ? std::nullopt : score->noise_floor;
}

}  // namespace results::figures
