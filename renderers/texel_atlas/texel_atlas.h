#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/texel_atlas/chart_layout.h"
#include "renderers/texel_atlas/charts.h"

/// The surfaces of a scene cut into texels: charts of triangles, packed into a square.
///
/// The scene's surfaces reflect on both sides (scene::Material), so every texel has two: `Side`.
/// Quantities per side stand at `side_index`.
namespace renderers::texel_atlas {

inline constexpr std::uint32_t kNoTexel = 0xffffffffU;

enum class Side : std::uint32_t { front, back };

/// Place of a texel's side in arrays over all sides of all texels.
constexpr std::uint32_t side_index(std::uint32_t texel, Side side) {
  return 2 * texel + static_cast<std::uint32_t>(side);
}

/// A piece of surface.
struct Texel {
  ray_tracing::SurfacePoint point;  ///< at the piece's centroid, inside one of its triangles
  float area_m2 = 0.0F;             ///< exact: of all parts of triangles in the texel
  glm::vec3 albedo{0.0F};           ///< mean over the piece
  glm::vec3 emission{0.0F};         ///< mean radiance over the piece, of its front
  std::uint32_t chart = 0;          ///< index into TexelAtlas::charts()
  glm::ivec2 cell{0};               ///< in the atlas
};

struct AtlasSettings {
  ChartSettings charts;
  int side_px = 512;
  int padding_px = 2;
  double texels_per_m = 0.0;  ///< least density; 0: the most that fits
};

/// Which texel a point of a triangle lies in, from barycentrics to cells of the atlas.
struct TriangleMap {
  glm::vec2 corner{0.0F};          ///< of the first vertex, texels
  glm::vec2 along_u{0.0F};         ///< from the first to the second vertex, texels
  glm::vec2 along_v{0.0F};         ///< from the first to the third vertex, texels
  std::uint32_t chart = kNoTexel;  ///< kNoTexel: degenerate, no texels
};

/// Immutable; may be read from any number of threads.
class TexelAtlas {
 public:
  /// Stages `charts` and `texels` under whatever stage is open.
  /// @param rays  of the scene; not needed afterwards
  /// @throws base::InputError if the scene does not fit
  TexelAtlas(const ray_tracing::RayScene& rays, const AtlasSettings& settings, StageTimer& timer);

  const std::vector<Texel>& texels() const { return texels_; }
  const std::vector<Chart>& charts() const { return charts_; }
  const ChartLayout& layout() const { return layout_; }
  /// Charts whose projection overlapped itself and that became a chart per triangle.
  std::size_t split_charts() const { return split_charts_; }

  /// Position of a surface point in the atlas, texels.
  glm::vec2 position(std::uint32_t object, std::uint32_t triangle,
                     const glm::vec2& barycentrics) const;
  std::uint32_t chart_of(std::uint32_t object, std::uint32_t triangle) const {
    return maps_[first_[object] + triangle].chart;
  }
  const TriangleMap& map_of(std::uint32_t object, std::uint32_t triangle) const {
    return maps_[first_[object] + triangle];
  }
  /// The texel at a position inside a chart, or near it where rounding has put it outside.
  std::uint32_t texel_at_position(std::uint32_t chart, const glm::vec2& position) const {
    const ChartPlace& place = layout_.places[chart];
    const glm::ivec2 cell(
        glm::clamp(position, glm::vec2(place.corner), glm::vec2(place.corner + place.size - 1)));
    const std::uint32_t texel = texel_in(cell);
    return texel != kNoTexel ? texel : texel_beside(chart, cell);
  }
  /// The texel of a surface point; kNoTexel on degenerate triangles alone.
  std::uint32_t texel_at(std::uint32_t object, std::uint32_t triangle,
                         const glm::vec2& barycentrics) const;
  /// The texel whose piece covers a cell, or kNoTexel. Small pieces belong to a neighbour's texel.
  std::uint32_t texel_in(const glm::ivec2& cell) const {
    return grid_[static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(layout_.side_px) +
                 static_cast<std::size_t>(cell.x)];
  }
  std::int64_t memory_bytes() const;

 private:
  std::uint32_t texel_beside(std::uint32_t chart, const glm::ivec2& cell) const;

  std::vector<Chart> charts_;
  ChartLayout layout_;
  std::size_t split_charts_ = 0;
  std::vector<Texel> texels_;
  std::vector<std::uint32_t> grid_;         ///< side x side, index of a texel or kNoTexel
  std::vector<TriangleMap> maps_;           ///< per triangle of the scene
  std::vector<std::uint32_t> first_texel_;  ///< per chart
  std::vector<std::size_t> first_;          ///< per object, its first triangle in `maps_`
};

}  // namespace renderers::texel_atlas
