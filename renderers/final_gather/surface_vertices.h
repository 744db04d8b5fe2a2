#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderers/element_hierarchy/patch_vertices.h"
#include "renderers/final_gather/camera_anchors.h"

namespace renderers::final_gather {

/// What a surface gather decides for.
enum class DecidedFor {
  vertices,  ///< of the patches, and interpolated between them: no seams
  patches    ///< each by itself: seams along their borders (Sec. 2)
};

/// Weights of a patch's second and third corner for a point just inside one of its corners: in the
/// plane of no neighbour that stands on the patch.
glm::vec2 inside_corner(int corner);

/// Vertices of the patches that the camera sees, or these patches.
///
/// A vertex that hangs on a larger neighbour's edge has no decisions of its own: the ends of the
/// edge stand for it, so that what is interpolated has no step there.
/// Source: Scheel, Stamminger, Seidel 2001, "Thrifty Final Gather for Radiosity",
/// doi:10.1007/978-3-7091-6242-2_1, as Scheel et al. 2002, Secs. 2 and 4.5, describe it.
class SurfaceVertices {
 public:
  /// @param vertices  of the tree; null for `DecidedFor::patches`
  /// @param is_in     anchors that are on these surfaces
  /// All must live as long as this.
  SurfaceVertices(const element_hierarchy::ElementTree& tree,
                  const element_hierarchy::PatchVertices* vertices,
                  const std::vector<Anchor>& anchors, const std::vector<bool>& is_in);

  std::size_t count() const { return leaf_begin_.size() - 1; }
  /// Leaf patches around a vertex, or the patch.
  std::span<const std::uint32_t> leaves(std::size_t site) const {
    return std::span(leaves_).subspan(leaf_begin_[site], leaf_begin_[site + 1] - leaf_begin_[site]);
  }
  /// Points that the camera sees on those leaves, as far as the vertex plays a part there.
  std::vector<const Anchor*> anchors(std::size_t site) const;
  /// The vertex, just inside its largest leaf, or the patch's centre.
  element_hierarchy::SidePoint place(std::size_t site) const;

  /// A site, or kNoElement if the camera did not look there, and its weight at a point.
  struct Weighted {
    std::uint32_t site;
    float weight;
  };
  /// Sites that a point lies between; their weights sum to 1.
  std::vector<Weighted> around(const ray_tracing::SurfacePoint& point,
                               const glm::vec3& towards) const;
  const element_hierarchy::ElementTree& tree() const { return tree_; }

 private:
  /// Vertices, or the leaf, that bear a point.
  std::vector<element_hierarchy::PatchVertices::Weighted> bearing(
      const element_hierarchy::ElementTree::Place& place) const;
  void find_leaves();
  void sort_anchors(const std::vector<std::vector<std::uint32_t>>& sites_of_anchors);

  const element_hierarchy::ElementTree& tree_;
  const element_hierarchy::PatchVertices* vertices_;
  const std::vector<Anchor>& all_anchors_;
  std::vector<std::uint32_t> site_at_;  ///< per vertex or element; kNoElement: not seen
  std::vector<std::uint32_t> named_;    ///< vertex or element of each site
  std::vector<std::uint32_t> leaves_;   ///< by site
  std::vector<std::size_t> leaf_begin_;
  std::vector<std::uint32_t> anchors_;  ///< by site, into all_anchors_
  std::vector<std::size_t> anchor_begin_;
};

}  // namespace renderers::final_gather
