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

/// What the whole sides of a scene's triangles see, by rays: which of the surfaces in a cluster
/// light from outside can reach, and which of them send theirs out.
///
/// A link to a cluster tells how much light arrives, the mean over all that is in it. Spread evenly
/// most of it is lost on hidden surfaces and on those that look away. Here a side gets the share
/// that its own rays see of what the cluster's links bring, weighted by radiosity; and a cluster
/// sends the radiosity of its sides weighted by how much of what they see is outside of it, so that
/// dark insides do not dim what is sent. Neither changes the power: sum A_i H_i = A H, and the
/// power that leaves a cluster is that of the rays that leave it.
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

  /// Finds anew how the links of each cluster share out over its sides, and what they let through:
  /// the share of the rays of its sides that follow a link, if 32 or more do.
  /// @param radiosity  W/m2, per element
  void share_out(LinkSet& links, const std::vector<glm::vec3>& radiosity);

  /// Irradiance of patches from that of links, W/m2: a patch's own, its side's share of all
  /// clusters around it, and its parent patches'. Of clusters: own and ancestors', means.
  /// @param gathered  W/m2, per element, what its own links bring  @param irradiance  receives
  void push(const std::vector<glm::vec3>& gathered, std::vector<glm::vec3>& irradiance) const;

  /// What elements send to others and to themselves, W/m2.
  struct Sent {
    std::vector<glm::vec3> out;               ///< per element; of patches their radiosity
    std::vector<glm::vec3> inside;            ///< per element; of clusters to their own contents
    std::vector<DirectedRadiosity> directed;  ///< `out` of clusters; empty: the same every way
    std::span<const std::uint32_t> place_of;  ///< per element that the views know, into `directed`

    /// `out` as it is seen from a direction. @param direction  away from the element
    glm::vec3 towards(std::uint32_t element, const glm::vec3& direction) const;
  };
  /// Of clusters that are a link's source in the last `share_out`; the others send their means.
  /// @param radiosity  W/m2, per element  @param sent  receives
  void send(const std::vector<glm::vec3>& radiosity, Sent& sent) const;

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
  /// Place of a cluster and of one of its sides in the lists below.
  std::size_t place(std::uint32_t cluster, std::size_t root_order) const {
    return static_cast<std::size_t>(first_[cluster] + static_cast<std::int64_t>(root_order));
  }
  static constexpr std::int64_t kSide = std::numeric_limits<std::int64_t>::min();
  /// @param element  of the clusters' tree
  bool is_side(std::uint32_t element) const { return first_[element] == kSide; }
  void count_escapes();
  void correct_links(LinkSet& links) const;
  void sum_shares(const LinkSet& links, const std::vector<glm::vec3>& radiosity);
  void divide_shares();
  void find_senders(const LinkSet& links);
  Sum sum_of(const Piece& piece, const std::vector<glm::vec3>& of_roots) const;

  const ElementTree* tree_;
  FollowedLinks followed_;
  /// Per element of the clusters' tree: where the order 0 of the roots would lie in the lists
  /// below; kSide: no cluster.
  std::vector<std::int64_t> first_;
  std::vector<glm::vec3> normals_;  ///< per root
  /// Per cluster and side in it, side by side for a cluster:
  std::vector<float> outside_m2_;  ///< area times the share of its rays that meet others' sides
  std::vector<float> inside_m2_;   ///< area times the share that meet sides of the cluster
  std::vector<float> share_;       ///< of the cluster's mean irradiance; 1: all of it
  std::vector<Piece> pieces_;      ///< of clusters that are a link's source, in their order
  std::vector<std::uint32_t>
      place_of_;  ///< per element, number among those clusters, or kNoElement
  std::size_t senders_ = 0;
};

}  // namespace renderers::element_hierarchy
