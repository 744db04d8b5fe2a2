#include "renderers/final_gather/perspective_grid.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace renderers::final_gather {

namespace {

/// Barycentric weights of a point in a unit cell whose even corners are 000, 110, 101 and 011.
/// @param corners  receives offsets of the tetrahedron's corners
std::array<double, 4> weights_in_cell(const glm::dvec3& p, std::array<glm::ivec3, 4>& corners) {
  const double x = p.x;
  const double y = p.y;
  const double z = p.z;
  if (x - y - z >= 0.0) {
    corners = {{{1, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 0, 0}}};
    return {x - y - z, y, z, 1.0 - x};
  }
  if (y - x - z >= 0.0) {
    corners = {{{0, 1, 0}, {1, 1, 0}, {0, 1, 1}, {0, 0, 0}}};
    return {y - x - z, x, z, 1.0 - y};
  }
  if (z - x - y >= 0.0) {
    corners = {{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 0}}};
    return {z - x - y, x, y, 1.0 - z};
  }
  if (x + y + z >= 2.0) {
    corners = {{{1, 1, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}}};
    return {x + y + z - 2.0, 1.0 - x, 1.0 - y, 1.0 - z};
  }
  corners = {{{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}}};
  return {0.5 * (2.0 - x - y - z), 0.5 * (x + y - z), 0.5 * (x + z - y), 0.5 * (y + z - x)};
}

}  // namespace

GridSize grid_size_for(int width_px, int height_px, int vertices) {
  const double aspect = static_cast<double>(width_px) / height_px;
  // x y z with z = sqrt(x y): x y = vertices^(2/3).
  const double face = std::cbrt(static_cast<double>(vertices) * static_cast<double>(vertices));
  const auto whole = [](double value) { return std::max(1, static_cast<int>(std::lround(value))); };
  return {whole(std::sqrt(face * aspect)), whole(std::sqrt(face / aspect)), whole(std::sqrt(face))};
}

PerspectiveGrid::PerspectiveGrid(const scene::Camera& camera, double aspect, const GridSize& size,
                                 const std::array<double, 2>& near_far_m, DepthSpacing spacing)
    : position_(camera.position),
      forward_(glm::normalize(camera.look_at - camera.position)),
      right_(glm::normalize(glm::cross(forward_, camera.up))),
      up_(glm::cross(right_, forward_)),
      half_width_(0.0),
      half_height_(std::tan(0.5 * glm::radians(static_cast<double>(camera.vertical_fov_deg)))),
      size_(size),
      near_m_(near_far_m[0]),
      far_m_(near_far_m[1]),
      spacing_(spacing) {
  half_width_ = aspect * half_height_;
}

double PerspectiveGrid::view_depth_m(const glm::vec3& point) const {
  return glm::dot(glm::dvec3(point) - glm::dvec3(position_), glm::dvec3(forward_));
}

glm::dvec3 PerspectiveGrid::to_grid(const glm::vec3& point) const {
  const glm::dvec3 offset = glm::dvec3(point) - glm::dvec3(position_);
  const double depth_m = view_depth_m(point);
  const double x = glm::dot(offset, glm::dvec3(right_)) / (depth_m * half_width_);
  const double y = -glm::dot(offset, glm::dvec3(up_)) / (depth_m * half_height_);
  const double z = spacing_ == DepthSpacing::reciprocal
                       ? (1.0 / near_m_ - 1.0 / depth_m) / (1.0 / near_m_ - 1.0 / far_m_)
                       : std::log(depth_m / near_m_) / std::log(far_m_ / near_m_);
  return {0.5 * (x + 1.0) * size_.x, 0.5 * (y + 1.0) * size_.y, z * size_.z};
}

glm::vec3 PerspectiveGrid::to_world(const glm::dvec3& grid) const {
  const double share = grid.z / size_.z;
  const double depth_m = spacing_ == DepthSpacing::reciprocal
                             ? 1.0 / ((1.0 - share) / near_m_ + share / far_m_)
                             : near_m_ * std::pow(far_m_ / near_m_, share);
  const double x = (2.0 * grid.x / size_.x - 1.0) * half_width_;
  const double y = (1.0 - 2.0 * grid.y / size_.y) * half_height_;
  return glm::vec3(glm::dvec3(position_) +
                   depth_m * (glm::dvec3(forward_) + x * glm::dvec3(right_) + y * glm::dvec3(up_)));
}

std::uint32_t PerspectiveGrid::cell_index(const glm::ivec3& cell) const {
  return static_cast<std::uint32_t>((cell.z * size_.y + cell.y) * size_.x + cell.x);
}

std::uint32_t PerspectiveGrid::cell_at(const glm::vec3& point) const {
  const glm::ivec3 most(size_.x - 1, size_.y - 1, size_.z - 1);
  return cell_index(glm::clamp(glm::ivec3(glm::floor(to_grid(point))), glm::ivec3(0), most));
}

glm::ivec3 PerspectiveGrid::vertex_place(std::uint32_t index) const {
  const auto i = static_cast<int>(index);
  const int row = size_.x + 1;
  const int slice = row * (size_.y + 1);
  return {i % row, i % slice / row, i / slice};
}

std::uint32_t PerspectiveGrid::vertex_index(const glm::ivec3& place) const {
  return static_cast<std::uint32_t>((place.z * (size_.y + 1) + place.y) * (size_.x + 1) + place.x);
}

GridBlend PerspectiveGrid::blend(const glm::vec3& point, bool by_parity) const {
  const glm::dvec3 grid = to_grid(point);
  const glm::ivec3 most(size_.x - 1, size_.y - 1, size_.z - 1);
  const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(grid)), glm::ivec3(0), most);
  glm::dvec3 local = glm::clamp(grid - glm::dvec3(cell), glm::dvec3(0.0), glm::dvec3(1.0));
  const bool is_mirrored = by_parity && (cell.x + cell.y + cell.z) % 2 != 0;
  if (is_mirrored) local.x = 1.0 - local.x;
  std::array<glm::ivec3, 4> corners;
  std::array<double, 4> weights = weights_in_cell(local, corners);
  GridBlend blend;
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (is_mirrored) corners[i].x = 1 - corners[i].x;
    blend.vertices[i] = vertex_index(cell + corners[i]);
    // Weights are linear after the perspective; divided by depth they are so in world space.
    weights[i] = std::max(0.0, weights[i]) / view_depth_m(vertex(blend.vertices[i]));
    sum += weights[i];
  }
  for (std::size_t i = 0; i < 4; ++i) blend.weights[i] = static_cast<float>(weights[i] / sum);
  return blend;
}

}  // namespace renderers::final_gather
