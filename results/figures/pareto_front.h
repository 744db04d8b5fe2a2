#pragma once

#include <vector>

#include "results/statistics.h"

namespace results::figures {

/// A row as two numbers that are better the lower they are.
struct Contestant {
  Estimate cost;
  Estimate error;
};

enum class Standing {
  front,      ///< no other is at least as good in both and better in one
  undecided,  ///< another is, but its intervals overlap with this one's in both
  dominated   ///< another is, and is clearly better in at least one
};

/// Whether the interval of `a` lies below that of `b`. A single sample has no interval: nothing is
/// clear about it.
bool is_clearly_below(const Estimate& a, const Estimate& b);

/// Of each contestant how it stands.
///
/// One dominates another (ours) if both its values are at most the other's and, in cost or error,
/// the 95 % intervals do not overlap. So noise alone removes nobody from the front, and no row can
/// dominate one that dominates it.
std::vector<Standing> pareto_standings(const std::vector<Contestant>& contestants);

/// Indices of the front by rising cost.
std::vector<std::size_t> front_of(const std::vector<Contestant>& contestants,
                                  const std::vector<Standing>& standings);

}  // namespace results::figures
