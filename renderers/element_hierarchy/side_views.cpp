#include "renderers/element_hierarchy/side_views.h"

#include <algorithm>
#include <span>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::element_hierarchy {

namespace {

constexpr std::size_t kGrain = 256;

/// Rays that tell what a link lets through better than its own samples; ours.
constexpr std::uint32_t kEnoughRays = 32;
/// Sides of a piece.
constexpr std::uint32_t kPieceSides = 4096;

void let_through(Link& link, double share) {
  link.form_factor = std::max(link.form_factor, static_cast<float>(share));
  link.visibility =
      std::max<std::uint16_t>(1, share_coded(share / static_cast<double>(link.form_factor)));
  link.greatest_visibility = std::max(link.greatest_visibility, link.visibility);
  link.least_visibility = std::min(link.least_visibility, link.visibility);
  link.flags &= static_cast<std::uint16_t>(~fully_occluded);
}

}  // namespace

/// Sums over the sides of one piece, m2 and W.
struct SideViews::Sum {
  DirectedRadiosity directed;
  glm::vec3 out_w{0.0F};
  float out_m2 = 0.0F;

  void add(const Sum& other) {
    directed.add(other.directed);
    out_w += other.out_w;
    out_m2 += other.out_m2;
  }
};

SideViews::SideViews(const ElementTree& tree, const LitSides& sides)
    : tree_(&tree), followed_(tree, sides) {
  std::int64_t count = 0;
  for (const Element& element : tree.elements()) {
    first_.push_back(count - element.root_begin);
    if (!element.is_patch) count += element.root_end - element.root_begin;
  }
  for (const std::uint32_t root : tree.roots()) normals_.push_back(tree.at(root).normal);
  outside_m2_.resize(static_cast<std::size_t>(count));
  place_of_.assign(first_.size(), kNoElement);
  lamps_w_m2_.assign(tree.roots().size(), glm::vec3(0.0F));
  count_escapes();
}

void SideViews::count_escapes() {
  const std::size_t rays = followed_.rays_per_side();
  base::parallel_for(tree_->roots().size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> ancestors;
    std::vector<std::uint32_t> leaving;  // per ancestor: rays that leave it and no larger one
    for (std::size_t i = begin; i < end; ++i) {
      followed_.find_ancestors(i, ancestors);
      leaving.assign(ancestors.size() + 1, 0);
      for (std::size_t ray = 0; ray < rays; ++ray) {
        const std::uint32_t met = followed_.met(i, ray);
        if (met == kNoElement) continue;
        const auto is_outside = [&](std::uint32_t cluster) {
          return met < tree_->at(cluster).root_begin || met >= tree_->at(cluster).root_end;
        };
        ++leaving[static_cast<std::size_t>(std::ranges::find_if(ancestors, is_outside) -
                                           ancestors.begin())];
      }
      const float weight = tree_->at(tree_->roots()[i]).area_m2 / static_cast<float>(rays);
      std::uint32_t outside = 0;
      for (std::size_t a = 0; a + 1 < ancestors.size(); ++a) {  // the last is the side itself
        outside += leaving[a];
        outside_m2_[place(ancestors[a], i)] = weight * static_cast<float>(outside);
      }
    }
  });
}

void SideViews::correct_links(LinkSet& links) const {
  base::parallel_for(first_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t receiver = begin; receiver < end; ++receiver) {
      const bool is_side = tree_->elements()[receiver].is_patch;
      for (Link& link : links.of(static_cast<std::uint32_t>(receiver))) {
        // Between patches the form factor is known better.
        if (is_side && tree_->at(link.source).is_patch) continue;
        const auto index = static_cast<std::size_t>(&link - links.all().data());
        if (followed_.rays(index) >= kEnoughRays) let_through(link, followed_.share(index));
        if (followed_.rays(index) == 0) continue;
        link.flags &= static_cast<std::uint16_t>(~fully_occluded);
        link.greatest_visibility = std::max<std::uint16_t>(1, link.greatest_visibility);
      }
    }
  });
}

void SideViews::sum_lamps() {
  emissive_.clear();
  for (std::uint32_t i = 0; i < tree_->elements().size(); ++i) {
    if (tree_->at(i).is_patch && tree_->at(i).emitted_w_m2 != glm::vec3(0.0F)) {
      emissive_.push_back(i);
    }
  }
  lamps_w_m2_.assign(tree_->roots().size(), glm::vec3(0.0F));
  base::parallel_for(lamps_w_m2_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (const FollowedLinks::Lamp& lamp : followed_.lamps(i)) {
        if (lamp.leaf == kNoElement) continue;
        lamps_w_m2_[i] += lamp.weight * tree_->at(lamp.leaf).emitted_w_m2;
      }
    }
  });
}

