#include "renderers/texel_atlas/texel_atlas.h"

#include <algorithm>
#include <utility>

#include "perception/base/parallel.h"
#include "renderers/texel_atlas/texel_builder.h"

namespace renderers::texel_atlas {

namespace {

std::vector<ChartTexels> cut_all(const WorldTriangles& world, const ray_tracing::RayScene& rays,
                                 const std::vector<Chart>& charts, const ChartLayout& layout) {
  constexpr std::size_t kGrain = 16;
  std::vector<ChartTexels> cut(charts.size());
  base::parallel_for(charts.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      cut[i] = cut_chart(world, rays, charts[i], layout.places[i]);
    }
  });
  return cut;
}

/// Splits the charts that overlap. @return how many
std::size_t split_overlapping(const WorldTriangles& world, const std::vector<ChartTexels>& cut,
                              std::vector<Chart>& charts) {
  std::size_t count = 0;
  std::vector<Chart> kept;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    if (!cut[i].overlaps || charts[i].triangles.size() == 1) {
      kept.push_back(std::move(charts[i]));
      continue;
    }
    ++count;
    for (Chart& part : split_chart(world, charts[i])) kept.push_back(std::move(part));
  }
  charts = std::move(kept);
  return count;
}

std::vector<TriangleMap> map_triangles(const WorldTriangles& world,
                                       const std::vector<Chart>& charts,
                                       const ChartLayout& layout) {
  std::vector<TriangleMap> maps(world.triangles.size());
  for (std::uint32_t i = 0; i < charts.size(); ++i) {
    const ChartPlace& place = layout.places[i];
    for (const std::uint32_t triangle : charts[i].triangles) {
      const auto& corners = world.triangles[triangle].corners;
      const auto at = [&](std::size_t corner) {
        return charts[i].project(corners[corner]) * place.texels_per_m + glm::dvec2(place.corner);
      };
      maps[triangle] = {glm::vec2(at(0)), glm::vec2(at(1) - at(0)), glm::vec2(at(2) - at(0)), i};
    }
  }
  return maps;
}

}  // namespace

TexelAtlas::TexelAtlas(const ray_tracing::RayScene& rays, const AtlasSettings& settings,
                       StageTimer& timer) {
  const WorldTriangles world = world_triangles(rays.scene());
  std::vector<ChartTexels> cut;
  const LayoutSettings layout_settings{settings.side_px, settings.padding_px, settings.texels_per_m,
                                       rays.scene().name};
  {
    const auto stage = timer.stage("charts");
    charts_ = make_charts(world, settings.charts);
    layout_ = lay_out(charts_, layout_settings);
  }
  auto stage = timer.stage("texels");
  cut = cut_all(world, rays, charts_, layout_);
  split_charts_ = split_overlapping(world, cut, charts_);
  if (split_charts_ > 0) {
    layout_ = lay_out(charts_, layout_settings);
    cut = cut_all(world, rays, charts_, layout_);
  }

  // Charts one after the other: texels that lie side by side stay close in memory.
  grid_.assign(
      static_cast<std::size_t>(settings.side_px) * static_cast<std::size_t>(settings.side_px),
      kNoTexel);
  for (std::uint32_t i = 0; i < charts_.size(); ++i) {
    const ChartPlace& place = layout_.places[i];
    const auto first = static_cast<std::uint32_t>(texels_.size());
    first_texel_.push_back(cut[i].texels.empty() ? kNoTexel : first);
    for (Texel& texel : cut[i].texels) {
      texel.chart = i;
      texels_.push_back(texel);
    }
    for (std::size_t cell = 0; cell < cut[i].cells.size(); ++cell) {
      if (cut[i].cells[cell] == kNoTexel) continue;
      const std::size_t x = cell % static_cast<std::size_t>(place.size.x);
      const std::size_t y = cell / static_cast<std::size_t>(place.size.x);
      grid_[(static_cast<std::size_t>(place.corner.y) + y) *
                static_cast<std::size_t>(layout_.side_px) +
            static_cast<std::size_t>(place.corner.x) + x] = first + cut[i].cells[cell];
    }
  }
  maps_ = map_triangles(world, charts_, layout_);
  for (TriangleMap& map : maps_) {
    if (map.chart != kNoTexel && first_texel_[map.chart] == kNoTexel) map.chart = kNoTexel;
  }
  first_ = world.first;
  stage.add_bytes(memory_bytes());
}

glm::vec2 TexelAtlas::position(std::uint32_t object, std::uint32_t triangle,
                               const glm::vec2& barycentrics) const {
  const TriangleMap& map = maps_[first_[object] + triangle];
  return map.corner + barycentrics.x * map.along_u + barycentrics.y * map.along_v;
}

std::uint32_t TexelAtlas::texel_at(std::uint32_t object, std::uint32_t triangle,
                                   const glm::vec2& barycentrics) const {
  const std::uint32_t chart = chart_of(object, triangle);
  if (chart == kNoTexel) return kNoTexel;
  return texel_at_position(chart, position(object, triangle, barycentrics));
}

/// Rounding put a point across the border of a cell that its triangle does not reach.
std::uint32_t TexelAtlas::texel_beside(std::uint32_t chart, const glm::ivec2& cell) const {
  const ChartPlace& place = layout_.places[chart];
  const glm::ivec2 last = place.corner + place.size - 1;
  for (int y = std::max(place.corner.y, cell.y - 1); y <= std::min(last.y, cell.y + 1); ++y) {
    for (int x = std::max(place.corner.x, cell.x - 1); x <= std::min(last.x, cell.x + 1); ++x) {
      const std::uint32_t near = texel_in({x, y});
      if (near != kNoTexel) return near;
    }
  }
  return first_texel_[chart];
}

std::int64_t TexelAtlas::memory_bytes() const {
  return static_cast<std::int64_t>(texels_.size() * sizeof(Texel) +
                                   grid_.size() * sizeof(std::uint32_t) +
                                   maps_.size() * sizeof(TriangleMap));
}

}  // namespace renderers::texel_atlas
