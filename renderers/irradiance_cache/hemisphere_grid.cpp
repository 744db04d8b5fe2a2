#include "renderers/irradiance_cache/hemisphere_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::irradiance_cache {

namespace {

using indirect_view::ViewedPoint;
using ray_tracing::Frame3;
using ray_tracing::kPi;

/// What the ray of a cell found.
struct Cell {
  glm::vec3 radiance{0.0F};
  float distance_m = std::numeric_limits<float>::infinity();
  float tangent = 0.0F;  ///< of the ray's polar angle
};

/// Cells, row by row of equal polar angle.
class Grid {
 public:
  Grid(const GridSize& size, const Frame3& frame)
      : size_(size),
        frame_(frame),
        cells_(static_cast<std::size_t>(size.polar) * static_cast<std::size_t>(size.azimuth)) {}

  Cell& at(int polar, int azimuth) {
    const int k = (azimuth + size_.azimuth) % size_.azimuth;
    return cells_[static_cast<std::size_t>(polar * size_.azimuth + k)];
  }
  const std::vector<Cell>& cells() const { return cells_; }

  /// Unit vector in the plane, at an azimuth in cells.
  glm::vec3 outward(float azimuth) const {
    const float angle_rad = 2.0F * kPi * azimuth / static_cast<float>(size_.azimuth);
    return frame_.to_world({std::cos(angle_rad), std::sin(angle_rad), 0.0F});
  }
  /// The same a quarter turn further.
  glm::vec3 around(float azimuth) const {
    return outward(azimuth + 0.25F * static_cast<float>(size_.azimuth));
  }

  void add_rotation(IrradianceRecord& record);
  void add_translation(float least_m, IrradianceRecord& record);

 private:
  void add_wall(const Cell& to, const Cell& from, const glm::vec3& motion, float least_m,
                IrradianceRecord& record) const;

  GridSize size_;
  Frame3 frame_;
  std::vector<Cell> cells_;
};

/// pi / (M N) sum over k of v_k sum over j of tan theta_j L_jk.
void Grid::add_rotation(IrradianceRecord& record) {
  const float weight = kPi / static_cast<float>(cells_.size());
  for (int k = 0; k < size_.azimuth; ++k) {
    const glm::vec3 axis = around(static_cast<float>(k) + 0.5F);
    glm::vec3 sum(0.0F);
    for (int j = 0; j < size_.polar; ++j) sum += at(j, k).tangent * at(j, k).radiance;
    for (int c = 0; c < 3; ++c) {
      record.rotation[static_cast<std::size_t>(c)] += weight * sum[c] * axis;
    }
  }
}

/// What a cell gains over its neighbour as the wall between them moves, seen from the receiver.
/// @param motion  weighted solid angle by which the cell grows per metre at a distance of 1 m
void Grid::add_wall(const Cell& to, const Cell& from, const glm::vec3& motion, float least_m,
                    IrradianceRecord& record) const {
  const float nearer_m = std::max(least_m, std::min(to.distance_m, from.distance_m));
  if (!std::isfinite(nearer_m) || nearer_m <= 0.0F) return;
  const glm::vec3 step = (to.radiance - from.radiance) / nearer_m;
  for (int c = 0; c < 3; ++c) record.translation[static_cast<std::size_t>(c)] += step[c] * motion;
}

/// Walls between polar angles: 2 pi / N sin theta cos^2 theta; between azimuths: the difference of
/// sin theta over the cell.
void Grid::add_translation(float least_m, IrradianceRecord& record) {
  const auto rows = static_cast<float>(size_.polar);
  const float width_rad = 2.0F * kPi / static_cast<float>(size_.azimuth);
  for (int k = 0; k < size_.azimuth; ++k) {
    const glm::vec3 outwards = outward(static_cast<float>(k) + 0.5F);
    const glm::vec3 sideways = around(static_cast<float>(k));
    for (int j = 0; j < size_.polar; ++j) {
      const float sine2 = static_cast<float>(j) / rows;
      const float sine = std::sqrt(sine2);
      if (j > 0) {
        add_wall(at(j, k), at(j - 1, k), width_rad * sine * (1.0F - sine2) * outwards, least_m,
                 record);
      }
      const float rise = std::sqrt(static_cast<float>(j + 1) / rows) - sine;
      add_wall(at(j, k), at(j, k - 1), rise * sideways, least_m, record);
    }
  }
}

/// A record's radius, by the harmonic mean of the distances: count / sum of 1 / r.
void bound_radius(const std::vector<Cell>& cells, const SpacingBounds& bounds,
                  IrradianceRecord& record) {
  float nearness = 0.0F;
  for (const Cell& cell : cells) {
    nearness += 1.0F / std::max(cell.distance_m, 1e-3F * bounds.least_m);
  }
  float mean_m = nearness > 0.0F ? static_cast<float>(cells.size()) / nearness
                                 : std::numeric_limits<float>::infinity();
  if (bounds.by_gradient) {
    // The gradient of the luminance is the luminance of the gradients.
    const auto& g = record.translation;
    const float slope = glm::length(ray_tracing::luminance({1, 0, 0}) * g[0] +
                                    ray_tracing::luminance({0, 1, 0}) * g[1] +
                                    ray_tracing::luminance({0, 0, 1}) * g[2]);
    if (slope > 0.0F) mean_m = std::min(mean_m, ray_tracing::luminance(record.irradiance) / slope);
  }
  record.radius_m = std::clamp(mean_m, bounds.least_m, bounds.greatest_m);
  if (mean_m >= bounds.least_m) return;
  // Used further than the distances allow: the gradient counts for less in proportion.
  for (glm::vec3& gradient : record.translation) gradient *= mean_m / bounds.least_m;
}

}  // namespace