void SideViews::find_senders(const LinkSet& links) {
  std::ranges::fill(place_of_, kNoElement);
  for (const Link& link : links.all()) {
    if (!tree_->at(link.source).is_patch) place_of_[link.source] = 0;
  }
  pieces_.clear();
  senders_ = 0;
  for (std::uint32_t c = 0; c < place_of_.size(); ++c) {
    if (place_of_[c] == kNoElement) continue;
    place_of_[c] = static_cast<std::uint32_t>(senders_++);
    const Element& cluster = tree_->at(c);
    for (std::uint32_t i = cluster.root_begin; i < cluster.root_end; i += kPieceSides) {
      pieces_.push_back({c, i, std::min(i + kPieceSides, cluster.root_end)});
    }
  }
}

void SideViews::follow(LinkSet& links, std::size_t most_rays) {
  followed_.find(links, std::min(most_rays, followed_.rays_per_side()));
  correct_links(links);
  sum_lamps();
  find_senders(links);
}

void SideViews::gather(const std::vector<glm::vec3>& radiosity,
                       std::vector<glm::vec3>& received) const {
  const std::span<const std::uint32_t> roots = tree_->roots();
  std::vector<glm::vec3> reflected = radiosity;
  for (const std::uint32_t i : emissive_) reflected[i] -= tree_->at(i).emitted_w_m2;
  base::parallel_for(roots.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      glm::vec3 sum(0.0F);
      for (std::size_t ray = 0; ray < followed_.followed_rays(); ++ray) {
        const std::uint32_t leaf = followed_.leaf(i, ray);
        if (leaf != kNoElement) sum += reflected[leaf];
      }
      received[roots[i]] = lamps_w_m2_[i] + sum / static_cast<float>(followed_.followed_rays());
    }
  });
}

SideViews::Sum SideViews::sum_of(const Piece& piece, const std::vector<glm::vec3>& of_roots) const {
  Sum sum;
  const std::size_t first = place(piece.cluster, piece.begin);
  for (std::uint32_t i = piece.begin; i < piece.end; ++i) {
    const glm::vec3 own = of_roots[i];
    const float out_m2 = outside_m2_[first + (i - piece.begin)];
    sum.directed.add(normals_[i], out_m2, own);
    sum.out_w += out_m2 * own;
    sum.out_m2 += out_m2;
  }
  return sum;
}

void SideViews::send(const std::vector<glm::vec3>& radiosity, Sent& sent) const {
  sent.out = radiosity;
  sent.directed.assign(senders_, {});
  sent.place_of = place_of_;
  std::vector<glm::vec3> of_roots;  // side by side: clusters read them again and again
  of_roots.reserve(tree_->roots().size());
  for (const std::uint32_t root : tree_->roots()) of_roots.push_back(radiosity[root]);
  std::vector<Sum> sums(pieces_.size());
  base::parallel_for(pieces_.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sums[i] = sum_of(pieces_[i], of_roots);
  });
  for (std::size_t i = 0; i < pieces_.size();) {
    const std::uint32_t cluster = pieces_[i].cluster;
    Sum sum = sums[i];
    for (++i; i < pieces_.size() && pieces_[i].cluster == cluster; ++i) sum.add(sums[i]);
    sent.directed[place_of_[cluster]] = sum.directed;
    if (sum.out_m2 > 0.0F) sent.out[cluster] = sum.out_w / sum.out_m2;
  }
}

glm::vec3 SideViews::Sent::towards(std::uint32_t element, const glm::vec3& direction) const {
  const std::uint32_t place = element < place_of.size() ? place_of[element] : kNoElement;
  return place == kNoElement ? out[element] : directed[place].at(direction, out[element]);
}

std::int64_t SideViews::memory_bytes() const {
  return followed_.memory_bytes() +
         static_cast<std::int64_t>(
             first_.capacity() * sizeof(std::int64_t) + normals_.capacity() * sizeof(glm::vec3) +
             outside_m2_.capacity() * sizeof(float) + lamps_w_m2_.capacity() * sizeof(glm::vec3) +
             emissive_.capacity() * sizeof(std::uint32_t) + pieces_.capacity() * sizeof(Piece) +
             place_of_.capacity() * sizeof(std::uint32_t));
}

}  // namespace renderers::element_hierarchy
