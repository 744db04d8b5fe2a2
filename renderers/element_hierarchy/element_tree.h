#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "renderers/element_hierarchy/element.h"
#include "renderers/element_hierarchy/lit_sides.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::element_hierarchy {

/// A point on the side of a surface.
struct SidePoint {
  ray_tracing::SurfacePoint surface;
  glm::vec3 normal{0.0F};  ///< geometric, unit length, towards the side
  std::uint32_t root = 0;  ///< which whole side
};

/// Clusters over the sides of a scene's triangles, which are cut 1:4 where light asks for it.
///
/// Clusters are found from the top by a binned surface area heuristic, four children each.
/// Sources: Sillion 1995, "A Unified Hierarchical Algorithm for Global Illumination with Scattering
/// Volumes and Object Clusters", IEEE TVCG 1(3), Sec. 4 (one hierarchy of clusters and patches);
/// Hanrahan, Salzman, Aupperle 1991, "A Rapid Hierarchical Radiosity Algorithm", (1:4 subdivision).
class ElementTree {
 public:
  /// @param rays   must live as long as this, with its scene
  /// @param sides  those worth having; triangles without area are left out
  /// @throws base::InputError if no side with an area is left
  ElementTree(const ray_tracing::RayScene& rays, const LitSides& sides);

  const std::vector<Element>& elements() const { return elements_; }
  const Element& at(std::uint32_t index) const { return elements_[index]; }
  std::span<const std::uint32_t> roots() const { return roots_; }  ///< elements of whole sides
  std::size_t degenerate_count() const { return degenerate_; }
  const ray_tracing::RayScene& rays() const { return *rays_; }

  /// Cuts a leaf patch at the midpoints of its edges. @return its first child
  std::uint32_t subdivide(std::uint32_t patch);
  void set_known_light(std::uint32_t leaf, const glm::vec3& point_light_w_m2,
                       const glm::vec3& environment_w_m2) {
    elements_[leaf].point_light_w_m2 = point_light_w_m2;
    elements_[leaf].environment_w_m2 = environment_w_m2;
  }

  /// Patch of a whole side at a place of a triangle. @param barycentrics  weights of its second and
  /// third vertex  @return kNoElement for one that is not in the tree
  std::uint32_t root_of(std::uint32_t object, std::uint32_t triangle, bool is_back,
                        const glm::vec2& barycentrics) const {
    return root_at_[2 * pieces_->place_of(object, triangle, barycentrics).piece +
                    (is_back ? 1 : 0)];
  }
  /// Leaf patch at a point. @param towards  any length; on which side of the surface
  /// @return kNoElement for a side that is not in the tree
  std::uint32_t leaf_at(const ray_tracing::SurfacePoint& point, const glm::vec3& towards) const;
  /// The same, with the weights of the leaf's corners.
  struct Place {
    std::uint32_t leaf = kNoElement;
    glm::vec3 weights{0.0F};
  };
  Place place_at(const ray_tracing::SurfacePoint& point, const glm::vec3& towards) const;

  /// Leaf at a place of a whole side. @param weights  of its piece's second and third corner
  std::uint32_t leaf_below(std::uint32_t root, const glm::vec2& weights) const {
    return place_below(root, {1.0F - weights.x - weights.y, weights.x, weights.y}).leaf;
  }

  /// Number of a whole side, 2 piece + back.
  std::size_t side_of(std::uint32_t root) const;

  /// True for the patch of a whole side.
  bool is_root(std::uint32_t element) const {
    return elements_[element].is_patch && roots_[elements_[element].root_begin] == element;
  }
  /// True if `element` is `ancestor` or below it.
  bool is_below(std::uint32_t element, std::uint32_t ancestor) const;

  /// A point uniform by area. @param u  in [0, 1)^2
  SidePoint sample(std::uint32_t element, glm::vec2 u) const {
    return sample(element, u, area_before_m2_);
  }
  /// The same, of a cluster's whole sides by weights of theirs. @param before  sums of the weights
  /// of the sides before each, in the order of the roots, size + 1; that of the element not zero
  SidePoint sample(std::uint32_t element, glm::vec2 u, std::span<const double> before) const;
  /// @param weights  of a patch's second and third corner
  SidePoint point_of(const Element& patch, const glm::vec2& weights) const;

  std::int64_t memory_bytes() const;

 private:
  void add_sides(const LitSides& sides, std::vector<Element>& patches);
  void build_clusters(std::vector<Element>& patches);
  void sum_materials(Element& patch) const;
  Place place_below(std::uint32_t root, const glm::vec3& weights) const;

  const ray_tracing::RayScene* rays_;
  std::vector<Element> elements_;
  std::vector<std::uint32_t> roots_;    ///< in the order of `root_begin`
  std::vector<double> area_before_m2_;  ///< of the roots, size + 1
  std::shared_ptr<const SurfacePieces> pieces_;
  std::vector<std::uint32_t> root_at_;  ///< [2 piece + back]: element, or kNoElement
  std::size_t degenerate_ = 0;
};

}  // namespace renderers::element_hierarchy
