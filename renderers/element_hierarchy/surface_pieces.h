#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::element_hierarchy {

/// The triangles of a scene, those much larger than its mean cut in four until they are not.
///
/// A side has one radiosity for the rays that meet it and one irradiance from its own rays, so a
/// floor of two triangles would carry light from its middle to what lies behind a wall on it.
class SurfacePieces {
 public:
  /// @param rays        must live as long as this
  /// @param most_means  largest area of a piece by the mean over all triangles; 0: none is cut
  SurfacePieces(const ray_tracing::RayScene& rays, double most_means);

  std::size_t count() const { return object_of_.size(); }
  struct Piece {
    std::uint32_t object = 0;
    std::uint32_t triangle = 0;
    std::array<glm::vec2, 3> corners{};  ///< weights of the triangle's second and third vertex
    float area_m2 = 0.0F;
  };
  Piece at(std::size_t piece) const;

  /// A point's place in its piece.
  struct Place {
    std::size_t piece = 0;
    glm::vec3 weights{0.0F};  ///< of the piece's corners
  };
  /// @param barycentrics  weights of the triangle's second and third vertex
  Place place_of(std::uint32_t object, std::uint32_t triangle, const glm::vec2& barycentrics) const;

  std::int64_t memory_bytes() const;

 private:
  std::size_t index_of(std::uint32_t object, std::uint32_t triangle) const {
    return first_triangle_[object] + triangle;
  }
  const ray_tracing::RayScene* rays_;
  std::vector<std::size_t> first_triangle_;  ///< per object, of its triangles below
  std::vector<std::uint32_t> first_;         ///< per triangle: its first piece
  std::vector<std::uint8_t> cuts_;           ///< per triangle: 4^cuts pieces
  std::vector<std::uint32_t> object_of_;     ///< per piece
  std::vector<std::uint32_t> triangle_of_;   ///< per piece
};

/// The corner that a point's part of a triangle cut at the midpoints of its edges has, 3: the part
/// in the middle. @param weights  of the corners; receives those of the part's
std::uint32_t descend_to_part(glm::vec3& weights);
/// The corners of such a part.
std::array<glm::vec2, 3> corners_of_part(const std::array<glm::vec2, 3>& corners,
                                         std::uint32_t part);

}  // namespace renderers::element_hierarchy
