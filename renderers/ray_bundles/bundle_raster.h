#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_bundles/bundle_frame.h"
#include "renderers/ray_bundles/bundle_lists.h"
#include "renderers/texel_atlas/texel_atlas.h"
#include "renderers/texel_atlas/world_triangles.h"

namespace renderers::ray_bundles {

/// Fills the lists by drawing the triangles: what the paper's k-buffer does, without its k.
///
/// Corners are rounded to 1/65536 pixel and compared in integers; a pixel's centre on an edge
/// belongs to the triangle on one side of it alone (the "top-left rule"), so that triangles with
/// common corners leave no gap and cover nothing twice. Fragments are counted first and then
/// written to their places: none is dropped.
///
/// Source: Pineda 1988, "A Parallel Algorithm for Polygon Rasterization",
/// doi:10.1145/378456.378457; Hermes et al. 2010, Sec. 4.2.
class BundleRaster {
 public:
  /// @param atlas  must live as long as this
  BundleRaster(const texel_atlas::WorldTriangles& world, const texel_atlas::TexelAtlas& atlas);

  /// The same lists for any number of threads.
  void fill(const BundleFrame& frame, BundleLists& lists);

 private:
  struct Source {
    std::array<glm::vec3, 3> corners{};
    texel_atlas::TriangleMap map;
  };
  /// What a triangle's fragments are, linear over the raster.
  struct Plane {
    glm::vec2 corner_px{0.0F};  ///< of the first vertex
    glm::vec2 depth_slope{0.0F};
    float depth_m = 0.0F;  ///< of the first vertex
    float least_depth_m = 0.0F;
    float greatest_depth_m = 0.0F;
    glm::vec2 place{0.0F};  ///< in the atlas, of the first vertex
    glm::vec2 place_dx{0.0F};
    glm::vec2 place_dy{0.0F};
    std::uint32_t chart = 0;
    std::uint32_t near_is_back = 0;
  };
  /// Pixels of a row that a triangle covers.
  struct Span {
    std::uint32_t plane = 0;
    int row = 0;
    int begin = 0;
    int end = 0;
  };
  /// A share of the triangles.
  struct Chunk {
    std::vector<Plane> planes;
    std::vector<std::vector<Span>> bands;
  };
  void draw(const BundleFrame& frame, std::size_t band_count, std::size_t index);
  struct Projection;
  void draw_triangle(const Projection& projection, const Source& source, Chunk& chunk) const;
  static Plane plane_of(const Projection& projection, const Source& source,
                        const std::array<glm::dvec2, 3>& places_px);
  void fill_band(const BundleFrame& frame, std::size_t index, BundleLists::Band& band) const;
  void write_span(const Span& span, const Plane& plane, std::uint32_t* next,
                  std::vector<ListNode>& nodes) const;

  const texel_atlas::TexelAtlas& atlas_;
  std::vector<Source> sources_;
  std::vector<Chunk> chunks_;
};

}  // namespace renderers::ray_bundles
