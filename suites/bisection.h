#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace suites {

/// What a tried revision is, set against a good one.
enum class Trial {
  good,
  bad,
  unknown  ///< could not be built or measured, or the difference is within noise
};

/// What a search came to. Indices are those of the list that was searched.
struct Bisection {
  std::size_t last_good = 0;
  std::size_t first_bad = 0;                 ///< the earliest that was found to be bad
  std::vector<std::size_t> unknown_between;  ///< any of these may be the first bad one, too

  bool is_exact() const { return unknown_between.empty(); }
};

/// Searches a list of revisions, the first known to be good, the last known to be bad, for the
/// first bad one by halving. What cannot be judged is set aside and the nearest revision to the
/// middle that can still be tried takes its place.
/// @param count  >= 2
/// @param try_one  called at most once per index, never for the first and the last
Bisection bisect(std::size_t count, const std::function<Trial(std::size_t)>& try_one);

}  // namespace suites
