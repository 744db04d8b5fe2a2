#include "renderers/ray_bundles/bundle_lists.h"

#include <algorithm>
#include <array>
#include <utility>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"

namespace renderers::ray_bundles {

namespace {

using ray_tracing::kPacketRays;
using ray_tracing::LineHit;
using texel_atlas::Texel;

bool comes_before(const ListNode& a, const ListNode& b) {
  if (a.depth_m != b.depth_m) return a.depth_m < b.depth_m;
  return a.near_side < b.near_side;
}

/// Lists are short: insertion until a length where it no longer pays.
void sort_by_depth(std::span<ListNode> nodes) {
  constexpr std::size_t kMostInserted = 24;
  if (nodes.size() > kMostInserted) {
    std::sort(nodes.begin(), nodes.end(), comes_before);
    return;
  }
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const ListNode moved = nodes[i];
    std::size_t place = i;
    for (; place > 0 && comes_before(moved, nodes[place - 1]); --place) {
      nodes[place] = nodes[place - 1];
    }
    nodes[place] = moved;
  }
}

bool looks_on(const ListNode& node) { return (node.near_side & 1U) != 0; }

/// True if two triangles at one place are the two sides of a sheet. Where a line cuts a corner of a
/// body it crosses two triangles at once as well, but those are not parallel.
bool are_back_to_back(const Texel& a, const Texel& b) {
  constexpr float kParallel = -0.99999F;
  return glm::dot(a.point.geometric_normal, b.point.geometric_normal) < kParallel;
}

/// Orders a run of ties and drops its duplicates. @return how many are left
std::size_t order_ties(std::span<ListNode> run, std::span<const Texel> texels) {
  for (std::size_t i = 1; i < run.size(); ++i) {
    for (std::size_t j = i;
         j > 0 && looks_on(run[j - 1]) && !looks_on(run[j]) &&
         are_back_to_back(texels[texel_of(run[j - 1])], texels[texel_of(run[j])]);
         --j) {
      std::swap(run[j - 1], run[j]);
    }
  }
  const auto is_duplicate = [&](const ListNode& a, const ListNode& b) {
    return looks_on(a) == looks_on(b) &&
           texels[texel_of(a)].point.object == texels[texel_of(b)].point.object;
  };
  const auto end = std::unique(run.begin(), run.end(), is_duplicate);
  return static_cast<std::size_t>(end - run.begin());
}

void add_line(std::span<const LineHit> hits, const texel_atlas::TexelAtlas& atlas, float tie_m,
              BundleLists::Band& band) {
  const std::size_t begin = band.nodes.size();
  for (const LineHit& hit : hits) {
    const std::uint32_t texel = atlas.texel_at(hit.object, hit.triangle, hit.barycentrics);
    if (texel == texel_atlas::kNoTexel) continue;
    const auto near_side = hit.looks_back ? texel_atlas::Side::front : texel_atlas::Side::back;
    band.nodes.push_back({hit.t, texel_atlas::side_index(texel, near_side)});
  }
  const std::span<ListNode> added(band.nodes.data() + begin, band.nodes.size() - begin);
  band.nodes.resize(begin + order_nodes(added, tie_m, atlas.texels()));
  band.ends.push_back(static_cast<std::uint32_t>(band.nodes.size()));
}

/// Traces a packet of lines of one row and appends their lists.
void add_packet(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
                std::span<const ray_tracing::Ray> lines, float tie_m, BundleLists::Band& band) {
  band.packet.clear();
  rays.all_hits(lines, band.packet);
  // A counting sort by line.
  std::array<std::uint32_t, kPacketRays + 1> ends{};
  for (const LineHit& hit : band.packet) ++ends[hit.ray + 1];
  for (std::size_t i = 0; i < kPacketRays; ++i) ends[i + 1] += ends[i];
  std::array<std::uint32_t, kPacketRays> next{};
  std::copy_n(ends.begin(), kPacketRays, next.begin());
  thread_local std::vector<LineHit> sorted;
  sorted.resize(band.packet.size());
  for (const LineHit& hit : band.packet) sorted[next[hit.ray]++] = hit;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    add_line({sorted.data() + ends[i], sorted.data() + ends[i + 1]}, atlas, tie_m, band);
  }
}

}  // namespace

std::size_t order_nodes(std::span<ListNode> nodes, float tie_m, std::span<const Texel> texels) {
  sort_by_depth(nodes);
  std::size_t kept = 0;
  for (std::size_t begin = 0; begin < nodes.size();) {
    std::size_t end = begin + 1;
    while (end < nodes.size() && nodes[end].depth_m - nodes[end - 1].depth_m < tie_m) ++end;
    std::size_t count = 1;
    if (end - begin > 1) count = order_ties(nodes.subspan(begin, end - begin), texels);
    for (std::size_t i = 0; i < count; ++i) nodes[kept++] = nodes[begin + i];
    begin = end;
  }
  return kept;
}

float tie_distance_m(const BundleFrame& frame) {
  constexpr int kRoundings = 16;
  return ray_tracing::rounding_bound(kRoundings) * 2.0F * frame.sphere_radius_m;
}

std::span<const ListNode> BundleLists::line(int x, int y) const {
  const Band& band = bands_[static_cast<std::size_t>(y / kBandRows)];
  const auto index = static_cast<std::size_t>(y % kBandRows) * static_cast<std::size_t>(width_px_) +
                     static_cast<std::size_t>(x);
  const std::size_t begin = index == 0 ? 0 : band.ends[index - 1];
  return {band.nodes.data() + begin, band.nodes.data() + band.ends[index]};
}

std::size_t BundleLists::node_count() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < bands_used_; ++i) count += bands_[i].nodes.size();
  return count;
}

void BundleLists::reset(const BundleFrame& frame) {
  width_px_ = frame.width_px;
  height_px_ = frame.height_px;
  bands_used_ = static_cast<std::size_t>((height_px_ + kBandRows - 1) / kBandRows);
  if (bands_.size() < bands_used_) bands_.resize(bands_used_);
  for (Band& band : bands_) {
    band.ends.clear();
    band.nodes.clear();
  }
}

void trace_lists(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
                 const BundleFrame& frame, BundleLists& lists) {
  lists.reset(frame);
  const float tie_m = tie_distance_m(frame);
  const auto trace_band = [&](std::size_t index) {
    BundleLists::Band& band = lists.band(index);
    const int first_row = static_cast<int>(index) * BundleLists::kBandRows;
    const int end_row = std::min(frame.height_px, first_row + BundleLists::kBandRows);
    std::array<ray_tracing::Ray, kPacketRays> lines;
    for (int y = first_row; y < end_row; ++y) {
      for (int x = 0; x < frame.width_px;) {
        std::size_t count = 0;
        for (; count < kPacketRays && x < frame.width_px; ++x) lines[count++] = frame.line(x, y);
        add_packet(rays, atlas, {lines.data(), count}, tie_m, band);
      }
    }
  };
  base::parallel_for(lists.band_count(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band) trace_band(band);
  });
}

}  // namespace renderers::ray_bundles
