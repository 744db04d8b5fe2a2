#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/texel_atlas/texel_atlas.h"

namespace renderers::ray_bundles {

/// What a point of a textured surface has where its texel has means.
struct PointColors {
  glm::vec3 emission{0.0F};      ///< radiance of the front, W/(m2 sr)
  glm::vec3 albedo_ratio{1.0F};  ///< the point's albedo over its texel's; 1 where that is black
};

/// Emission and albedo at the points of senders that lines meet, by the textures' own coordinates.
///
/// Source: Hermes et al. 2010, Sec. 5.1: emission "is stored in the pixels" of a bundle, so that
/// light of textured sources keeps patterns finer than the atlas. Differs from the paper: the
/// albedo of what reflects is taken at the point, too; the paper has it from the atlas.
class TextureDetail {
 public:
  /// @param rays, atlas  must live as long as this
  TextureDetail(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas);

  /// True if no surface has a texture.
  bool is_empty() const { return pieces_.empty(); }
  /// @param position  of the crossing, world space
  /// @return nothing where the texel has no texture: its means are exact
  std::optional<PointColors> at(std::uint32_t texel, const glm::vec3& position) const;
  std::int64_t memory_bytes() const;

 private:
  /// A textured triangle, linear over the atlas.
  struct Piece {
    glm::vec2 corner{0.0F};     ///< of the first vertex, texels
    glm::vec2 second_of{0.0F};  ///< dot with an offset from there: weight of the second vertex
    glm::vec2 third_of{0.0F};
    glm::vec2 uv{0.0F};         ///< of the first vertex
    glm::vec2 uv_second{0.0F};  ///< from there to the second vertex
    glm::vec2 uv_third{0.0F};
    int material = 0;
  };
  /// Where a texel's pieces stand.
  struct Cover {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
  };
  /// Piece and texel that it may reach.
  struct Reach {
    std::uint32_t texel = 0;
    std::uint32_t piece = 0;
  };
  void add_object(std::uint32_t object, std::vector<Reach>& reaches);
  void add_reaches(std::uint32_t chart, const texel_atlas::TriangleMap& map,
                   std::vector<Reach>& reaches) const;
  void sort_reaches(std::vector<Reach>& reaches);

  const ray_tracing::RayScene& rays_;
  const texel_atlas::TexelAtlas& atlas_;
  std::vector<Piece> pieces_;
  std::vector<Cover> covers_;            ///< per texel
  std::vector<std::uint32_t> piece_of_;  ///< by `Cover`
};

}  // namespace renderers::ray_bundles
