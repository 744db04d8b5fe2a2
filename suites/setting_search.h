#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace suites {

/// What is searched for: the value of a setting at which a measured number meets its target.
struct SearchGoal {
  enum class Law {
    time,   ///< about a + b n in the setting n, growing
    error,  ///< about c n^-p in the setting n, falling
    score   ///< about a + b log n in the setting n, growing: better is higher
  };
  Law law = Law::time;
  double target = 0.0;      ///< > 0 for time and error
  double from = 1.0;        ///< least value of the setting, > 0
  double to = 65536.0;      ///< greatest value
  bool is_whole = true;     ///< the setting counts: whole values only
  double tolerance = 0.05;  ///< |measured / target - 1| (of `score` |measured - target| / |target|)
  std::size_t max_probes = 8;
};

/// One measurement on the way.
struct Probe {
  double setting = 0.0;
  double measured = 0.0;
};

/// Finds the setting that meets a target with few measurements: the law of the goal through the
/// two probes around it (regula falsi; by halves where that stands still), or beyond the outermost
/// ones, growing by at most kMaxGrowth at a time.
///
/// Use: while (auto setting = search.next()) search.add(measure(*setting));
class SettingSearch {
 public:
  static constexpr double kMaxGrowth = 64.0;
  /// Where a search starts, within the goal's bounds.
  static constexpr double kFirstSetting = 16.0;

  explicit SettingSearch(const SearchGoal& goal) : goal_(goal) {}

  /// The setting to measure next; nothing when the search has ended.
  std::optional<double> next() const;
  /// @param measured  at what `next` said; finite
  void add(double measured);

  const std::vector<Probe>& probes() const { return probes_; }

  enum class End {
    met,          ///< within the tolerance
    nearest,      ///< no better setting exists, or max_probes were made: the nearest one
    below_reach,  ///< even `from` is beyond the target: takes longer, or is better than asked
    beyond_reach  ///< even `to` is not enough
  };
  /// How it ended. @pre next() is empty and there is at least one probe
  End end() const;
  /// The probe nearest to the target.
  const Probe& best() const;

 private:
  double position(double setting) const;
  double height(double measured) const;
  double setting_at(double position) const;
  double distance(const Probe& probe) const;
  bool is_tried(double setting) const;
  double extrapolated() const;
  const Probe* nearest_below() const;
  const Probe* nearest_above() const;

  SearchGoal goal_;
  std::vector<Probe> probes_;
};

std::string to_string(SettingSearch::End end);

}  // namespace suites
