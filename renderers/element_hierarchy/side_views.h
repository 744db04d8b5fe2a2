#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/element_hierarchy/followed_links.h"
#include "renderers/element_hierarchy/link_set.h"
#include "renderers/element_hierarchy/lit_sides.h"

namespace renderers::element_hierarchy {

/// What a cluster sends by direction: radiosities weighted by the areas that look along each axis.
///
/// A mean over all that is in a cluster halves a lamp whose back is dark wherever its front is
/// seen. Source: Sillion, Drettakis, Soler 1995, "A Clustering Algorithm for Radiance Calculation
/// in General Environments", EGWR (clusters send by direction; recalled); six axes in place of
/// spherical harmonics are ours.
class DirectedRadiosity {
 public:
  /// @param normal  unit length
  void add(const glm::vec3& normal, float area_m2, const glm::vec3& radiosity) {
    for (int axis = 0; axis < 3; ++axis) {
      Lobe& lobe = lobes_[static_cast<std::size_t>(2 * axis + (normal[axis] < 0.0F ? 1 : 0))];
      const float weight = area_m2 * std::abs(normal[axis]);
      lobe.area_m2 += weight;
      lobe.power_w += weight * radiosity;
    }
  }
  void add(const DirectedRadiosity& other) {
    for (std::size_t i = 0; i < lobes_.size(); ++i) {
      lobes_[i].area_m2 += other.lobes_[i].area_m2;
      lobes_[i].power_w += other.lobes_[i].power_w;
    }
  }
  /// W/m2. @param direction  any length, away from the cluster  @param otherwise  where nothing
  ///   looks that way
  glm::vec3 at(const glm::vec3& direction, const glm::vec3& otherwise) const {
    float area_m2 = 0.0F;
    glm::vec3 power_w(0.0F);
    for (int axis = 0; axis < 3; ++axis) {
      const Lobe& lobe =
          lobes_[static_cast<std::size_t>(2 * axis + (direction[axis] < 0.0F ? 1 : 0))];
      area_m2 += std::abs(direction[axis]) * lobe.area_m2;
      power_w += std::abs(direction[axis]) * lobe.power_w;
    }
    return area_m2 > 0.0F ? power_w / area_m2 : otherwise;
  }

 private:
  struct Lobe {
    glm::vec3 power_w{0.0F};
    float area_m2 = 0.0F;
  };
  std::array<Lobe, 6> lobes_{};  ///< +x, -x, +y, -y, +z, -z
};

/// What the whole sides of a scene's surfaces see, by rays of their own: cosine-distributed ones
/// and some towards the area lights.
///
/// A link to a cluster tells how much light arrives, the mean over all that is in it, of a source's
/// mean. Spread evenly most of it is lost on hidden surfaces and on those that look away, and what
/// a receiver sees of the source need not be its mean. Here the links of clusters and of whole
/// sides say which light is to be brought, and each side gets of it what its own rays meet:
/// reflected light by the cosine-distributed rays, emitted light by those towards the lamps, which
/// small lamps would be missed without. Links of parts of sides bring their light themselves. A
/// cluster sends the radiosity of its sides weighted by how much of what they see is outside of it,
/// so that dark insides do not dim what is sent.
///
/// Source: Sillion and Drettakis 1995, "Feature-Based Control of Visibility Error: A
/// Multi-Resolution Clustering Algorithm for Global Illumination", Sec. 6.1 (the light of a cluster
/// counts what is visible of its contents). Differs: they draw an item buffer of the cluster per
/// direction; rays from its contents, made once, stand for all directions; ours.
class SideViews {
 public:
  /// @param tree   must live as long as this
  /// @param sides  that the tree was made of, with what they see
  SideViews(const ElementTree& tree, const LitSides& sides);

  /// Finds anew which rays follow the links of clusters and whole sides, and what these let
  /// through: the share of their receiver's rays that follow a link, if 32 or more do.
  /// @param most_rays  per side: fewer say less of each side, but as much of clusters of many
  void follow(LinkSet& links, std::size_t most_rays = std::numeric_limits<std::size_t>::max());

  std::size_t rays_per_side() const { return followed_.rays_per_side(); }

  /// Irradiance of whole sides, W/m2: of what their rays meet along links.
  /// @param radiosity  W/m2, per element  @param received  per element; receives those of the sides
  void gather(const std::vector<glm::vec3>& radiosity, std::vector<glm::vec3>& received) const;

  /// What elements send to others, W/m2.
  struct Sent {
    std::vector<glm::vec3> out;               ///< per element; of patches their radiosity
    std::vector<DirectedRadiosity> directed;  ///< `out` of clusters; empty: the same every way
    std::span<const std::uint32_t> place_of;  ///< per element that the views know, into `directed`

    /// `out` as it is seen from a direction. @param direction  away from the element
    glm::vec3 towards(std::uint32_t element, const glm::vec3& direction) const;
  };
  /// Of clusters that are a link's source in the last `follow`; the others send their means.
  /// @param radiosity  W/m2, per element  @param sent  receives
  void send(const std::vector<glm::vec3>& radiosity, Sent& sent) const;

  /// Elements from here on are parts of sides.
  std::size_t first_part() const { return first_.size(); }
  std::int64_t memory_bytes() const;

 private:
  /// A part of the sides of a cluster that sends, small enough to be one thread's.
  struct Piece {
    std::uint32_t cluster;
    std::uint32_t begin;  ///< in the order of the roots
    std::uint32_t end;
  };
  /// What the sides of a piece send.
  struct Sum;
  /// Place of a cluster's side in the list below.
  std::size_t place(std::uint32_t cluster, std::size_t root_order) const {
    return static_cast<std::size_t>(first_[cluster] + static_cast<std::int64_t>(root_order));
  }
  void count_escapes();
  void correct_links(LinkSet& links) const;
  void sum_lamps();
  void find_senders(const LinkSet& links);
  Sum sum_of(const Piece& piece, const std::vector<glm::vec3>& of_roots) const;

  const ElementTree* tree_;
  FollowedLinks followed_;
  /// Per element of the clusters' tree: where the order 0 of the roots would lie in the list below.
  std::vector<std::int64_t> first_;
  /// Per cluster and side in it, side by side for a cluster: the side's area times the share of its
  /// rays that meet sides out of the cluster.
  std::vector<float> outside_m2_;
  std::vector<glm::vec3> normals_;       ///< per root
  std::vector<std::uint32_t> emissive_;  ///< elements that send light of their own
  std::vector<glm::vec3> lamps_w_m2_;    ///< per root: irradiance that the rays towards lamps bring
  std::vector<Piece> pieces_;            ///< of clusters that are a link's source, in their order
  std::vector<std::uint32_t> place_of_;  ///< per element: among those clusters, or kNoElement
  std::size_t senders_ = 0;
};

}  // namespace renderers::element_hierarchy
