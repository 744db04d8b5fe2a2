#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/element_hierarchy/link_set.h"
#include "renderers/element_hierarchy/lit_sides.h"

namespace renderers::element_hierarchy {

/// The rays of whole sides, and which link of the sides and of the clusters around them carries the
/// light that a ray meets. The links of a patch and of its ancestors have every source once, so
/// there is one link at most; none where parts of the side have their own.
class FollowedLinks {
 public:
  /// @param tree   must live as long as this
  /// @param sides  that the tree was made of, with what they see
  FollowedLinks(const ElementTree& tree, const LitSides& sides);

  std::size_t rays_per_side() const { return rays_; }
  /// A side and the clusters around it, from the tree's root on. @param elements  receives
  void find_ancestors(std::size_t root_order, std::vector<std::uint32_t>& elements) const;
  /// Order of the root that a ray meets, or kNoElement. @param root_order  of the side it leaves
  std::uint32_t met(std::size_t root_order, std::size_t ray) const {
    return seen_[root_order * rays_ + ray].order;
  }

  /// Finds the link of the sides' first rays anew, and the share of its receiver's rays, by area,
  /// that follow a link: form factor times visibility. @param rays  per side, [1, rays_per_side]
  void find(const LinkSet& links, std::size_t rays);
  /// Of the last `find`: per side.
  std::size_t followed_rays() const { return followed_; }

  /// Of the last `find`: leaf that a ray of a side meets along a link, or kNoElement.
  /// @param ray  < followed_rays()
  std::uint32_t leaf(std::size_t root_order, std::size_t ray) const {
    return leaves_[root_order * rays_ + ray];
  }
  /// The same of the places on area lights that it sees: leaf, or kNoElement, and the irradiance by
  /// its radiosity.
  struct Lamp {
    std::uint32_t leaf = kNoElement;
    float weight = 0.0F;
    std::uint16_t depth = 0;  ///< where its link was found last
  };
  std::span<const Lamp> lamps(std::size_t root_order) const {
    return std::span(lamps_).subspan(first_lamp_[root_order],
                                     first_lamp_[root_order + 1] - first_lamp_[root_order]);
  }
  /// Of the last `find`: share in [0, 1] of the receiver's rays that follow a link.
  double share(std::size_t link) const;
  std::uint32_t rays(std::size_t link) const { return counts_[link].rays.load(); }

  std::int64_t memory_bytes() const;

 private:
  /// Whole numbers: sums do not depend on their order.
  struct Count {
    std::atomic<std::uint64_t> share{0};  ///< in units of 2^-52
    std::atomic<std::uint32_t> rays{0};
  };
  struct Seen {
    std::uint32_t order = kNoElement;  ///< of the root that is met
    glm::u16vec2 place{0};             ///< on it, as in `SeenSide`
  };
  class SourceRanges;
  class Counter;
  /// Where a ray's link was found last, and what it carries.
  struct Found {
    std::uint32_t link;
    std::uint32_t leaf;  ///< kNoElement if there is no link
    std::size_t depth;
  };
  Found find_of_ray(const Seen& seen, std::size_t depth,
                    const std::vector<std::uint32_t>& ancestors, const SourceRanges& sources) const;
  void find_of_side(std::size_t root_order, const std::vector<std::uint32_t>& ancestors,
                    const SourceRanges& sources, Counter& counter);

  const ElementTree* tree_;
  std::vector<std::uint32_t> parents_;     ///< per element of the clusters' tree
  std::size_t rays_ = 0;                   ///< per side
  std::size_t followed_ = 0;               ///< of them
  std::vector<Seen> seen_;                 ///< [root][ray]
  std::vector<std::uint32_t> leaves_;      ///< [root][ray]
  std::vector<std::uint16_t> depths_;      ///< [root][ray]: where its link was found last
  std::vector<std::uint32_t> first_lamp_;  ///< per root, size + 1, into the next two
  std::vector<Seen> seen_lamps_;
  std::vector<Lamp> lamps_;
  std::vector<std::uint8_t> is_cut_;  ///< per root: it has parts
  std::vector<Count> counts_;         ///< per link
};

}  // namespace renderers::element_hierarchy
