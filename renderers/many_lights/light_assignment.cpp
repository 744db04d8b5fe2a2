#include "renderers/many_lights/light_assignment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace renderers::many_lights {

namespace {

/// Indices of positive weights, heaviest first, at most so many.
std::vector<std::size_t> heaviest(std::span<const double> weights, std::size_t most) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] > 0.0) order.push_back(i);
  }
  std::ranges::stable_sort(order, [&](auto a, auto b) { return weights[a] > weights[b]; });
  if (order.size() > most) order.resize(most);
  return order;
}

}  // namespace

std::vector<int> light_counts(std::span<const double> weights, int light_count) {
  std::vector<int> counts(weights.size(), 0);
  const auto chosen = heaviest(weights, static_cast<std::size_t>(std::max(light_count, 0)));
  if (chosen.empty()) return counts;
  double total = 0.0;
  for (const std::size_t i : chosen) total += weights[i];

  // One each, then the rest by how far the count is below the exact share.
  int left = light_count;
  for (const std::size_t i : chosen) {
    const double share = weights[i] / total * light_count;
    counts[i] = std::max(1, static_cast<int>(std::floor(share)));
    left -= counts[i];
  }
  const auto lacking = [&](std::size_t i) { return weights[i] / total * light_count - counts[i]; };
  for (; left > 0; --left) {
    ++counts[*std::ranges::max_element(chosen, {}, lacking)];
  }
  for (; left < 0; ++left) {
    const auto surplus = [&](std::size_t i) { return counts[i] > 1 ? -lacking(i) : -1e30; };
    --counts[*std::ranges::max_element(chosen, {}, surplus)];
  }
  return counts;
}

std::vector<LightSlot> assign_lights(std::span<const double> weights, int light_count) {
  const std::vector<int> counts = light_counts(weights, light_count);
  if (std::accumulate(counts.begin(), counts.end(), 0) == 0) return {};
  // Every emitter earns its count each turn; the richest pays the number of lights for a slot.
  // After all turns the debts are zero, so everyone got its count. Centred: half an interval first.
  std::vector<std::int64_t> credit(counts.size());
  for (std::size_t e = 0; e < counts.size(); ++e) credit[e] = counts[e] / 2;
  std::vector<int> dealt(counts.size(), 0);
  std::vector<LightSlot> slots;
  slots.reserve(static_cast<std::size_t>(light_count));
  for (int i = 0; i < light_count; ++i) {
    std::size_t richest = counts.size();
    for (std::size_t e = 0; e < counts.size(); ++e) {
      credit[e] += counts[e];
      if (dealt[e] == counts[e]) continue;
      if (richest == counts.size() || credit[e] > credit[richest]) richest = e;
    }
    credit[richest] -= light_count;
    slots.push_back({static_cast<int>(richest), dealt[richest]++});
  }
  return slots;
}

}  // namespace renderers::many_lights
