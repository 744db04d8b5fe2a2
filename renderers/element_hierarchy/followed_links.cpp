#include "renderers/element_hierarchy/followed_links.h"

#include <algorithm>
#include <array>

#include "perception/base/parallel.h"

namespace renderers::element_hierarchy {

namespace {

constexpr std::size_t kGrain = 256;
constexpr std::uint32_t kNoLink = kNoElement;
constexpr double kShareUnit = 0x1p-52;

}  // namespace

/// Per cluster and whole side the sides that its links bring light from, in the order of the roots;
/// they are disjoint, but for parts of one side.
class FollowedLinks::SourceRanges {
 public:
  /// @param receivers  elements of the clusters' tree
  SourceRanges(const ElementTree& tree, std::size_t receivers, const LinkSet& links)
      : tree_(&tree) {
    first_.reserve(receivers + 1);
    first_.push_back(0);
    for (std::uint32_t i = 0; i < receivers; ++i) {
      for (const Link& link : links.of(i)) {
        const Element& source = tree.at(link.source);
        const auto index = static_cast<std::uint32_t>(&link - links.all().data());
        const bool is_part = source.is_patch && !tree.is_root(link.source);
        ranges_.push_back({source.root_begin, source.root_end, index, link.source, is_part});
      }
      std::ranges::sort(std::span(ranges_).subspan(first_.back()), {}, &Range::begin);
      first_.push_back(static_cast<std::uint32_t>(ranges_.size()));
    }
  }

  /// @param root_order, leaf  what a ray meets  @return index of the link, or kNoLink
  std::uint32_t find(std::uint32_t receiver, std::uint32_t root_order, std::uint32_t leaf) const {
    const auto own =
        std::span(ranges_).subspan(first_[receiver], first_[receiver + 1] - first_[receiver]);
    auto after = std::ranges::upper_bound(own, root_order, {}, &Range::begin);
    while (after != own.begin() && root_order < std::prev(after)->end) {
      --after;
      if (!after->is_part || tree_->is_below(leaf, after->source)) return after->link;
    }
    return kNoLink;
  }

 private:
  /// Whole sides of a source: [begin, end) in the order of the roots.
  struct Range {
    std::uint32_t begin;
    std::uint32_t end;
    std::uint32_t link;  ///< index into all links
    std::uint32_t source;
    bool is_part;  ///< of a side
  };
  const ElementTree* tree_;
  std::vector<Range> ranges_;
  std::vector<std::uint32_t> first_;  ///< per element, size + 1
};

/// Adds rays to counts that all threads share, as few times as may be: neighbouring sides follow
/// the same links.
class FollowedLinks::Counter {
 public:
  explicit Counter(std::vector<Count>& counts) : counts_(counts) {}
  ~Counter() {
    for (const Slot& slot : slots_) flush(slot);
  }
  Counter(const Counter&) = delete;
  Counter& operator=(const Counter&) = delete;

  void add(std::uint32_t link, std::uint64_t share) {
    Slot& slot = slots_[link % kSlots];
    if (slot.link != link) {
      flush(slot);
      slot = {link, 0, 0};
    }
    slot.share += share;
    ++slot.rays;
  }

 private:
  static constexpr std::size_t kSlots = 64;
  struct Slot {
    std::uint32_t link = kNoLink;
    std::uint32_t rays = 0;
    std::uint64_t share = 0;
  };
  void flush(const Slot& slot) {
    if (slot.rays == 0) return;
    counts_[slot.link].share.fetch_add(slot.share, std::memory_order_relaxed);
    counts_[slot.link].rays.fetch_add(slot.rays, std::memory_order_relaxed);
  }

