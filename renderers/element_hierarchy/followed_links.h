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

/// The rays of whole sides, and which link of the clusters around a side carries the light that a
/// ray meets. The links of a patch and of its ancestors have every source once, so there is one
/// link at most.
class FollowedLinks {
 public:
  static constexpr std::uint32_t kNoLink = kNoElement;

  /// @param tree   must live as long as this
  /// @param sides  that the tree was made of, with what they see
  FollowedLinks(const ElementTree& tree, const LitSides& sides);

  std::size_t rays_per_side() const { return rays_; }
  /// Of an element of the clusters' tree; kNoElement: none.
  std::uint32_t parent(std::uint32_t element) const { return parents_[element]; }
  /// Clusters around a side, from the tree's root on. @param clusters  receives
  void find_ancestors(std::size_t root_order, std::vector<std::uint32_t>& clusters) const;
  /// Order of the root that a ray meets, or kNoElement. @param root_order  of the side it leaves
  std::uint32_t met(std::size_t root_order, std::size_t ray) const {
    return seen_[root_order * rays_ + ray];
  }

  /// Finds the link of every ray anew, and the share of its receiver's rays, by area, that follow a
  /// link: form factor times visibility.
  void find(const LinkSet& links);

  /// Of the last `find`: index of the link that a ray follows, or kNoLink.
  std::uint32_t link(std::size_t root_order, std::size_t ray) const {
    return followed_[root_order * rays_ + ray];
  }
  /// Of the last `find`: number of clusters above the receiver of that link.
  std::size_t depth(std::size_t root_order, std::size_t ray) const {
    return depth_[root_order * rays_ + ray];
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
  class SourceRanges;
  class Counter;
  void find_of_side(std::size_t root_order, const std::vector<std::uint32_t>& ancestors,
                    const SourceRanges& sources, Counter& counter);

  const ElementTree* tree_;
  std::vector<std::uint32_t> parents_;  ///< per element of the clusters' tree
  std::size_t rays_ = 0;             ///< per side
  std::vector<std::uint32_t> seen_;  ///< [root][ray]: order of the root that is met, or kNoElement
  std::vector<std::uint32_t> followed_;  ///< [root][ray]: link
  std::vector<std::uint16_t> depth_;     ///< [root][ray]: where its link was found last
  std::vector<Count> counts_;            ///< per link
};

}  // namespace renderers::element_hierarchy
