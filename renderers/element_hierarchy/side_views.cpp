#include "renderers/element_hierarchy/side_views.h"

#include <algorithm>
#include <limits>
#include <span>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::element_hierarchy {

namespace {

constexpr std::size_t kGrain = 256;

/// Whole sides that one receiver's links bring light from: [begin, end) in the order of the roots.
struct SourceRange {
  std::uint32_t begin;
  std::uint32_t end;
  std::uint32_t link;  ///< index into all links
};
constexpr std::uint32_t kNoLink = std::numeric_limits<std::uint32_t>::max();
/// Rays that tell what a link lets through better than its own samples; ours.
constexpr std::uint32_t kEnoughRays = 32;

/// Per cluster the sources of its links, sorted; they are disjoint, but for parts of one side.
class SourceRanges {
 public:
  SourceRanges(const ElementTree& tree, const LinkSet& links) {
    const auto count = static_cast<std::uint32_t>(tree.elements().size());
    first_.push_back(0);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!tree.at(i).is_patch) {
        for (const Link& link : links.of(i)) {
          const Element& source = tree.at(link.source);
          const auto index = static_cast<std::uint32_t>(&link - links.all().data());
          ranges_.push_back({source.root_begin, source.root_end, index});
        }
      }
      const auto own = std::span(ranges_).subspan(first_.back());
      std::ranges::sort(own, {}, &SourceRange::begin);
      first_.push_back(ranges_.size());
    }
  }

  /// @return index of the link, or kNoLink
  std::uint32_t find(std::uint32_t receiver, std::uint32_t root_order) const {
    const auto own =
        std::span(ranges_).subspan(first_[receiver], first_[receiver + 1] - first_[receiver]);
    const auto after = std::ranges::upper_bound(own, root_order, {}, &SourceRange::begin);
    if (after == own.begin() || root_order >= std::prev(after)->end) return kNoLink;
    return std::prev(after)->link;
  }

 private:
  std::vector<SourceRange> ranges_;
  std::vector<std::size_t> first_;  ///< per element, size + 1
};

/// What the rays of a cluster's sides tell of one of its links.
struct Followed {
  double share = 0.0;  ///< of all rays, by area: form factor times visibility
  std::uint32_t rays = 0;
};

void let_through(Link& link, double share) {
  link.form_factor = std::max(link.form_factor, static_cast<float>(share));
  link.visibility =
      std::max<std::uint16_t>(1, share_coded(share / static_cast<double>(link.form_factor)));
  link.greatest_visibility = std::max(link.greatest_visibility, link.visibility);
  link.least_visibility = std::min(link.least_visibility, link.visibility);
  link.flags &= static_cast<std::uint16_t>(~fully_occluded);
}

}  // namespace

SideViews::SideViews(const ElementTree& tree, const LitSides& sides)
    : tree_(&tree), rays_(sides.rays_per_side) {
  const auto roots = static_cast<std::uint32_t>(tree.roots().size());
  const auto side_of = [&](const Element& patch) {
    return 2 * (sides.first[patch.object] + patch.triangle) + (patch.is_back ? 1 : 0);
  };
  std::vector<std::uint32_t> order_of(sides.is_lit.size(), kNoElement);
  for (std::uint32_t i = 0; i < roots; ++i) order_of[side_of(tree.at(tree.roots()[i]))] = i;
  seen_.reserve(roots * rays_);
  first_.push_back(0);
  for (std::uint32_t i = 0; i < roots; ++i) {
    const std::size_t side = side_of(tree.at(tree.roots()[i]));
    for (std::size_t ray = 0; ray < rays_; ++ray) {
      const std::uint32_t met = sides.seen[side * rays_ + ray];
      seen_.push_back(met == kNoSide ? kNoElement : order_of[met]);
    }
    const std::size_t begin = ancestors_.size();
    for (std::uint32_t a = tree.at(tree.roots()[i]).parent; a != kNoElement;
         a = tree.at(a).parent) {
      ancestors_.push_back(a);
    }
    std::reverse(ancestors_.begin() + static_cast<std::ptrdiff_t>(begin), ancestors_.end());
    first_.push_back(ancestors_.size());
  }
  depth_.resize(tree.elements().size(), 0);
  for (std::size_t i = 1; i < depth_.size(); ++i) {
    depth_[i] = static_cast<std::uint8_t>(depth_[tree.elements()[i].parent] + 1);
  }
  cluster_at_.resize(depth_.size(), kNoElement);
  for (std::size_t i = 0; i < depth_.size(); ++i) {
    if (!tree.elements()[i].is_patch) cluster_at_[i] = static_cast<std::uint32_t>(clusters_++);
  }
  share_.assign(ancestors_.size(), 1.0F);
  count_escapes();
}