GridSize grid_size(int rays) {
  const auto count = static_cast<float>(rays);
  const int polar = std::max(2, static_cast<int>(std::lround(std::sqrt(count / kPi))));
  return {polar, std::max(3, rays / polar)};
}

IrradianceRecord sample_record(const ray_tracing::RayScene& rays, const ViewedPoint& point,
                               const GridSize& size, const SpacingBounds& bounds,
                               const indirect_view::RayRadiance& radiance, std::uint64_t& cast) {
  Grid grid(size, ray_tracing::frame_around(point.normal));
  const Frame3 frame = ray_tracing::frame_around(point.normal);
  ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::random, point.seed, point.index);
  IrradianceRecord record;
  record.position = point.surface.position;
  record.normal = point.normal;
  for (int j = 0; j < size.polar; ++j) {
    for (int k = 0; k < size.azimuth; ++k) {
      const glm::vec4 u = numbers.next();
      const glm::vec2 place(ray_tracing::in_stratum(j, u.x, size.polar),
                            ray_tracing::in_stratum(k, u.y, size.azimuth));
      const glm::vec3 direction =
          glm::normalize(frame.to_world(ray_tracing::cosine_hemisphere(place)));
      if (glm::dot(direction, point.geometric_normal) <= 0.0F) continue;
      ++cast;
      ray_tracing::Hit hit;
      if (!rays.intersect(ray_from(point.surface, direction), hit)) continue;
      const auto cell = static_cast<std::uint64_t>(j * size.azimuth + k);
      const std::uint64_t seed =
          ray_tracing::hash_combine(ray_tracing::hash_combine(point.seed, point.index + 1), cell);
      grid.at(j, k) = {radiance(indirect_view::viewed_point(hit, -direction, seed, 0), hit.t),
                       hit.t, std::sqrt(place.x / (1.0F - place.x))};
      record.irradiance += grid.at(j, k).radiance;
    }
  }
  record.irradiance *= kPi / static_cast<float>(grid.cells().size());
  grid.add_rotation(record);
  grid.add_translation(bounds.least_m, record);
  bound_radius(grid.cells(), bounds, record);
  return record;
}

}  // namespace renderers::irradiance_cache