  std::vector<Count>& counts_;
  std::array<Slot, kSlots> slots_{};
};

FollowedLinks::FollowedLinks(const ElementTree& tree, const LitSides& sides)
    : tree_(&tree), rays_(sides.rays_per_side) {
  for (const Element& element : tree.elements()) parents_.push_back(element.parent);
  const std::span<const std::uint32_t> roots = tree.roots();
  std::vector<std::uint32_t> order_of(sides.is_lit.size(), kNoElement);
  for (std::uint32_t i = 0; i < roots.size(); ++i) order_of[tree.side_of(roots[i])] = i;
  const auto seen_of = [&](const SeenSide& met) {
    return met.side == kNoSide ? Seen{} : Seen{order_of[met.side], met.place};
  };
  seen_.reserve(roots.size() * rays_);
  first_lamp_.push_back(0);
  for (const std::uint32_t root : roots) {
    const std::size_t side = tree.side_of(root);
    for (std::size_t ray = 0; ray < rays_; ++ray) {
      seen_.push_back(seen_of(sides.seen[side * rays_ + ray]));
    }
    for (const SeenLamp& lamp : sides.lamps[side]) {
      seen_lamps_.push_back(seen_of(lamp.met));
      lamps_.push_back({kNoElement, lamp.weight, 0});
    }
    first_lamp_.push_back(static_cast<std::uint32_t>(lamps_.size()));
  }
  leaves_.resize(seen_.size(), kNoElement);
  depths_.resize(seen_.size(), 0);
}

void FollowedLinks::find_ancestors(std::size_t root_order,
                                   std::vector<std::uint32_t>& elements) const {
  elements.clear();
  for (std::uint32_t a = tree_->roots()[root_order]; a != kNoElement; a = parents_[a]) {
    elements.push_back(a);
  }
  std::ranges::reverse(elements);
}

void FollowedLinks::find(const LinkSet& links, std::size_t rays) {
  followed_ = rays;
  const SourceRanges sources(*tree_, parents_.size(), links);
  counts_ = std::vector<Count>(links.size());
  is_cut_.clear();
  for (const std::uint32_t root : tree_->roots())
    is_cut_.push_back(tree_->at(root).is_leaf() ? 0 : 1);
  base::parallel_for(tree_->roots().size(), kGrain, [&](std::size_t begin, std::size_t end) {
    Counter counter(counts_);
    std::vector<std::uint32_t> ancestors;
    for (std::size_t i = begin; i < end; ++i) {
      find_ancestors(i, ancestors);
      find_of_side(i, ancestors, sources, counter);
    }
  });
}

FollowedLinks::Found FollowedLinks::find_of_ray(const Seen& seen, std::size_t depth,
                                                const std::vector<std::uint32_t>& ancestors,
                                                const SourceRanges& sources) const {
  if (seen.order == kNoElement) return {kNoLink, kNoElement, depth};
  const std::uint32_t root = tree_->roots()[seen.order];
  const std::uint32_t leaf =
      is_cut_[seen.order] != 0 ? tree_->leaf_below(root, glm::vec2(seen.place) / 65535.0F) : root;
  // Most links stay, and those refined move to a receiver's children: looked for from where it was
  // on.
  for (std::size_t step = 0; step < ancestors.size(); ++step) {
    const std::size_t at = (depth + step) % ancestors.size();
    const std::uint32_t link = sources.find(ancestors[at], seen.order, leaf);
    if (link != kNoLink) return {link, leaf, at};
  }
  return {kNoLink, kNoElement, depth};
}

void FollowedLinks::find_of_side(std::size_t root_order,
                                 const std::vector<std::uint32_t>& ancestors,
                                 const SourceRanges& sources, Counter& counter) {
  const auto area_m2 = static_cast<double>(tree_->at(tree_->roots()[root_order]).area_m2);
  const std::size_t first = root_order * rays_;
  for (std::size_t index = first; index < first + followed_; ++index) {
    const Found found = find_of_ray(seen_[index], depths_[index], ancestors, sources);
    leaves_[index] = found.leaf;
    depths_[index] = static_cast<std::uint16_t>(found.depth);
    if (found.link == kNoLink) continue;
    const auto receiver_m2 = static_cast<double>(tree_->at(ancestors[found.depth]).area_m2);
    const double share = area_m2 / (receiver_m2 * static_cast<double>(followed_));
    counter.add(found.link, static_cast<std::uint64_t>(share / kShareUnit + 0.5));
  }
  for (std::size_t i = first_lamp_[root_order]; i < first_lamp_[root_order + 1]; ++i) {
    const Found found = find_of_ray(seen_lamps_[i], lamps_[i].depth, ancestors, sources);
    lamps_[i].leaf = found.leaf;
    lamps_[i].depth = static_cast<std::uint16_t>(found.depth);
  }
}

double FollowedLinks::share(std::size_t link) const {
  return kShareUnit * static_cast<double>(counts_[link].share.load());
}

std::int64_t FollowedLinks::memory_bytes() const {
  return static_cast<std::int64_t>(
      is_cut_.capacity() + parents_.capacity() * sizeof(std::uint32_t) +
      seen_.capacity() * sizeof(Seen) + seen_lamps_.capacity() * sizeof(Seen) +
      lamps_.capacity() * sizeof(Lamp) + first_lamp_.capacity() * sizeof(std::uint32_t) +
      leaves_.capacity() * sizeof(std::uint32_t) + depths_.capacity() * sizeof(std::uint16_t) +
      counts_.capacity() * sizeof(Count));
}

}  // namespace renderers::element_hierarchy
