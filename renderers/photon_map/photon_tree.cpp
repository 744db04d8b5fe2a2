#include "renderers/photon_map/photon_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "perception/base/parallel.h"

namespace renderers::photon_map {

namespace {

/// Least cosine between the normals of surfaces that count as the same; ours.
constexpr float kSameAttitude = 0.9F;
/// Greatest height above the plane over the distance; ours.
constexpr float kNearPlane = 0.35F;

bool is_nearer(const NearPhoton& a, const NearPhoton& b) {
  return a.distance2_m2 < b.distance2_m2 || (a.distance2_m2 == b.distance2_m2 && a.index < b.index);
}

bool counts(const PhotonQuery& query, const Photon& photon, float distance2_m2) {
  if (glm::dot(photon.direction, query.normal) >= 0.0F) return false;
  if (query.neighbours == Neighbours::arriving) return true;
  if (glm::dot(photon.normal, query.normal) < kSameAttitude) return false;
  const float height_m = glm::dot(photon.position - query.position, query.normal);
  // Points of one plane that nearly coincide differ by rounding alone.
  const float rounding_m = 1e-5F * (std::fabs(query.position.x) + std::fabs(query.position.y) +
                                    std::fabs(query.position.z));
  return std::fabs(height_m) <= kNearPlane * std::sqrt(distance2_m2) + rounding_m;
}

}  // namespace

PhotonTree::PhotonTree(std::vector<Photon> photons)
    : photons_(std::move(photons)), axes_(photons_.size()) {
  assert(photons_.size() <= kMostPhotons);
  std::vector<Range> ranges{{0, static_cast<std::uint32_t>(photons_.size())}};
  // Level by level: the ranges of a level are disjoint.
  while (!ranges.empty()) {
    base::parallel_for(ranges.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) split(ranges[i]);
    });
    std::vector<Range> below;
    for (const Range& range : ranges) {
      const std::uint32_t middle = range.begin + (range.end - range.begin) / 2;
      if (middle > range.begin) below.push_back({range.begin, middle});
      if (middle + 1 < range.end) below.push_back({middle + 1, range.end});
    }
    ranges = std::move(below);
  }
}

std::int64_t PhotonTree::memory_bytes() const {
  return static_cast<std::int64_t>(photons_.size() * (sizeof(Photon) + 1));
}

void PhotonTree::split(const Range& range) {
  if (range.end - range.begin < 2) return;
  const auto first = photons_.begin() + range.begin;
  const auto last = photons_.begin() + range.end;
  glm::vec3 least = first->position;
  glm::vec3 greatest = least;
  for (auto photon = first; photon != last; ++photon) {
    least = glm::min(least, photon->position);
    greatest = glm::max(greatest, photon->position);
  }
  const glm::vec3 size = greatest - least;
  int axis = size.y > size.x ? 1 : 0;
  if (size.z > size[axis]) axis = 2;
  const std::uint32_t middle = range.begin + (range.end - range.begin) / 2;
  std::nth_element(
      first, photons_.begin() + middle, last,
      [axis](const Photon& a, const Photon& b) { return a.position[axis] < b.position[axis]; });
  axes_[middle] = static_cast<std::uint8_t>(axis);
}

void PhotonTree::nearest(const PhotonQuery& query, std::vector<NearPhoton>& found) const {
  found.clear();
  if (photons_.empty()) return;
  float radius2_m2 = query.most_radius_m * query.most_radius_m;
  search({0, static_cast<std::uint32_t>(photons_.size())}, query, radius2_m2, found);
}

void PhotonTree::search(const Range& range, const PhotonQuery& query, float& radius2_m2,
                        std::vector<NearPhoton>& heap) const {
  const std::uint32_t middle = range.begin + (range.end - range.begin) / 2;
  const Photon& photon = photons_[middle];
  const int axis = axes_[middle];
  const float across_m = query.position[axis] - photon.position[axis];
  const Range low{range.begin, middle};
  const Range high{middle + 1, range.end};
  const Range& near = across_m < 0.0F ? low : high;
  const Range& far = across_m < 0.0F ? high : low;
  if (near.begin < near.end) search(near, query, radius2_m2, heap);

  const glm::vec3 to_photon = photon.position - query.position;
  const NearPhoton candidate{glm::dot(to_photon, to_photon), middle};
  if (candidate.distance2_m2 < radius2_m2 && counts(query, photon, candidate.distance2_m2)) {
    heap.push_back(candidate);
    std::ranges::push_heap(heap, is_nearer);
    if (heap.size() > static_cast<std::size_t>(query.count)) {
      std::ranges::pop_heap(heap, is_nearer);
      heap.pop_back();
    }
    if (heap.size() == static_cast<std::size_t>(query.count)) {
      radius2_m2 = std::min(radius2_m2, heap.front().distance2_m2);
    }
  }
  if (far.begin < far.end && across_m * across_m < radius2_m2) {
    search(far, query, radius2_m2, heap);
  }
}

}  // namespace renderers::photon_map
