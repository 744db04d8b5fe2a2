#include "renderers/element_hierarchy/followed_links.h"

#include <algorithm>
#include <array>

#include "perception/base/parallel.h"

namespace renderers::element_hierarchy {

namespace {

constexpr std::size_t kGrain = 256;
constexpr double kShareUnit = 0x1p-52;

}  // namespace

/// Per cluster the whole sides that its links bring light from, in the order of the roots; they are
/// disjoint, but for parts of one side.
class FollowedLinks::SourceRanges {
 public:
  SourceRanges(const ElementTree& tree, const LinkSet& links) {
    const auto count = static_cast<std::uint32_t>(tree.elements().size());
    first_.reserve(count + 1);
    first_.push_back(0);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::span<const Link> of_receiver = links.of(i);
      if (!of_receiver.empty() && !tree.at(i).is_patch) {
        for (const Link& link : of_receiver) {
          const Element& source = tree.at(link.source);
          const auto index = static_cast<std::uint32_t>(&link - links.all().data());
          ranges_.push_back({source.root_begin, source.root_end, index});
        }
        std::ranges::sort(std::span(ranges_).subspan(first_.back()), {}, &Range::begin);
      }
      first_.push_back(static_cast<std::uint32_t>(ranges_.size()));
    }
  }

  /// @return index of the link, or kNoLink
  std::uint32_t find(std::uint32_t receiver, std::uint32_t root_order) const {
    const auto own =
        std::span(ranges_).subspan(first_[receiver], first_[receiver + 1] - first_[receiver]);
    const auto after = std::ranges::upper_bound(own, root_order, {}, &Range::begin);
    if (after == own.begin() || root_order >= std::prev(after)->end) return kNoLink;
    return std::prev(after)->link;
  }

 private:
  /// Whole sides of a source: [begin, end) in the order of the roots.
  struct Range {
    std::uint32_t begin;
    std::uint32_t end;
    std::uint32_t link;  ///< index into all links
  };
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
  const auto side_of = [&](std::uint32_t root) {
    const Element& patch = tree.at(root);
    return 2 * (sides.first[patch.object] + patch.triangle) + (patch.is_back ? 1 : 0);
  };
  std::vector<std::uint32_t> order_of(sides.is_lit.size(), kNoElement);
  for (std::uint32_t i = 0; i < roots.size(); ++i) order_of[side_of(roots[i])] = i;
  seen_.resize(roots.size() * rays_);
  base::parallel_for(roots.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t side = side_of(roots[i]);
      for (std::size_t ray = 0; ray < rays_; ++ray) {
        const std::uint32_t met = sides.seen[side * rays_ + ray];
        seen_[i * rays_ + ray] = met == kNoSide ? kNoElement : order_of[met];
      }
    }
  });
  followed_.resize(seen_.size(), kNoLink);
  depth_.resize(seen_.size(), 0);
}

void FollowedLinks::find_ancestors(std::size_t root_order,
                                   std::vector<std::uint32_t>& clusters) const {
  clusters.clear();
  for (std::uint32_t a = parents_[tree_->roots()[root_order]]; a != kNoElement; a = parents_[a]) {
    clusters.push_back(a);
  }
  std::ranges::reverse(clusters);
}

void FollowedLinks::find(const LinkSet& links) {
  const SourceRanges sources(*tree_, links);
  counts_ = std::vector<Count>(links.size());
  base::parallel_for(tree_->roots().size(), kGrain, [&](std::size_t begin, std::size_t end) {
    Counter counter(counts_);
    std::vector<std::uint32_t> ancestors;
    for (std::size_t i = begin; i < end; ++i) {
      find_ancestors(i, ancestors);
      find_of_side(i, ancestors, sources, counter);
    }
  });
}

void FollowedLinks::find_of_side(std::size_t root_order,
                                 const std::vector<std::uint32_t>& ancestors,
                                 const SourceRanges& sources, Counter& counter) {
  const auto area_m2 = static_cast<double>(tree_->at(tree_->roots()[root_order]).area_m2);
  for (std::size_t ray = 0; ray < rays_; ++ray) {
    const std::size_t index = root_order * rays_ + ray;
    followed_[index] = kNoLink;
    const std::uint32_t met = seen_[index];
    if (met == kNoElement) continue;
    // Most links stay, and those refined move to a receiver's children: looked for from where it
    // was on.
    for (std::size_t step = 0; step < ancestors.size(); ++step) {
      const std::size_t depth = (depth_[index] + step) % ancestors.size();
      const std::uint32_t link = sources.find(ancestors[depth], met);
      if (link == kNoLink) continue;
      followed_[index] = link;
      depth_[index] = static_cast<std::uint16_t>(depth);
      const auto receiver_m2 = static_cast<double>(tree_->at(ancestors[depth]).area_m2);
      const double share = area_m2 / (receiver_m2 * static_cast<double>(rays_));
      counter.add(link, static_cast<std::uint64_t>(share / kShareUnit + 0.5));
      break;
    }
  }
}

double FollowedLinks::share(std::size_t link) const {
  return kShareUnit * static_cast<double>(counts_[link].share.load());
}

std::int64_t FollowedLinks::memory_bytes() const {
  return static_cast<std::int64_t>(
      seen_.capacity() * sizeof(std::uint32_t) + followed_.capacity() * sizeof(std::uint32_t) +
      depth_.capacity() * sizeof(std::uint16_t) + counts_.capacity() * sizeof(Count));
}

}  // namespace renderers::element_hierarchy
