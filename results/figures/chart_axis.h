#pragma once

#include <string>
#include <vector>

namespace results::figures {

struct AxisTick {
  double value = 0.0;
  std::string label;  ///< a gnuplot string
};

/// A numeric axis: its ends and ticks. We choose them, so that marks and labels can be placed.
struct ChartAxis {
  double low = 0.0;
  double high = 1.0;
  bool is_log = false;
  std::vector<AxisTick> ticks;
  std::string title;

  /// Whether a value can be shown.
  bool has_place(double value) const;
  /// Place of a value from 0 (low) to 1 (high), beyond them outside.
  double position(double value) const;
};

enum class AxisStart { at_zero, at_values };

/// An axis over all values that have a place on it, with some room at its ends.
/// @param values  finite; of a logarithmic axis those > 0 count
/// @param start   at_zero: a linear axis of values that are not negative begins at 0; at_values
///                does, too, where 0 is not far
ChartAxis fitted_axis(const std::vector<double>& values, bool is_log, AxisStart start);

/// Ticks at round values between the ends.
void put_round_ticks(ChartAxis& axis);
/// Ticks at the values themselves, if they are few and far enough from each other.
void put_ticks_at(std::vector<double> values, ChartAxis& axis);

/// True if the values are > 0 and their largest is more than ten times their least.
bool spans_a_decade(const std::vector<double>& values);

/// Commands that give the axis its range, scale and ticks. @param name  'x' or 'y'
std::string axis_commands(char name, const ChartAxis& axis);

}  // namespace results::figures
