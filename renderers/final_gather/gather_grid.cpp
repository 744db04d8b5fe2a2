#include "renderers/final_gather/gather_grid.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace renderers::final_gather {

namespace {

/// Corners of a unit cell, as offsets, and a point's weights.
struct CellWeights {
  std::array<glm::ivec3, 8> corners;
  std::array<double, 8> weights;
  std::size_t count;
};

CellWeights four(const std::array<glm::ivec3, 4>& corners, const std::array<double, 4>& weights) {
  CellWeights made{{}, {}, corners.size()};
  std::ranges::copy(corners, made.corners.begin());
  std::ranges::copy(weights, made.weights.begin());
  return made;
}

/// Barycentric weights of a point in a cell whose even corners are 000, 110, 101 and 011.
CellWeights tetrahedron_weights(const glm::dvec3& p) {
  const double x = p.x;
  const double y = p.y;
  const double z = p.z;
  if (x - y - z >= 0.0) {
    return four({{{1, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 0, 0}}}, {x - y - z, y, z, 1.0 - x});
  }
  if (y - x - z >= 0.0) {
    return four({{{0, 1, 0}, {1, 1, 0}, {0, 1, 1}, {0, 0, 0}}}, {y - x - z, x, z, 1.0 - y});
  }
  if (z - x - y >= 0.0) {
    return four({{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 0}}}, {z - x - y, x, y, 1.0 - z});
  }
  if (x + y + z >= 2.0) {
    return four({{{1, 1, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}}},
                {x + y + z - 2.0, 1.0 - x, 1.0 - y, 1.0 - z});
  }
  return four({{{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}}},
              {0.5 * (2.0 - x - y - z), 0.5 * (x + y - z), 0.5 * (x + z - y), 0.5 * (y + z - x)});
}

CellWeights trilinear_weights(const glm::dvec3& p) {
  CellWeights made{{}, {}, 8};
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 corner(i & 1, (i >> 1) & 1, i >> 2);
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis) weight *= corner[axis] == 1 ? p[axis] : 1.0 - p[axis];
    made.corners[static_cast<std::size_t>(i)] = corner;
    made.weights[static_cast<std::size_t>(i)] = weight;
  }
  return made;
}

}  // namespace

GridSize grid_size_for(int width_px, int height_px, int vertices) {
  const double aspect = static_cast<double>(width_px) / height_px;
  // x y z with z = sqrt(x y): x y = vertices^(2/3).
  const double face = std::cbrt(static_cast<double>(vertices) * static_cast<double>(vertices));
  const auto whole = [](double value) { return std::max(1, static_cast<int>(std::lround(value))); };
  return {whole(std::sqrt(face * aspect)), whole(std::sqrt(face / aspect)), whole(std::sqrt(face))};
}

GridSize grid_size_for(const glm::dvec3& extent_m, int vertices) {
  const double edge_m = std::cbrt(extent_m.x * extent_m.y * extent_m.z / vertices);
  const auto cells = [&](double extent) {
    constexpr double kMost = 4096.0;  // of a box that is nearly flat
    return static_cast<int>(std::lround(std::clamp(extent / edge_m, 1.0, kMost)));
  };
  return {cells(extent_m.x), cells(extent_m.y), cells(extent_m.z)};
}

GatherGrid::GatherGrid(const scene::Camera& camera, double aspect, const GridSize& size,
                       const std::array<double, 2>& near_far_m, DepthSpacing spacing,
                       GridBlending blending)
    : position_(camera.position),
      forward_(glm::normalize(camera.look_at - camera.position)),
      right_(glm::normalize(glm::cross(forward_, camera.up))),
      up_(glm::cross(right_, forward_)),
      half_width_(0.0),
      half_height_(std::tan(0.5 * glm::radians(static_cast<double>(camera.vertical_fov_deg)))),
      size_(size),
      space_(GridSpace::perspective),
      blending_(blending),
      near_m_(near_far_m[0]),
      far_m_(near_far_m[1]),
      spacing_(spacing) {
  half_width_ = aspect * half_height_;
}

GatherGrid::GatherGrid(const scene::Camera& camera, const GridSize& size, const glm::dvec3& low,
                       const glm::dvec3& high, GridBlending blending)
    : GatherGrid(camera, 1.0, size, {1.0, 2.0}, DepthSpacing::reciprocal, blending) {
  space_ = GridSpace::world;
  low_ = low;
  extent_ = high - low;
}

double GatherGrid::view_depth_m(const glm::vec3& point) const {
  return glm::dot(glm::dvec3(point) - glm::dvec3(position_), glm::dvec3(forward_));
}

