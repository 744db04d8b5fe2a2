#include "renderers/final_gather/grid_anchors.h"

#include <algorithm>
#include <array>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "perception/base/parallel.h"

namespace renderers::final_gather {

namespace {

/// An anchor on its way, with its place.
struct Seen {
  Anchor anchor;
  glm::vec3 place{0.0F};
  bool is_lit = false;
};

std::vector<Seen> look(const element_hierarchy::ElementTree& tree, const CameraSamples& samples) {
  std::vector<std::size_t> first(samples.pixel_count() + 1, 0);
  for (std::size_t i = 0; i < samples.pixel_count(); ++i) {
    first[i + 1] = first[i] + static_cast<std::size_t>(samples.count(i));
  }
  std::vector<Seen> seen(first.back());
  base::parallel_for(samples.pixel_count(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      for (int i = 0; i < samples.count(pixel); ++i) {
        const ray_tracing::Ray ray = samples.ray(pixel, i);
        ray_tracing::Hit hit;
        if (!tree.rays().intersect(ray, hit)) continue;
        const std::uint32_t leaf = tree.leaf_at(hit, -ray.direction);
        if (leaf == element_hierarchy::kNoElement) continue;
        Seen& point = seen[first[pixel] + static_cast<std::size_t>(i)];
        point.anchor = {hit.object,
                        hit.triangle,
                        hit.barycentrics,
                        leaf,
                        static_cast<std::uint32_t>(pixel),
                        1.0F / static_cast<float>(samples.count(pixel)),
                        glm::dot(hit.geometric_normal, ray.direction) > 0.0F};
        point.place = hit.position;
        point.is_lit = true;
      }
    }
  });
  std::erase_if(seen, [](const Seen& point) { return !point.is_lit; });
  return seen;
}

constexpr double kRoom = 0.02;
constexpr double kLeastDepth_m = 1e-6;

GatherGrid grid_in_view(const std::vector<glm::vec3>& places, const RenderJob& job,
                        const GridAnchors::Settings& settings) {
  const glm::dvec3 forward(glm::normalize(job.camera.look_at - job.camera.position));
  double near_m = std::numeric_limits<double>::infinity();
  double far_m = 0.0;
  for (const glm::vec3& place : places) {
    const double depth_m = glm::dot(glm::dvec3(place) - glm::dvec3(job.camera.position), forward);
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

GatherGrid grid_in_world(const std::vector<glm::vec3>& places, const RenderJob& job,
                         const GridAnchors::Settings& settings) {
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high(-std::numeric_limits<double>::infinity());
  for (const glm::vec3& place : places) {
    low = glm::min(low, glm::dvec3(place));
    high = glm::max(high, glm::dvec3(place));
  }
  // A lone wall has an extent along its normal, too.
  const double least_m = std::max(kLeastDepth_m, kRoom * glm::length(high - low));
  const glm::dvec3 room = glm::max(0.5 * kRoom * (high - low), glm::dvec3(0.5 * least_m));
  return {job.camera, grid_size_for(high - low + 2.0 * room, settings.vertices), low - room,
          high + room, settings.blending};
}

}  // namespace

std::optional<GridAnchors> GridAnchors::make(const element_hierarchy::ElementTree& tree,
                                             const CameraSamples& samples, const RenderJob& job,
                                             const Settings& settings) {
  const std::vector<Seen> seen = look(tree, samples);
  if (seen.empty()) return std::nullopt;
  std::vector<Anchor> anchors;
  std::vector<glm::vec3> places;
  for (const Seen& point : seen) {
    anchors.push_back(point.anchor);
    places.push_back(point.place);
  }
  GridAnchors made(settings.space == GridSpace::world ? grid_in_world(places, job, settings)
                                                      : grid_in_view(places, job, settings));
  made.sort_into_cells(anchors, places);
  return made;
}

void GridAnchors::sort_into_cells(const std::vector<Anchor>& anchors,
                                  const std::vector<glm::vec3>& places) {
  std::vector<std::uint32_t> cells;
  std::vector<bool> is_touched(grid_.size().vertex_count(), false);
  first_.assign(grid_.size().cell_count() + 1, 0);
  for (const glm::vec3& place : places) {
    cells.push_back(grid_.cell_at(place));
    ++first_[cells.back() + 1];
    const GridBlend blend = grid_.blend(place);
    for (const std::uint32_t vertex : blend.used()) is_touched[vertex] = true;
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  anchors_.resize(anchors.size());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < anchors.size(); ++i) anchors_[next[cells[i]]++] = anchors[i];
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
