#include "renderers/ray_bundles/direction_set.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "renderers/many_lights/halton.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::ray_bundles {

namespace {

constexpr std::int64_t kMostBlock = 1024;

/// A number in [0, 1) of a hash.
double unit_number(std::uint64_t hash) {
  constexpr int kUsedBits = 53;
  return std::ldexp(static_cast<double>(hash >> (64 - kUsedBits)), -kUsedBits);
}

double random_number(std::uint64_t seed, std::int64_t index, std::uint64_t dimension) {
  return unit_number(ray_tracing::hash_combine(
      ray_tracing::hash_combine(seed, static_cast<std::uint64_t>(index)), dimension));
}

double fraction(double value) {
  const double rest = value - std::floor(value);
  return rest < 1.0 ? rest : 0.0;
}

/// Halton points of bases 2 and 3, from index 1: index 0 is a corner of the square.
glm::dvec2 halton_point(std::int64_t index) {
  const auto i = static_cast<std::uint64_t>(index) + 1;
  return {many_lights::radical_inverse(i, 2), many_lights::radical_inverse(i, 3)};
}

/// Dimensions of the numbers drawn per direction and per set.
enum : std::uint64_t { kRoll, kJitterX, kJitterY, kFirst, kSecond, kShuffle, kRotateX, kRotateY };

}  // namespace

DirectionSet::DirectionSet(DirectionKind kind, std::uint64_t seed, std::int64_t planned,
                           std::int64_t set_size)
    : kind_(kind),
      seed_(seed),
      planned_(planned > 0 ? planned : std::numeric_limits<std::int64_t>::max()),
      set_size_(set_size > 0  ? set_size
                : planned > 0 ? planned
                              : kMostBlock) {}

void DirectionSet::set_importance(DirectionImportance importance, double share) {
  if (share <= 0.0 || importance.is_empty()) return;
  importance_ = std::move(importance);
  share_ = share;
}

BundleDirection DirectionSet::at(std::int64_t index) {
  glm::dvec2 place = point(index);
  if (kind_ != DirectionKind::iid) {
    // A further complete set is another rotation of the first.
    const bool is_set = kind_ == DirectionKind::hammersley || kind_ == DirectionKind::fibonacci;
    const std::int64_t set = is_set ? index / set_size_ : 0;
    place.x = fraction(place.x + random_number(seed_, set, kRotateX));
    place.y = fraction(place.y + random_number(seed_, set, kRotateY));
  }
  BundleDirection bundle;
  if (!importance_) {
    bundle.direction = direction_on_sphere(place);
  } else {
    // The first coordinate chooses, and is stretched again: both parts stay well distributed.
    bundle.direction = place.x < share_
                           ? importance_->sample({place.x / share_, place.y})
                           : direction_on_sphere({(place.x - share_) / (1.0 - share_), place.y});
    const double over_uniform = 4.0 * std::numbers::pi * importance_->density(bundle.direction);
    bundle.weight = static_cast<float>(1.0 / (1.0 - share_ + share_ * over_uniform));
  }
  bundle.roll_rad = static_cast<float>(2.0 * std::numbers::pi * random_number(seed_, index, kRoll));
  bundle.jitter_px = {random_number(seed_, index, kJitterX), random_number(seed_, index, kJitterY)};
  return bundle;
}

glm::dvec2 DirectionSet::point(std::int64_t index) {
  const auto size = static_cast<double>(set_size_);
  switch (kind_) {
    case DirectionKind::halton:
      return halton_point(index);
    case DirectionKind::halton_permuted:
      return halton_point(shuffled(index));
    case DirectionKind::hammersley: {
      const std::int64_t i = index % set_size_;
      return {(static_cast<double>(i) + 0.5) / size,
              many_lights::radical_inverse(static_cast<std::uint64_t>(i), 2)};
    }
    case DirectionKind::fibonacci: {
      // Gonzalez 2010, "Measurement of Areas on a Sphere Using Fibonacci and Latitude-Longitude
      // Lattices", doi:10.1007/s11004-009-9257-x.
      const std::int64_t i = shuffled(index) % set_size_;
      return {(static_cast<double>(i) + 0.5) / size,
              fraction(static_cast<double>(i) * (std::numbers::phi - 1.0))};
    }
    case DirectionKind::iid:
      break;
  }
  return {random_number(seed_, index, kFirst), random_number(seed_, index, kSecond)};
}

std::int64_t DirectionSet::shuffled(std::int64_t index) {
  const auto size = static_cast<std::int64_t>(block_.size());
  if (index >= block_begin_ && index < block_begin_ + size) {
    return block_[static_cast<std::size_t>(index - block_begin_)];
  }
  std::int64_t begin = 0;
  std::int64_t end = 0;
  if (kind_ == DirectionKind::fibonacci) {
    begin = index / set_size_ * set_size_;
    end = begin + set_size_;
  } else {
    begin = index < kMostBlock
                ? static_cast<std::int64_t>(std::bit_floor(static_cast<std::uint64_t>(index)))
                : index / kMostBlock * kMostBlock;
    end = std::min(planned_,
                   index < kMostBlock ? std::max<std::int64_t>(1, 2 * begin) : begin + kMostBlock);
    end = std::max(end, index + 1);
  }
  block_begin_ = begin;
  block_.resize(static_cast<std::size_t>(end - begin));
  std::iota(block_.begin(), block_.end(), begin);
  // Fisher and Yates, as in Knuth, TAOCP 2, Algorithm 3.4.2 P.
  for (std::size_t last = block_.size(); last > 1; --last) {
    const double u = random_number(seed_, begin + static_cast<std::int64_t>(last), kShuffle);
    std::swap(block_[last - 1], block_[static_cast<std::size_t>(u * static_cast<double>(last))]);
  }
  return block_[static_cast<std::size_t>(index - begin)];
}

glm::vec3 direction_on_sphere(const glm::dvec2& point) {
  const double z = 1.0 - 2.0 * point.x;
  const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double azimuth_rad = 2.0 * std::numbers::pi * point.y;
  return glm::vec3(radius * std::cos(azimuth_rad), radius * std::sin(azimuth_rad), z);
}

}  // namespace renderers::ray_bundles
