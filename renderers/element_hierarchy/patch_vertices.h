#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/element_hierarchy/element_tree.h"

namespace renderers::element_hierarchy {

/// Corners of patches joined where they meet: at one place, with normals less than 37 degrees
/// apart. A vertex in the middle of a larger neighbour's edge hangs: its value is the mean of the
/// edge's ends, so that what is interpolated has no step there.
///
/// Source: hanging vertices as in Cohen and Wallace 1993, "Radiosity and Realistic Image
/// Synthesis", ch. 8 (T-vertices; recalled), by constraint instead of more triangles.
class PatchVertices {
 public:
  explicit PatchVertices(const ElementTree& tree);

  std::size_t count() const { return areas_m2_.size(); }
  /// Vertices of a patch's corners.
  const std::array<std::uint32_t, 3>& of(std::uint32_t patch) const { return corners_[patch]; }

  struct Weighted {
    std::uint32_t vertex;
    float weight;
  };
  /// Adds the vertices whose values make up that of a vertex: itself, or those of the edge on which
  /// it hangs. A vertex can come more than once.
  void add_bearing(std::uint32_t vertex, float weight, std::vector<Weighted>& into) const;

  /// Means over the leaves around each vertex, by area. @param values  per element
  std::vector<glm::vec3> means(const ElementTree& tree, const std::vector<glm::vec3>& values) const;

 private:
  struct Hanging {
    std::uint32_t vertex;
    std::uint32_t ends[2];
  };
  void find_hanging(const ElementTree& tree);
  /// True if a vertex is another, or hangs, by whatever steps, on it.
  bool rests_on(std::uint32_t vertex, std::uint32_t other) const;

  std::vector<std::array<std::uint32_t, 3>> corners_;  ///< per element
  std::vector<float> areas_m2_;                        ///< of the leaves around each vertex
  std::vector<Hanging> hanging_;                       ///< ends before those that hang between them
  std::vector<std::uint32_t> hanging_at_;              ///< per vertex, into hanging_; or kNoElement
};

}  // namespace renderers::element_hierarchy
