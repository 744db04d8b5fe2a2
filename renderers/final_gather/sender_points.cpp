#include "renderers/final_gather/sender_points.h"

#include <algorithm>
#include <cmath>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::final_gather {

using element_hierarchy::Element;
using element_hierarchy::kNoElement;
using element_hierarchy::SidePoint;
using ray_tracing::luminance;

namespace {

/// Memory of the points that are kept; ours.
constexpr std::size_t kKeptBytes = std::size_t{32} << 20U;
constexpr std::size_t kMostKept = 32;  ///< per sender

}  // namespace

glm::vec2 sender_position(Positions positions, std::uint64_t key, std::uint32_t index) {
  if (positions == Positions::random) {
    return glm::vec2(
        ray_tracing::SampleSequence(ray_tracing::SequenceKind::random, key, index).next());
  }
  // 1 / g and 1 / g^2 with g^3 = g + 1 (Roberts 2018).
  constexpr double kStepX = 0.75487766624669276;
  constexpr double kStepY = 0.56984029099805327;
  const std::uint64_t shift = ray_tracing::mix_bits(key);
  const double x = static_cast<double>(shift >> 32) * 0x1p-32 + kStepX * (index + 1.0);
  const double y = static_cast<double>(shift & 0xffffffffU) * 0x1p-32 + kStepY * (index + 1.0);
  const auto fraction = [](double value) {
    return std::fmin(static_cast<float>(value - std::floor(value)), 0x1.fffffep-1F);
  };
  return {fraction(x), fraction(y)};
}

SenderPoints::SenderPoints(const element_hierarchy::Solution& solution,
                           const SenderPointSettings& settings)
    : solution_(solution), settings_(settings) {
  if (settings.by_power) sum_powers();
  keep_points();
}

void SenderPoints::sum_powers() {
  const std::vector<glm::vec3>& radiosity = solution_.field->radiosity();
  double sum = 0.0;
  power_before_w_.reserve(solution_.tree->roots().size() + 1);
  power_before_w_.push_back(0.0);
  for (const std::uint32_t root : solution_.tree->roots()) {
    sum += static_cast<double>(solution_.tree->at(root).area_m2 * luminance(radiosity[root]));
    power_before_w_.push_back(sum);
  }
}

void SenderPoints::keep_points() {
  std::vector<std::uint32_t> senders;
  slots_.assign(solution_.tree->elements().size(), kNoElement);
  for (const element_hierarchy::Link& link : solution_.links.all()) {
    if (slots_[link.source] != kNoElement) continue;
    slots_[link.source] = static_cast<std::uint32_t>(senders.size());
    senders.push_back(link.source);
  }
  if (senders.empty()) return;
  const std::size_t room = kKeptBytes / (sizeof(SenderPoint) * senders.size());
  const auto count = static_cast<std::uint32_t>(std::min(kMostKept, room));
  std::vector<SenderPoint> points(count * senders.size());
  base::parallel_for(senders.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      for (std::uint32_t i = 0; i < count; ++i) points[slot * count + i] = fixed(senders[slot], i);
    }
  });
  kept_ = std::move(points);
  kept_per_sender_ = count;
}

bool SenderPoints::is_by_power(std::uint32_t sender) const {
  const Element& element = solution_.tree->at(sender);
  return settings_.by_power && !element.is_patch &&
         power_before_w_[element.root_end] > power_before_w_[element.root_begin];
}

std::uint64_t SenderPoints::key(std::uint32_t sender) const {
  return ray_tracing::hash_combine(settings_.seed, sender);
}

SenderPoint SenderPoints::fixed(std::uint32_t sender, std::uint32_t index) const {
  if (index < kept_per_sender_ && slots_[sender] != kNoElement) {
    return kept_[std::size_t{slots_[sender]} * kept_per_sender_ + index];
  }
  return at(sender, sender_position(settings_.positions, key(sender), index));
}

SenderPoint SenderPoints::at(std::uint32_t sender, const glm::vec2& u) const {
  return at(sender, is_by_power(sender) ? solution_.tree->sample(sender, u, power_before_w_)
                                        : solution_.tree->sample(sender, u));
}

SenderPoint SenderPoints::at(std::uint32_t sender, const SidePoint& side) const {
  SenderPoint point{side, mean_radiosity(sender)};
  if (!settings_.by_leaf) return point;
  const std::uint32_t leaf = solution_.tree->leaf_at(side.surface, side.normal);
  if (leaf == kNoElement) return point;
  const std::vector<glm::vec3>& radiosity = solution_.field->radiosity();
  point.radiosity = radiosity[leaf];
  if (is_by_power(sender)) {
    const std::uint32_t root = solution_.tree->roots()[side.root];
    point.radiosity *= luminance(radiosity[sender]) / luminance(radiosity[root]);
  }
  return point;
}

glm::vec3 SenderPoints::mean_radiosity(std::uint32_t sender) const {
  const element_hierarchy::RadiosityField& field = *solution_.field;
  return settings_.by_leaf ? field.radiosity()[sender] : field.sent()[sender];
}

std::int64_t SenderPoints::memory_bytes() const {
  return static_cast<std::int64_t>(power_before_w_.capacity() * sizeof(double) +
                                   slots_.capacity() * sizeof(std::uint32_t) +
                                   kept_.capacity() * sizeof(SenderPoint));
}

}  // namespace renderers::final_gather
