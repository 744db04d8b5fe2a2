#include "suites/setting_search.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace suites {
namespace {

/// Exponent that an error is taken to fall with while there is one probe: that of a squared error
/// of independent samples. For others it steps short, never too far.
constexpr double kFirstExponent = 1.0;

}  // namespace

/// Where a law is a straight line: its abscissa ...
double SettingSearch::position(double setting) const {
  return goal_.law == SearchGoal::Law::time ? setting : std::log(setting);
}

/// ... and its ordinate, rising with the setting.
double SettingSearch::height(double measured) const {
  // An error of nothing is better than any target.
  constexpr double kSmallest = 1e-300;
  if (goal_.law == SearchGoal::Law::error) return -std::log(std::max(measured, kSmallest));
  return measured;
}

double SettingSearch::setting_at(double position) const {
  double setting = goal_.law == SearchGoal::Law::time ? position : std::exp(position);
  if (goal_.is_whole) setting = std::round(setting);
  return std::clamp(setting, goal_.from, goal_.to);
}

/// Relative distance from the target.
double SettingSearch::distance(const Probe& probe) const {
  return std::abs(probe.measured - goal_.target) / std::abs(goal_.target);
}

bool SettingSearch::is_tried(double setting) const {
  return std::any_of(probes_.begin(), probes_.end(),
                     [&](const Probe& probe) { return probe.setting == setting; });
}

const Probe* SettingSearch::nearest_below() const {
  const Probe* nearest = nullptr;
  for (const Probe& probe : probes_) {
    if (height(probe.measured) >= height(goal_.target)) continue;
    if (nearest == nullptr || probe.setting > nearest->setting) nearest = &probe;
  }
  return nearest;
}

const Probe* SettingSearch::nearest_above() const {
  const Probe* nearest = nullptr;
  for (const Probe& probe : probes_) {
    if (height(probe.measured) < height(goal_.target)) continue;
    if (nearest == nullptr || probe.setting < nearest->setting) nearest = &probe;
  }
  return nearest;
}

/// All probes lie on one side: follow the line through the two outermost, or the law through one.
double SettingSearch::extrapolated() const {
  const bool is_below = height(probes_.front().measured) < height(goal_.target);
  std::vector<Probe> nearest = probes_;
  std::sort(nearest.begin(), nearest.end(), [&](const Probe& a, const Probe& b) {
    return is_below ? a.setting > b.setting : a.setting < b.setting;
  });
  const Probe& first = nearest.front();
  // How far the law goes without a second probe.
  double slope =
      goal_.law == SearchGoal::Law::time ? first.measured / first.setting : kFirstExponent;
  if (goal_.law == SearchGoal::Law::score) slope = 0.0;
  if (nearest.size() > 1) {
    const Probe& second = nearest[1];
    const double rise = height(second.measured) - height(first.measured);
    const double run = position(second.setting) - position(first.setting);
    if (rise / run > 0.0) slope = rise / run;
  }
  const double limit = is_below ? first.setting * kMaxGrowth : first.setting / kMaxGrowth;
  if (slope <= 0.0) return setting_at(position(limit));
  const double wanted =
      position(first.setting) + (height(goal_.target) - height(first.measured)) / slope;
  const double bounded =
      is_below ? std::min(wanted, position(limit)) : std::max(wanted, position(limit));
  double setting = setting_at(bounded);
  // At least a step further than all that was tried.
  if (goal_.is_whole && setting == first.setting) setting += is_below ? 1.0 : -1.0;
  return std::clamp(setting, goal_.from, goal_.to);
}

std::optional<double> SettingSearch::next() const {
  if (probes_.empty()) return setting_at(position(std::clamp(kFirstSetting, goal_.from, goal_.to)));
  if (distance(best()) <= goal_.tolerance || probes_.size() >= goal_.max_probes) {
    return std::nullopt;
  }
  const Probe* below = nearest_below();
  const Probe* above = nearest_above();
  if (below == nullptr || above == nullptr) {
    const double setting = extrapolated();
    if (is_tried(setting)) return std::nullopt;  // at a bound, or nothing lies between
    return setting;
  }
  // Noise can turn two neighbours round; there is nothing between them to find then.
  const double low = position(std::min(below->setting, above->setting));
  const double high = position(std::max(below->setting, above->setting));
  const double share = (height(goal_.target) - height(below->measured)) /
                       (height(above->measured) - height(below->measured));
  const double start = position(below->setting);
  double setting = setting_at(start + share * (position(above->setting) - start));
  if (is_tried(setting)) setting = setting_at(0.5 * (low + high));
  if (is_tried(setting)) return std::nullopt;
  return setting;
}

void SettingSearch::add(double measured) {
  const std::optional<double> setting = next();
  assert(setting && std::isfinite(measured));
  probes_.push_back({*setting, measured});
}

const Probe& SettingSearch::best() const {
  assert(!probes_.empty());
  return *std::min_element(probes_.begin(), probes_.end(), [&](const Probe& a, const Probe& b) {
    return distance(a) < distance(b);
  });
}

SettingSearch::End SettingSearch::end() const {
  if (distance(best()) <= goal_.tolerance) return End::met;
  if (nearest_below() == nullptr && is_tried(goal_.from)) return End::below_reach;
  if (nearest_above() == nullptr && is_tried(goal_.to)) return End::beyond_reach;
  return End::nearest;
}

std::string to_string(SettingSearch::End end) {
  switch (end) {
    case SettingSearch::End::met:
      return "met";
    case SettingSearch::End::nearest:
      return "nearest";
    case SettingSearch::End::below_reach:
      return "below_reach";
    case SettingSearch::End::beyond_reach:
      return "beyond_reach";
  }
  return "";
}

}  // namespace suites
