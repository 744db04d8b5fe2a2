#include "metrics/visible_regions.h"

#include <algorithm>
#include <numeric>

#include "metrics/score_pooling.h"

namespace metrics {
namespace {

/// Pixels [begin, end) of a row.
struct Run {
  int y, begin, end;
  float largest;
};

std::vector<Run> runs_above(const Image& map, const Image* mask, float limit) {
  std::vector<Run> runs;
  for (int y = 0; y < map.height_px; ++y) {
    const std::size_t row = map.offset(0, y);
    for (int x = 0; x < map.width_px; ++x) {
      const std::size_t i = row + static_cast<std::size_t>(x);
      const float value = map.pixels[i];
      if (!(value > limit) || !takes_part(mask, i)) continue;
      if (runs.empty() || runs.back().y != y || runs.back().end != x) {
        runs.push_back({y, x, x, value});
      }
      runs.back().end = x + 1;
      runs.back().largest = std::max(runs.back().largest, value);
    }
  }
  return runs;
}

/// Disjoint sets of runs; the root of a set is its first run.
class RunSets {
 public:
  explicit RunSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t run) {
    while (parent_[run] != run) {
      parent_[run] = parent_[parent_[run]];
      run = parent_[run];
    }
    return run;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t first = root(a);
    const std::size_t second = root(b);
    parent_[std::max(first, second)] = std::min(first, second);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Joins runs of neighbouring rows that touch, also at corners.
void join_neighbours(const std::vector<Run>& runs, RunSets& sets) {
  std::size_t above = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto is_before = [&](const Run& other) {
      return other.y < runs[i].y - 1 || (other.y == runs[i].y - 1 && other.end < runs[i].begin);
    };
    while (above < i && is_before(runs[above])) ++above;
    for (std::size_t k = above; k < i; ++k) {
      if (runs[k].y != runs[i].y - 1 || runs[k].begin > runs[i].end) break;
      sets.join(k, i);
    }
  }
}

struct Growing {
  Region region;
  std::size_t pixels = 0;
};

void grow(Growing& one, const Run& run) {
  Region& box = one.region;
  if (one.pixels == 0) {
    box = {run.begin, run.y, run.end - run.begin, 1, static_cast<double>(run.largest)};
  } else {
    const int right = std::max(box.x_px + box.width_px, run.end);
    box.x_px = std::min(box.x_px, run.begin);
    box.width_px = right - box.x_px;
    box.height_px = run.y + 1 - box.y_px;
    box.value = std::max(box.value, static_cast<double>(run.largest));
  }
  one.pixels += static_cast<std::size_t>(run.end - run.begin);
}

}  // namespace

VisibleRegions visible_regions(const Image& map, const Image* mask, float limit, std::size_t most) {
  const std::vector<Run> runs = runs_above(map, mask, limit);
  RunSets sets(runs.size());
  join_neighbours(runs, sets);

  // A root comes before the other runs of its set.
  std::vector<std::size_t> index(runs.size());
  std::vector<Growing> all;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::size_t root = sets.root(i);
    if (root == i) {
      index[i] = all.size();
      all.emplace_back();
    }
    grow(all[index[root]], runs[i]);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Growing& a, const Growing& b) { return a.pixels > b.pixels; });

  VisibleRegions result;
  result.count = all.size();
  if (!all.empty()) result.most_pixels = all.front().pixels;
  for (std::size_t i = 0; i < std::min(most, all.size()); ++i) {
    result.largest.push_back(all[i].region);
  }
  return result;
}

}  // namespace metrics
