#include "results/figures/pareto_front.h"

#include <algorithm>

namespace results::figures {

namespace {

bool is_at_least_as_good(const Contestant& a, const Contestant& b) {
  return a.cost.value <= b.cost.value && a.error.value <= b.error.value;
}

Standing standing_against(const Contestant& other, const Contestant& one) {
  const bool is_better = other.cost.value < one.cost.value || other.error.value < one.error.value;
  if (!is_at_least_as_good(other, one) || !is_better) return Standing::front;
  const bool is_clear =
      is_clearly_below(other.cost, one.cost) || is_clearly_below(other.error, one.error);
  return is_clear ? Standing::dominated : Standing::undecided;
}

}  // namespace

bool is_clearly_below(const Estimate& a, const Estimate& b) {
  return a.count > 1 && b.count > 1 && a.high < b.low;
}

std::vector<Standing> pareto_standings(const std::vector<Contestant>& contestants) {
  std::vector<Standing> standings;
  for (const Contestant& one : contestants) {
    Standing worst = Standing::front;
    for (const Contestant& other : contestants) {
      worst = std::max(worst, standing_against(other, one));
    }
    standings.push_back(worst);
  }
  return standings;
}

std::vector<std::size_t> front_of(const std::vector<Contestant>& contestants,
                                  const std::vector<Standing>& standings) {
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    if (standings[i] == Standing::front) front.push_back(i);
  }
  std::sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) {
    return contestants[a].cost.value < contestants[b].cost.value;
  });
  return front;
}

}  // namespace results::figures
