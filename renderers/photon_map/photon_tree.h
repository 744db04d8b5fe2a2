#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "renderers/photon_map/photon.h"

namespace renderers::photon_map {

/// A photon near a point.
struct NearPhoton {
  float distance2_m2 = 0.0F;
  std::uint32_t index = 0;
};

/// Which photons near a point count.
enum class Neighbours {
  arriving,     ///< that came to the side that is looked at
  same_surface  ///< that lie on a surface of nearly the same attitude, nearly in its plane
};

/// What is asked of a tree.
struct PhotonQuery {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0.0F};  ///< geometric, unit length, on the side that is looked at
  int count = 1;           ///< >= 1
  float most_radius_m = 0.0F;
  Neighbours neighbours = Neighbours::same_surface;
};

/// Balanced kd-tree over photons: each range's median, by the longest side of its box, is its node.
///
/// Sources: Bentley 1975, "Multidimensional Binary Search Trees Used for Associative Searching",
/// doi:10.1145/361002.361007; Jensen 1996, Sec. 2.2 (photons in a balanced kd-tree).
class PhotonTree {
 public:
  /// Photons have 32-bit numbers, and there is one past the last.
  static constexpr std::uint64_t kMostPhotons = std::numeric_limits<std::uint32_t>::max();
  /// @param photons  at most kMostPhotons
  explicit PhotonTree(std::vector<Photon> photons);

  std::size_t size() const { return photons_.size(); }
  const Photon& at(std::size_t index) const { return photons_[index]; }
  const std::vector<Photon>& photons() const { return photons_; }
  std::int64_t memory_bytes() const;

  /// The nearest photons that count, in no order, at most `query.count` and within the radius.
  /// @param found  is cleared first
  void nearest(const PhotonQuery& query, std::vector<NearPhoton>& found) const;

 private:
  struct Range {
    std::uint32_t begin;
    std::uint32_t end;
  };
  void split(const Range& range);
  void search(const Range& range, const PhotonQuery& query, float& radius2_m2,
              std::vector<NearPhoton>& heap) const;

  std::vector<Photon> photons_;
  std::vector<std::uint8_t> axes_;  ///< per photon as a node
};

}  // namespace renderers::photon_map