void SideViews::count_escapes() {
  outside_.assign(ancestors_.size(), 0.0F);
  inside_ = outside_;
  const float weight = 1.0F / static_cast<float>(rays_);
  base::parallel_for(tree_->roots().size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t ray = 0; ray < rays_; ++ray) {
        const std::uint32_t met = seen_[i * rays_ + ray];
        if (met == kNoElement) continue;
        for (std::size_t a = first_[i]; a < first_[i + 1]; ++a) {
          const Element& cluster = tree_->at(ancestors_[a]);
          const bool is_inside = met >= cluster.root_begin && met < cluster.root_end;
          (is_inside ? inside_ : outside_)[a] += weight;
        }
      }
    }
  });
}

void SideViews::correct_links(LinkSet& links) const {
  const SourceRanges sources(*tree_, links);
  const std::span<const std::uint32_t> roots = tree_->roots();
  std::vector<Followed> followed(links.size());
  base::parallel_for(depth_.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const Element& cluster = tree_->elements()[c];
      const auto receiver = static_cast<std::uint32_t>(c);
      const std::span<Link> own = links.of(receiver);
      if (cluster.is_patch || own.empty()) continue;
      const float weight = 1.0F / (cluster.area_m2 * static_cast<float>(rays_));
      for (std::size_t i = cluster.root_begin; i < cluster.root_end; ++i) {
        for (std::size_t ray = 0; ray < rays_; ++ray) {
          const std::uint32_t met = seen_[i * rays_ + ray];
          const std::uint32_t link = met == kNoElement ? kNoLink : sources.find(receiver, met);
          if (link == kNoLink) continue;
          followed[link].share += static_cast<double>(weight * tree_->at(roots[i]).area_m2);
          ++followed[link].rays;
        }
      }
      const auto first = static_cast<std::size_t>(own.data() - links.all().data());
      for (std::size_t i = 0; i < own.size(); ++i) {
        // Rays do not tell the parts of a side apart.
        const bool is_part = tree_->at(own[i].source).is_patch && !tree_->is_root(own[i].source);
        if (is_part || followed[first + i].rays < kEnoughRays) continue;
        let_through(own[i], followed[first + i].share);
      }
    }
  });
}

