#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "renderers/contract/stage_timer.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/context.h"
#include "renderers/opengl/program.h"
#include "renderers/ray_bundles/bundle_frame.h"
#include "renderers/ray_bundles/bundle_lists.h"
#include "renderers/ray_bundles/bundle_raster.h"
#include "renderers/ray_bundles/device_needs.h"
#include "renderers/ray_bundles/gpu_line_tracer.h"
#include "renderers/ray_bundles/gpu_prefix_sum.h"
#include "renderers/texel_atlas/texel_atlas.h"
#include "renderers/texel_atlas/world_triangles.h"

namespace renderers::ray_bundles {

/// The lists of a bundle by the device's rasteriser: those of `BundleRaster` but where the centre
/// of a pixel lies within its rounding of corners (1/256 pixel) of an edge; or by rays on the
/// device: those of `trace_lists` but where depths of a triangle seen nearly from the side round
/// apart.
///
/// Crossings are counted, their lists' places summed up, and then drawn into them; or drawn into a
/// k-buffer. Instead of drawing, lines may be traced. A thread per line puts them in order. What
/// does not fit the device's storage blocks is made in rows; lists never cross them, and no
/// crossing is ever left out unasked.
///
/// Source: Hermes et al. 2010, Sec. 4.2. Counting first instead of slots: Vasilakis and Fudos 2012,
/// "S-buffer: Sparsity-aware Multi-fragment Rendering", Eurographics short papers, recalled.
class GpuBundleLists {
 public:
  /// @param atlas             must live as long as this
  /// @param most_block_bytes  of a storage block; 0: the device's
  /// @throws UnsupportedError if triangles or atlas are too many for a storage block
  GpuBundleLists(std::shared_ptr<opengl::Context> context, const texel_atlas::WorldTriangles& world,
                 const texel_atlas::TexelAtlas& atlas, std::int64_t most_block_bytes = 0);

  /// Bytes of the largest storage block that a scene takes whatever its lines are, boxes of
  /// `use_rays` included. @param triangles  of the scene
  static std::int64_t scene_block_bytes(std::size_t triangles,
                                        const texel_atlas::TexelAtlas& atlas);

  /// From here on, lines of counted lists are traced. Stages `bvh` and `upload` under whatever
  /// stage is open. @param world, atlas  those of the constructor
  /// @throws UnsupportedError if the boxes around the triangles are too many for a storage block
  GpuLineTracer& use_rays(const texel_atlas::WorldTriangles& world,
                          const texel_atlas::TexelAtlas& atlas, StageTimer& timer);

  /// Counts first, then fills. Stages `draw` (`trace` by rays), `order`, `copy` under whatever
  /// stage is open.
  /// @return passes: times the geometry was drawn or traced for the rows that took most
  /// @throws UnsupportedError if one row's crossings do not fit a storage block, or if a line has
  ///   too many for a software driver to order; DeviceError if the device draws the same triangles
  ///   differently the second time
  SlotCounts fill(const BundleFrame& frame, BundleLists& lists, StageTimer& timer);

  /// By a k-buffer, as `BundleRaster::fill_slots`, whose counts it has. Not with rays.
  SlotCounts fill_slots(const BundleFrame& frame, const SlotSettings& settings, BundleLists& lists,
                        StageTimer& timer);

  /// Lists that stay on the device, by `fill` or with slots by `fill_slots`. Stages `draw`
  /// (`trace` by rays), `order`.
  /// @param slots  null: counted first
  /// @throws UnsupportedError if they do not fit a storage block at once
  SlotCounts keep(const BundleFrame& frame, const SlotSettings* slots, StageTimer& timer);
  /// Kept nodes, from each line's start on: as many as its count says. Lines row by row.
  const opengl::Buffer& nodes() const { return nodes_; }
  const opengl::Buffer& starts() const { return starts_; }
  const opengl::Buffer& counts() const { return counts_; }
  std::uint32_t crossings() const { return crossings_; }  ///< duplicates included

  std::int64_t memory_bytes() const;

 private:
  void require(const DeviceNeeds& needs) const;
  void require_block(const std::string& what, std::size_t count, std::size_t element_bytes) const;
  void begin_frame(const BundleFrame& frame);
  int rows_that_fit(const BundleFrame& frame, std::int64_t line_bytes) const;
  /// Draws all triangles into the rows.
  void draw(opengl::Program& program, const BundleFrame& frame, const LineRows& rows);
  /// Makes the words of rows' lists; nothing if they do not fit.
  using DrawRows = std::function<std::optional<SlotCounts>(const LineRows&)>;
  SlotCounts fill_rows(const BundleFrame& frame, std::int64_t line_bytes, BundleLists& lists,
                       StageTimer& timer, const DrawRows& draw, bool is_counted);
  void count_crossings(const BundleFrame& frame, const LineRows& rows);
  void fill_words(const BundleFrame& frame, const LineRows& rows);
  const char* finding_stage() const { return tracer_ ? "trace" : "draw"; }
  std::optional<SlotCounts> draw_counted(const BundleFrame& frame, const LineRows& rows);
  std::optional<SlotCounts> draw_slots(const BundleFrame& frame, const SlotSettings& settings,
                                       const LineRows& rows);
  void take_slots(std::uint32_t lines, const SlotSettings& settings, std::uint32_t pass);
  bool can_hold(const BundleFrame& frame, const LineRows& rows, const CountTotals& totals) const;
  bool place_lists(const BundleFrame& frame, const LineRows& rows, const CountTotals& totals);
  void order(const BundleFrame& frame, const LineRows& rows, bool is_counted);
  void copy(const BundleFrame& frame, const LineRows& rows, BundleLists& lists) const;
  opengl::Program& fragment_program(const std::string& pass, opengl::Defines defines = {});

  std::shared_ptr<opengl::Context> context_;
  std::int64_t most_block_bytes_;
  int triangle_count_ = 0;
  int atlas_side_px_ = 0;
  std::uint32_t crossings_ = 0;  ///< of the rows at hand
  opengl::Buffer triangles_;
  opengl::Buffer cells_;
  opengl::Buffer texels_;
  opengl::Buffer planes_;
  opengl::Buffer counts_;
  opengl::Buffer starts_;
  opengl::Buffer words_;
  opengl::Buffer nodes_;
  opengl::Buffer slots_;
  opengl::Buffer first_words_;
  opengl::Buffer faults_;  ///< lines that were counted and filled differently; not in order
  GpuPrefixSum prefix_sum_;
  std::unique_ptr<GpuLineTracer> tracer_;  ///< null: triangles are drawn
};

}  // namespace renderers::ray_bundles
