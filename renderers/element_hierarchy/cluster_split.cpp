#include "renderers/element_hierarchy/cluster_split.h"

#include <algorithm>
#include <array>
#include <limits>

#include <glm/common.hpp>

namespace renderers::element_hierarchy {

namespace {

constexpr std::size_t kBins = 16;

struct Bin {
  glm::vec3 low{std::numeric_limits<float>::infinity()};
  glm::vec3 high{-std::numeric_limits<float>::infinity()};
  std::size_t count = 0;

  void add(const glm::vec3& box_min, const glm::vec3& box_max, std::size_t number) {
    if (number == 0) return;
    low = glm::min(low, box_min);
    high = glm::max(high, box_max);
    count += number;
  }
  double cost() const {
    if (count == 0) return 0.0;
    const glm::dvec3 side(high - low);
    return (side.x * side.y + side.y * side.z + side.z * side.x) * static_cast<double>(count);
  }
};

int longest_axis(const glm::vec3& extent) {
  if (extent.x >= extent.y && extent.x >= extent.z) return 0;
  return extent.y >= extent.z ? 1 : 2;
}

/// Bins [0, result) against the rest, at least cost; 0: all in one bin.
std::size_t best_boundary(const std::array<Bin, kBins>& bins) {
  std::array<double, kBins> right_cost{};
  Bin right;
  for (std::size_t i = kBins; i-- > 1;) {
    right.add(bins[i].low, bins[i].high, bins[i].count);
    right_cost[i] = right.count > 0 ? right.cost() : -1.0;
  }
  Bin left;
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < kBins; ++i) {
    left.add(bins[i - 1].low, bins[i - 1].high, bins[i - 1].count);
    if (left.count == 0 || right_cost[i] < 0.0) continue;
    const double cost = left.cost() + right_cost[i];
    if (cost < least) {
      least = cost;
      best = i;
    }
  }
  return best;
}

}  // namespace

std::size_t split_cluster(std::span<Element> patches) {
  glm::vec3 low(std::numeric_limits<float>::infinity());
  glm::vec3 high = -low;
  for (const Element& patch : patches) {
    low = glm::min(low, box_center(patch));
    high = glm::max(high, box_center(patch));
  }
  const int axis = longest_axis(high - low);
  const float width = high[axis] - low[axis];
  const auto bin_of = [&](const Element& patch) {
    const float place = (box_center(patch)[axis] - low[axis]) / width;
    return std::min(kBins - 1, static_cast<std::size_t>(place * static_cast<float>(kBins)));
  };
  std::size_t boundary = 0;
  if (width > 0.0F) {
    std::array<Bin, kBins> bins;
    for (const Element& patch : patches) {
      bins[bin_of(patch)].add(patch.box_min, patch.box_max, 1);
    }
    boundary = best_boundary(bins);
  }
  if (boundary == 0) return patches.size() / 2;
  const auto middle =
      std::stable_partition(patches.begin(), patches.end(),
                            [&](const Element& patch) { return bin_of(patch) < boundary; });
  return static_cast<std::size_t>(middle - patches.begin());
}

}  // namespace renderers::element_hierarchy
