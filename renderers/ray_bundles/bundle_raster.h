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

/// A k-buffer: slots per line that fragments fill in the order of drawing.
struct SlotSettings {
  int slots = 8;               ///< k
  bool until_complete = true;  ///< draws again for the next k fragments until no line has more
};

/// What a k-buffer came to.
struct SlotCounts {
  std::uint64_t passes = 0;   ///< times the geometry was drawn
  std::uint64_t dropped = 0;  ///< fragments that found no slot; they are missing from the lists
};

/// Fills the lists by drawing the triangles, without a bound on their lengths or as the paper does.
///
/// Corners are rounded to 1/65536 pixel and compared in integers; a pixel's centre on an edge
/// belongs to the triangle on one side of it alone (the "top-left rule"), so that triangles with
/// common corners leave no gap and cover nothing twice.
///
/// Source: Pineda 1988, "A Parallel Algorithm for Polygon Rasterization",
/// doi:10.1145/378456.378457; Hermes et al. 2010, Sec. 4.2.
class BundleRaster {
 public:
  /// @param atlas  must live as long as this
  BundleRaster(const texel_atlas::WorldTriangles& world, const texel_atlas::TexelAtlas& atlas);

  /// Fragments are counted first and then written to their places: none is dropped. The same lists
  /// for any number of threads.
  void fill(const BundleFrame& frame, BundleLists& lists);

  /// By a k-buffer (Hermes et al. 2010, Sec. 4.2): the first k fragments of a line stay, whichever
  /// they are, and pass p of a capture in several passes keeps those from p k on. The same lists as
  /// `fill` where nothing is dropped.
  SlotCounts fill_slots(const BundleFrame& frame, const SlotSettings& settings, BundleLists& lists);

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
  void draw_all(const BundleFrame& frame, std::size_t band_count);
  void draw(const BundleFrame& frame, std::size_t band_count, std::size_t index);
  struct Projection;
  void draw_triangle(const Projection& projection, const Source& source, Chunk& chunk) const;
  static Plane plane_of(const Projection& projection, const Source& source,
                        const std::array<glm::dvec2, 3>& places_px);
  void fill_band(const BundleFrame& frame, std::size_t index, BundleLists::Band& band) const;
  /// Slots of a band's lines in one pass after the other: [pass][line][slot].
  struct SlotBand {
    std::vector<std::uint32_t> fragments;  ///< per line, of the whole geometry
    std::vector<std::vector<ListNode>> passes;
  };
  void capture(const BundleFrame& frame, std::size_t index, std::uint32_t pass,
               std::uint32_t slots);
  std::uint64_t join_slots(const BundleFrame& frame, std::size_t index, std::uint32_t slots,
                           BundleLists::Band& band) const;
  /// Where a fragment of a span lies. @param column  of the raster
  ListNode node_of(const Span& span, const Plane& plane, int column) const;
  void order_lines(const BundleFrame& frame, const std::vector<std::uint32_t>& ends,
                   BundleLists::Band& band) const;

  const texel_atlas::TexelAtlas& atlas_;
  std::vector<Source> sources_;
  std::vector<Chunk> chunks_;
  std::vector<SlotBand> slot_bands_;
};

}  // namespace renderers::ray_bundles