void SideViews::share_out(LinkSet& links, const std::vector<glm::vec3>& radiosity) {
  correct_links(links);
  const SourceRanges sources(*tree_, links);
  const std::span<const std::uint32_t> roots = tree_->roots();
  std::vector<float> brightness;
  for (const std::uint32_t root : roots) {
    brightness.push_back(ray_tracing::luminance(radiosity[root]));
  }
  std::ranges::fill(share_, 0.0F);
  base::parallel_for(roots.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t ray = 0; ray < rays_; ++ray) {
        const std::uint32_t met = seen_[i * rays_ + ray];
        if (met == kNoElement) continue;
        // The links of a patch and of its ancestors have every source once.
        for (std::size_t a = first_[i]; a < first_[i + 1]; ++a) {
          const std::uint32_t link = sources.find(ancestors_[a], met);
          if (link == kNoLink) continue;
          if (links.all()[link].transfer() > 0.0F) share_[a] += brightness[met];
          break;
        }
      }
    }
  });
  // Divided by the means over the clusters, so that no power is lost.
  base::parallel_for(depth_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const Element& cluster = tree_->elements()[c];
      if (cluster.is_patch) continue;
      double sum = 0.0;
      for (std::uint32_t i = cluster.root_begin; i < cluster.root_end; ++i) {
        sum += static_cast<double>(tree_->at(roots[i]).area_m2 * share_[first_[i] + depth_[c]]);
      }
      const auto mean = static_cast<float>(sum / static_cast<double>(cluster.area_m2));
      for (std::uint32_t i = cluster.root_begin; i < cluster.root_end; ++i) {
        float& share = share_[first_[i] + depth_[c]];
        share = mean > 0.0F ? share / mean : 1.0F;
      }
    }
  });
}

std::vector<glm::vec3> SideViews::push(const std::vector<glm::vec3>& gathered) const {
  const std::vector<Element>& elements = tree_->elements();
  std::vector<glm::vec3> irradiance = gathered;
  for (std::size_t i = 1; i < elements.size(); ++i) {
    const Element& element = elements[i];
    const bool is_root = element.is_patch && tree_->is_root(static_cast<std::uint32_t>(i));
    if (!is_root) {
      irradiance[i] += irradiance[element.parent];
      continue;
    }
    for (std::size_t a = first_[element.root_begin]; a < first_[element.root_begin + 1]; ++a) {
      irradiance[i] += share_[a] * gathered[ancestors_[a]];
    }
  }
  return irradiance;
}

SideViews::Sent SideViews::sent(const std::vector<glm::vec3>& radiosity) const {
  Sent sent{radiosity, radiosity, std::vector<DirectedRadiosity>(clusters_), cluster_at_};
  const std::span<const std::uint32_t> roots = tree_->roots();
  base::parallel_for(depth_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const Element& cluster = tree_->elements()[c];
      if (cluster.is_patch) continue;
      DirectedRadiosity& directed = sent.directed[cluster_at_[c]];
      glm::vec3 out(0.0F);
      glm::vec3 inside(0.0F);
      float out_m2 = 0.0F;
      float inside_m2 = 0.0F;
      for (std::uint32_t i = cluster.root_begin; i < cluster.root_end; ++i) {
        const std::size_t place = first_[i] + depth_[c];
        const float own_out_m2 = tree_->at(roots[i]).area_m2 * outside_[place];
        const float own_inside_m2 = tree_->at(roots[i]).area_m2 * inside_[place];
        out += own_out_m2 * radiosity[roots[i]];
        directed.add(tree_->at(roots[i]).normal, own_out_m2, radiosity[roots[i]]);
        inside += own_inside_m2 * radiosity[roots[i]];
        out_m2 += own_out_m2;
        inside_m2 += own_inside_m2;
      }
      if (out_m2 > 0.0F) sent.out[c] = out / out_m2;
      if (inside_m2 > 0.0F) sent.inside[c] = inside / inside_m2;
    }
  });
  return sent;
}

glm::vec3 SideViews::Sent::towards(std::uint32_t element, const glm::vec3& direction) const {
  const std::uint32_t cluster = element < cluster_at.size() ? cluster_at[element] : kNoElement;
  return cluster == kNoElement ? out[element] : directed[cluster].at(direction, out[element]);
}

std::int64_t SideViews::memory_bytes() const {
  return static_cast<std::int64_t>(
      seen_.capacity() * sizeof(std::uint32_t) + depth_.capacity() +
      cluster_at_.capacity() * sizeof(std::uint32_t) + first_.capacity() * sizeof(std::size_t) +
      ancestors_.capacity() * (sizeof(std::uint32_t) + 3 * sizeof(float)));
}

}  // namespace renderers::element_hierarchy
