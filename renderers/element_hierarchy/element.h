#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace renderers::element_hierarchy {

inline constexpr std::uint32_t kNoElement = std::numeric_limits<std::uint32_t>::max();

/// A node of the hierarchy: a cluster of surfaces, or a patch: one side of a triangle or of a part
/// of it. Children are contiguous and come after their parent.
///
/// Materials here reflect on both sides, so a triangle makes up to two patches that share their
/// place and look in opposite directions.
struct Element {
  glm::vec3 box_min{std::numeric_limits<float>::infinity()};
  glm::vec3 box_max{-std::numeric_limits<float>::infinity()};
  float area_m2 = 0.0F;  ///< of all patches below, each side by itself
  bool is_patch = false;
  bool is_back = false;          ///< patch: the triangle's back side
  std::uint8_t child_count = 0;  ///< 0: a leaf
  std::uint32_t parent = kNoElement;
  std::uint32_t first_child = kNoElement;
  std::uint32_t root_begin = 0;  ///< whole triangles' sides below: [root_begin, root_end)
  std::uint32_t root_end = 0;
  std::uint32_t object = 0;              ///< patch: index into Scene::objects
  std::uint32_t triangle = 0;            ///< patch: index into the object's Mesh::triangles
  std::array<glm::vec2, 3> corners{};    ///< patch: barycentrics in the triangle
  std::array<glm::vec3, 3> positions{};  ///< patch: world space, counter-clockwise from its side
  glm::vec3 normal{0.0F};                ///< patch: unit length, towards its side
  glm::vec3 reflectance{0.0F};           ///< mean over the area, [0, 1]
  glm::vec3 emitted_w_m2{0.0F};          ///< mean of pi L over the area
  /// Leaf patch: irradiance that no link carries, as no element sends it.
  glm::vec3 point_light_w_m2{0.0F};
  glm::vec3 environment_w_m2{0.0F};

  bool is_leaf() const { return child_count == 0; }
  /// Length of the box's diagonal, m.
  float extent_m() const { return glm::length(box_max - box_min); }
};

}  // namespace renderers::element_hierarchy
