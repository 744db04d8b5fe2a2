#include "renderers/final_gather/surface_vertices.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace renderers::final_gather {

using element_hierarchy::Element;
using element_hierarchy::ElementTree;
using element_hierarchy::kNoElement;
using element_hierarchy::PatchVertices;

glm::vec2 inside_corner(int corner) {
  constexpr float kInside = 0.02F;
  glm::vec3 weights(kInside);
  weights[corner] = 1.0F - 2.0F * kInside;
  return {weights.y, weights.z};
}

SurfaceVertices::SurfaceVertices(const ElementTree& tree, const PatchVertices* vertices,
                                 const std::vector<Anchor>& anchors, const std::vector<bool>& is_in)
    : tree_(tree), vertices_(vertices), all_anchors_(anchors) {
  site_at_.assign(vertices != nullptr ? vertices->count() : tree.elements().size(), kNoElement);
  std::vector<std::vector<std::uint32_t>> sites_of_anchors(anchors.size());
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (!is_in[i]) continue;
    const auto point = tree.rays().point_on_triangle(anchors[i].object, anchors[i].triangle,
                                                     anchors[i].barycentrics);
    for (const auto& [vertex, weight] : bearing(tree.place_at(point, anchors[i].towards))) {
      if (site_at_[vertex] == kNoElement) {
        site_at_[vertex] = static_cast<std::uint32_t>(named_.size());
        named_.push_back(vertex);
      }
      sites_of_anchors[i].push_back(site_at_[vertex]);
    }
  }
  find_leaves();
  sort_anchors(sites_of_anchors);
}

std::vector<PatchVertices::Weighted> SurfaceVertices::bearing(
    const ElementTree::Place& place) const {
  std::vector<PatchVertices::Weighted> found;
  if (place.leaf == kNoElement) return found;
  if (vertices_ == nullptr) {
    found.push_back({place.leaf, 1.0F});
    return found;
  }
  for (int c = 0; c < 3; ++c) {
    vertices_->add_bearing(vertices_->of(place.leaf)[static_cast<std::size_t>(c)], place.weights[c],
                           found);
  }
  // A vertex at the end of two edges comes twice.
  std::ranges::sort(found, {}, &PatchVertices::Weighted::vertex);
  std::size_t last = 0;
  for (std::size_t i = 1; i < found.size(); ++i) {
    if (found[i].vertex == found[last].vertex) {
      found[last].weight += found[i].weight;
    } else {
      found[++last] = found[i];
    }
  }
  found.resize(last + 1);
  return found;
}

void SurfaceVertices::find_leaves() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  // site, leaf
  const auto& elements = tree_.elements();
  for (std::uint32_t i = 0; i < elements.size(); ++i) {
    if (!elements[i].is_patch || !elements[i].is_leaf()) continue;
    if (vertices_ == nullptr) {
      if (site_at_[i] != kNoElement) pairs.emplace_back(site_at_[i], i);
      continue;
    }
    std::vector<PatchVertices::Weighted> found;
    for (const std::uint32_t corner : vertices_->of(i)) vertices_->add_bearing(corner, 1.0F, found);
    for (const PatchVertices::Weighted& one : found) {
      if (site_at_[one.vertex] != kNoElement) pairs.emplace_back(site_at_[one.vertex], i);
    }
  }
  std::ranges::sort(pairs);
  const auto repeated = std::ranges::unique(pairs);
  pairs.erase(repeated.begin(), repeated.end());
  leaf_begin_.assign(named_.size() + 1, 0);
  for (const auto& [site, leaf] : pairs) {
    ++leaf_begin_[site + 1];
    leaves_.push_back(leaf);
  }
  for (std::size_t i = 1; i < leaf_begin_.size(); ++i) leaf_begin_[i] += leaf_begin_[i - 1];
}

void SurfaceVertices::sort_anchors(
    const std::vector<std::vector<std::uint32_t>>& sites_of_anchors) {
  anchor_begin_.assign(named_.size() + 1, 0);
  for (const auto& sites : sites_of_anchors) {
    for (const std::uint32_t site : sites) ++anchor_begin_[site + 1];
  }
  for (std::size_t i = 1; i < anchor_begin_.size(); ++i) anchor_begin_[i] += anchor_begin_[i - 1];
  anchors_.resize(anchor_begin_.back());
  std::vector<std::size_t> next(anchor_begin_.begin(), anchor_begin_.end() - 1);
  for (std::uint32_t i = 0; i < sites_of_anchors.size(); ++i) {
    for (const std::uint32_t site : sites_of_anchors[i]) anchors_[next[site]++] = i;
  }
}

std::vector<const Anchor*> SurfaceVertices::anchors(std::size_t site) const {
  std::vector<const Anchor*> found;
  for (std::size_t i = anchor_begin_[site]; i < anchor_begin_[site + 1]; ++i) {
    found.push_back(&all_anchors_[anchors_[i]]);
  }
  return found;
}

element_hierarchy::SidePoint SurfaceVertices::place(std::size_t site) const {
  if (vertices_ == nullptr) return tree_.point_of(tree_.at(named_[site]), glm::vec2(1.0F / 3.0F));
  std::uint32_t largest = kNoElement;
  std::ptrdiff_t corner = 0;
  for (const std::uint32_t leaf : leaves(site)) {
    // Leaves that it bears a hanging vertex of have it at no corner.
    const auto& corners = vertices_->of(leaf);
    const auto at = std::ranges::find(corners, named_[site]) - corners.begin();
    const bool is_larger =
        largest == kNoElement || tree_.at(leaf).area_m2 > tree_.at(largest).area_m2;
    if (at == 3 || !is_larger) continue;
    largest = leaf;
    corner = at;
  }
  return tree_.point_of(tree_.at(largest), inside_corner(static_cast<int>(corner)));
}

std::vector<SurfaceVertices::Weighted> SurfaceVertices::around(
    const ray_tracing::SurfacePoint& point, const glm::vec3& towards) const {
  std::vector<Weighted> found;
  for (const auto& [vertex, weight] : bearing(tree_.place_at(point, towards))) {
    found.push_back({site_at_[vertex], weight});
  }
  return found;
}

}  // namespace renderers::final_gather