double GatherGrid::cell_width_m(const glm::vec3& point) const {
  if (space_ == GridSpace::world) return extent_.x / size_.x;
  return 2.0 * half_width_ * view_depth_m(point) / size_.x;
}

glm::dvec3 GatherGrid::to_grid(const glm::vec3& point) const {
  if (space_ == GridSpace::world) {
    return (glm::dvec3(point) - low_) / extent_ * glm::dvec3(size_.x, size_.y, size_.z);
  }
  const glm::dvec3 offset = glm::dvec3(point) - glm::dvec3(position_);
  const double depth_m = view_depth_m(point);
  const double x = glm::dot(offset, glm::dvec3(right_)) / (depth_m * half_width_);
  const double y = -glm::dot(offset, glm::dvec3(up_)) / (depth_m * half_height_);
  const double z = spacing_ == DepthSpacing::reciprocal
                       ? (1.0 / near_m_ - 1.0 / depth_m) / (1.0 / near_m_ - 1.0 / far_m_)
                       : std::log(depth_m / near_m_) / std::log(far_m_ / near_m_);
  return {0.5 * (x + 1.0) * size_.x, 0.5 * (y + 1.0) * size_.y, z * size_.z};
}

glm::vec3 GatherGrid::to_world(const glm::dvec3& grid) const {
  if (space_ == GridSpace::world) {
    return glm::vec3(low_ + extent_ * grid / glm::dvec3(size_.x, size_.y, size_.z));
  }
  const double share = grid.z / size_.z;
  const double depth_m = spacing_ == DepthSpacing::reciprocal
                             ? 1.0 / ((1.0 - share) / near_m_ + share / far_m_)
                             : near_m_ * std::pow(far_m_ / near_m_, share);
  const double x = (2.0 * grid.x / size_.x - 1.0) * half_width_;
  const double y = (1.0 - 2.0 * grid.y / size_.y) * half_height_;
  return glm::vec3(glm::dvec3(position_) +
                   depth_m * (glm::dvec3(forward_) + x * glm::dvec3(right_) + y * glm::dvec3(up_)));
}

std::uint32_t GatherGrid::cell_index(const glm::ivec3& cell) const {
  return static_cast<std::uint32_t>((cell.z * size_.y + cell.y) * size_.x + cell.x);
}

std::uint32_t GatherGrid::cell_at(const glm::vec3& point) const {
  const glm::ivec3 most(size_.x - 1, size_.y - 1, size_.z - 1);
  return cell_index(glm::clamp(glm::ivec3(glm::floor(to_grid(point))), glm::ivec3(0), most));
}

glm::ivec3 GatherGrid::vertex_place(std::uint32_t index) const {
  const auto i = static_cast<int>(index);
  const int row = size_.x + 1;
  const int slice = row * (size_.y + 1);
  return {i % row, i % slice / row, i / slice};
}

std::uint32_t GatherGrid::vertex_index(const glm::ivec3& place) const {
  return static_cast<std::uint32_t>((place.z * (size_.y + 1) + place.y) * (size_.x + 1) + place.x);
}

GridBlend GatherGrid::blend(const glm::vec3& point, bool by_parity) const {
  const glm::dvec3 grid = to_grid(point);
  const glm::ivec3 most(size_.x - 1, size_.y - 1, size_.z - 1);
  const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(grid)), glm::ivec3(0), most);
  glm::dvec3 local = glm::clamp(grid - glm::dvec3(cell), glm::dvec3(0.0), glm::dvec3(1.0));
  const bool is_trilinear = blending_ == GridBlending::trilinear;
  const bool is_mirrored = by_parity && !is_trilinear && (cell.x + cell.y + cell.z) % 2 != 0;
  if (is_mirrored) local.x = 1.0 - local.x;
  CellWeights cell_weights = is_trilinear ? trilinear_weights(local) : tetrahedron_weights(local);
  GridBlend blend;
  blend.count = cell_weights.count;
  double sum = 0.0;
  for (std::size_t i = 0; i < blend.count; ++i) {
    glm::ivec3 corner = cell_weights.corners[i];
    if (is_mirrored) corner.x = 1 - corner.x;
    blend.vertices[i] = vertex_index(cell + corner);
    double& weight = cell_weights.weights[i];
    weight = std::max(0.0, weight);
    // Weights are linear after the perspective; divided by depth they are so in world space.
    if (space_ == GridSpace::perspective) weight /= view_depth_m(vertex(blend.vertices[i]));
    sum += weight;
  }
  for (std::size_t i = 0; i < blend.count; ++i) {
    blend.weights[i] = static_cast<float>(cell_weights.weights[i] / sum);
  }
  return blend;
}

}  // namespace renderers::final_gather
