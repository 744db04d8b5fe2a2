#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "renderers/element_hierarchy/link.h"

namespace renderers::element_hierarchy {

/// The links of all elements, those of one receiver side by side.
class LinkSet {
 public:
  /// A link on its way into the set.
  struct New {
    std::uint32_t receiver;
    Link link;
  };

  std::span<const Link> of(std::uint32_t receiver) const {
    if (receiver + 1 >= first_.size()) return {};
    return std::span(links_).subspan(first_[receiver], first_[receiver + 1] - first_[receiver]);
  }
  std::span<Link> of(std::uint32_t receiver) {
    if (receiver + 1 >= first_.size()) return {};
    return std::span(links_).subspan(first_[receiver], first_[receiver + 1] - first_[receiver]);
  }
  const std::vector<Link>& all() const { return links_; }
  /// Receiver of a link by its index in `all`.
  std::uint32_t receiver_of(std::size_t index) const;
  std::size_t size() const { return links_.size(); }

  /// Takes links out and others in; the order within a receiver is that before, new ones last.
  /// @param leaving   true: out, one per link of `all`
  /// @param elements  number of receivers from now on
  void replace(const std::vector<bool>& leaving, std::span<const New> entering,
               std::size_t elements);

  /// Bytes of the links and of their spans.
  std::int64_t memory_bytes() const {
    return static_cast<std::int64_t>(links_.size() * sizeof(Link) +
                                     first_.size() * sizeof(std::uint32_t));
  }

 private:
  std::vector<Link> links_;
  std::vector<std::uint32_t> first_;  ///< per receiver, size + 1
};

}  // namespace renderers::element_hierarchy
