#include "suites/bisection.h"

#include <optional>

namespace suites {

namespace {

/// The untried index strictly between that lies nearest to the middle, the earlier of two.
std::optional<std::size_t> next_candidate(const Bisection& found,
                                          const std::vector<bool>& is_unknown) {
  const std::size_t doubled_middle = found.last_good + found.first_bad;
  std::optional<std::size_t> best;
  std::size_t best_distance = 0;
  for (std::size_t i = found.last_good + 1; i < found.first_bad; ++i) {
    if (is_unknown[i]) continue;
    const std::size_t distance =
        2 * i > doubled_middle ? 2 * i - doubled_middle : doubled_middle - 2 * i;
    if (best && distance >= best_distance) continue;
    best = i;
    best_distance = distance;
  }
  return best;
}

}  // namespace

Bisection bisect(std::size_t count, const std::function<Trial(std::size_t)>& try_one) {
  Bisection found{0, count - 1, {}};
  std::vector<bool> is_unknown(count, false);
  while (const std::optional<std::size_t> candidate = next_candidate(found, is_unknown)) {
    switch (try_one(*candidate)) {
      case Trial::good:
        found.last_good = *candidate;
        break;
      case Trial::bad:
        found.first_bad = *candidate;
        break;
      case Trial::unknown:
        is_unknown[*candidate] = true;
        break;
    }
  }
  for (std::size_t i = found.last_good + 1; i < found.first_bad; ++i) {
    found.unknown_between.push_back(i);
  }
  return found;
}

}  // namespace suites
