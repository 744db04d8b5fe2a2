#include "renderers/final_gather/grid_anchors.h"

#include <algorithm>
#include <array>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace renderers::final_gather {

namespace {

constexpr double kRoom = 0.02;
constexpr double kLeastDepth_m = 1e-6;

GatherGrid grid_in_view(const std::vector<Anchor>& anchors, const RenderJob& job,
                        const GridSettings& settings) {
  const glm::dvec3 forward(glm::normalize(job.camera.look_at - job.camera.position));
  double near_m = std::numeric_limits<double>::infinity();
  double far_m = 0.0;
  for (const Anchor& anchor : anchors) {
    const double depth_m =
        glm::dot(glm::dvec3(anchor.place) - glm::dvec3(job.camera.position), forward);
    near_m = std::min(near_m, depth_m);
    far_m = std::max(far_m, depth_m);
  }
  const std::array<double, 2> range{std::max(kLeastDepth_m, near_m * (1.0 - kRoom)),
                                    std::max(2.0 * kLeastDepth_m, far_m * (1.0 + kRoom))};
  const double aspect = static_cast<double>(job.width_px) / job.height_px;
  return {
      job.camera, aspect,           grid_size_for(job.width_px, job.height_px, settings.vertices),
      range,      settings.spacing, settings.blending};
}

GatherGrid grid_in_world(const std::vector<Anchor>& anchors, const RenderJob& job,
                         const GridSettings& settings) {
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high(-std::numeric_limits<double>::infinity());
  for (const Anchor& anchor : anchors) {
    low = glm::min(low, glm::dvec3(anchor.place));
    high = glm::max(high, glm::dvec3(anchor.place));
  }
  // A lone wall has an extent along its normal, too.
  const double least_m = std::max(kLeastDepth_m, kRoom * glm::length(high - low));
  const glm::dvec3 room = glm::max(0.5 * kRoom * (high - low), glm::dvec3(0.5 * least_m));
  return {job.camera, grid_size_for(high - low + 2.0 * room, settings.vertices), low - room,
          high + room, settings.blending};
}

}  // namespace

GatherGrid grid_around(const std::vector<Anchor>& anchors, const RenderJob& job,
                       const GridSettings& settings) {
  return settings.space == GridSpace::world ? grid_in_world(anchors, job, settings)
                                            : grid_in_view(anchors, job, settings);
}

GridAnchors::GridAnchors(const GatherGrid& grid, const std::vector<Anchor>& anchors,
                         const std::vector<bool>& is_in)
    : grid_(grid) {
  constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> cells(anchors.size(), kNoCell);
  std::vector<bool> is_touched(grid_.size().vertex_count(), false);
  first_.assign(grid_.size().cell_count() + 1, 0);
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (!is_in[i]) continue;
    cells[i] = grid_.cell_at(anchors[i].place);
    ++first_[cells[i] + 1];
    const GridBlend blend = grid_.blend(anchors[i].place);
    for (const std::uint32_t vertex : blend.used()) is_touched[vertex] = true;
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  anchors_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (cells[i] != kNoCell) anchors_[next[cells[i]]++] = anchors[i];
  }
  for (std::uint32_t i = 0; i < is_touched.size(); ++i) {
    if (is_touched[i]) touched_.push_back(i);
  }
}

std::vector<const Anchor*> GridAnchors::around(std::uint32_t vertex) const {
  std::vector<const Anchor*> found;
  const glm::ivec3 place = grid_.vertex_place(vertex);
  const GridSize& size = grid_.size();
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 cell = place - glm::ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
    const bool is_inside = cell.x >= 0 && cell.y >= 0 && cell.z >= 0 && cell.x < size.x &&
                           cell.y < size.y && cell.z < size.z;
    if (!is_inside) continue;
    for (const Anchor& anchor : in_cell(grid_.cell_index(cell))) found.push_back(&anchor);
  }
  return found;
}

}  // namespace renderers::final_gather
