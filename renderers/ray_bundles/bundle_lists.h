#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "renderers/ray_bundles/bundle_frame.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/texel_atlas/texel_atlas.h"

namespace renderers::ray_bundles {

/// Where a line crosses a surface.
struct ListNode {
  float depth_m = 0.0F;  ///< from the plane of the origins
  /// The texel's side that looks back along the line (`texel_atlas::side_index`); the other side,
  /// which looks on, is this with the lowest bit turned over.
  std::uint32_t near_side = 0;
};

/// The side of a node that looks on along the direction.
constexpr std::uint32_t far_side(const ListNode& node) { return node.near_side ^ 1U; }
constexpr std::uint32_t texel_of(const ListNode& node) { return node.near_side >> 1U; }

/// Orders the crossings of one line by depth and takes out duplicates.
///
/// Within `tie_m` of each other the depths of two coincident triangles back to back say nothing: of
/// the two the one whose front looks back comes first, so that nothing is exchanged between them.
/// Of neighbours in the list that are of one object and look the same way (a line through a shared
/// edge) the first stays.
/// @param texels  of the atlas
/// @return how many are left, at the beginning
std::size_t order_nodes(std::span<ListNode> nodes, float tie_m,
                        std::span<const texel_atlas::Texel> texels);

/// Depths of a bundle closer than this are a tie: a few roundings of a distance of 2 R.
float tie_distance_m(const BundleFrame& frame);

/// All crossings of a bundle's lines, in order along each line.
///
/// Lines are kept in bands of rows: what several threads make does not move afterwards. Reused for
/// the next bundle, it keeps its memory.
class BundleLists {
 public:
  static constexpr int kBandRows = 4;

  /// Crossings of the line through a pixel.
  std::span<const ListNode> line(int x, int y) const;
  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  std::size_t band_count() const { return bands_used_; }
  std::size_t node_count() const;

  struct Band {
    std::vector<std::uint32_t> ends;           ///< per line, index after its last node
    std::vector<ListNode> nodes;               ///< line after line
    std::vector<ray_tracing::LineHit> packet;  ///< of the packet being traced
  };
  const Band& band(std::size_t index) const { return bands_[index]; }
  /// Empty bands for a frame.
  void reset(const BundleFrame& frame);
  Band& band(std::size_t index) { return bands_[index]; }

 private:
  int width_px_ = 0;
  int height_px_ = 0;
  std::size_t bands_used_ = 0;
  std::vector<Band> bands_;
};

/// Fills the lists by tracing the lines. @param rays  with RayQueries::all_hits
void trace_lists(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
                 const BundleFrame& frame, BundleLists& lists);

}  // namespace renderers::ray_bundles
