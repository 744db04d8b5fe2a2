#include "results/figures/chart_axis.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "results/figures/gnuplot_text.h"
#include "results/html_report/stage_bars.h"

namespace results::figures {

namespace {

constexpr double kRoom = 0.07;   ///< at each end, as a part of the span
constexpr double kSlack = 1e-9;  ///< a tick at the very end may lie beyond it by rounding

double span_of(const ChartAxis& axis) {
  return axis.is_log ? std::log10(axis.high / axis.low) : axis.high - axis.low;
}

/// Powers of ten and, where there is room, 2 and 5 times them, or every whole multiple.
std::vector<double> log_values(const ChartAxis& axis) {
  const double decades = span_of(axis);
  std::vector<double> factors{1.0};
  if (decades <= 3.2) factors = {1.0, 3.0};
  if (decades <= 1.8) factors = {1.0, 2.0, 5.0};
  if (decades <= 0.8) factors = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0};
  const int step = std::max(1, static_cast<int>(std::ceil(decades / 8.0)));
  std::vector<double> values;
  for (int power = static_cast<int>(std::floor(std::log10(axis.low)));
       std::pow(10.0, power) <= axis.high; ++power) {
    if (power % step != 0) continue;
    for (const double factor : factors) {
      const double value = factor * std::pow(10.0, power);
      const double place = axis.position(value);
      if (place >= -kSlack && place <= 1.0 + kSlack) values.push_back(value);
    }
  }
  return values;
}

std::vector<double> linear_values(const ChartAxis& axis) {
  const std::vector<double> from_zero = html_report::axis_ticks(axis.high - axis.low);
  const double step = from_zero.size() > 1 ? from_zero[1] : 1.0;
  std::vector<double> values;
  for (double i = std::ceil(axis.low / step - kSlack); i * step <= axis.high + kSlack * step;
       i += 1.0) {
    values.push_back(i * step);
  }
  return values;
}

/// "0.02", or "2·10^-6" in gnuplot's enhanced text where that is shorter.
std::string number_label(double value) {
  if (value == 0.0) return "'0'";
  const int power = static_cast<int>(std::floor(std::log10(std::abs(value)) + kSlack));
  if (power >= -3 && power <= 4) return fmt::format("'{:g}'", value);
  const double factor = value / std::pow(10.0, power);
  if (std::abs(factor - 1.0) < 1e-6) return fmt::format("'10^{{{}}}'", power);
  return fmt::format("'{:.3g}·10^{{{}}}'", factor, power);
}

void set_ticks(const std::vector<double>& values, ChartAxis& axis) {
  axis.ticks.clear();
  for (const double value : values) axis.ticks.push_back({value, number_label(value)});
}

}  // namespace

bool ChartAxis::has_place(double value) const {
  return std::isfinite(value) && (!is_log || value > 0.0);
}

double ChartAxis::position(double value) const {
  if (is_log) return std::log(value / low) / std::log(high / low);
  return (value - low) / (high - low);
}

ChartAxis fitted_axis(const std::vector<double>& values, bool is_log, AxisStart start) {
  ChartAxis axis;
  axis.is_log = is_log;
  std::vector<double> placed;
  std::copy_if(values.begin(), values.end(), std::back_inserter(placed),
               [&](double value) { return axis.has_place(value); });
  if (!placed.empty()) {
    const auto [least, most] = std::minmax_element(placed.begin(), placed.end());
    axis.low = *least;
    axis.high = *most;
  } else if (is_log) {
    axis.low = 0.1;
  }
  if (is_log) {
    const double room = std::pow(10.0, std::max(kRoom * span_of(axis), 0.05));
    axis.low /= room;
    axis.high *= room;
  } else {
    const bool can_be_zero = axis.low >= 0.0;
    const bool is_near = axis.low < 0.5 * axis.high;
    const double least_span = axis.high == 0.0 ? 1.0 : 0.02 * std::abs(axis.high);
    const double room = kRoom * std::max(axis.high - axis.low, least_span);
    axis.high += room;
    const bool is_from_zero = can_be_zero && (start == AxisStart::at_zero || is_near);
    axis.low = is_from_zero ? 0.0 : axis.low - room;
  }
  put_round_ticks(axis);
  return axis;
}

void put_round_ticks(ChartAxis& axis) {
  std::vector<double> ticks = axis.is_log ? log_values(axis) : linear_values(axis);
  if (ticks.size() < 2) ticks = linear_values(axis);
  set_ticks(ticks, axis);
}

void put_ticks_at(std::vector<double> values, ChartAxis& axis) {
  constexpr std::size_t kMostTicks = 8;
  constexpr double kLeastDistance = 0.075;
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.empty() || values.size() > kMostTicks) return;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!axis.has_place(values[i])) return;
    const bool is_close =
        i > 0 && axis.position(values[i]) - axis.position(values[i - 1]) < kLeastDistance;
    if (is_close) return;
  }
  set_ticks(values, axis);
}

bool spans_a_decade(const std::vector<double>& values) {
  if (values.empty()) return false;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *least > 0.0 && *most > 10.0 * *least;
}

std::string axis_commands(char name, const ChartAxis& axis) {
  std::string ticks;
  for (const AxisTick& tick : axis.ticks) {
    ticks += fmt::format("{}{} {}", ticks.empty() ? "" : ", ", tick.label, tick.value);
  }
  return fmt::format("{0} logscale {1}\nset {1}range [{2}:{3}]\nset {1}tics ({4}) nomirror\n",
                     axis.is_log ? "set" : "unset", name, axis.low, axis.high, ticks);
}

}  // namespace results::figures
