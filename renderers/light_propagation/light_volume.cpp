#include "renderers/light_propagation/light_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "renderers/light_propagation/intensity_lobe.h"

namespace renderers::light_propagation {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace

glm::ivec3 Grid::cell_at(const glm::vec3& point) const {
  const glm::ivec3 cell(glm::floor((point - corner) / cell_m));
  return glm::clamp(cell, glm::ivec3(0), size - 1);
}

Grid grid_around(const scene::Box& box, int cells) {
  const glm::vec3 extent = box.greatest - box.least;
  const float longest = std::max({extent.x, extent.y, extent.z});
  Grid grid;
  grid.cell_m = longest > 0.0F ? longest / static_cast<float>(cells - 2) : 1.0F;
  for (int axis = 0; axis < 3; ++axis) {
    // A side of a whole number of cells must not get another one for its rounding.
    const float inner = std::ceil(extent[axis] / grid.cell_m - 1e-3F);
    grid.size[axis] = static_cast<int>(std::max(1.0F, inner)) + 2;
  }
  grid.corner = 0.5F * (box.least + box.greatest) - 0.5F * grid.cell_m * glm::vec3(grid.size);
  return grid;
}

glm::dvec3 LightVolume::flux() const {
  glm::dvec3 sum(0.0);
  for (const CellLight& cell : cells) {
    for (int c = 0; c < 3; ++c) {
      sum[c] += static_cast<double>(light_propagation::flux(channel_of(cell, c)));
    }
  }
  return sum;
}

CellLight LightVolume::at(const glm::vec3& point) const {
  const glm::vec3 place = (point - grid.corner) / grid.cell_m - 0.5F;
  const glm::vec3 bounded = glm::clamp(place, glm::vec3(0.0F), glm::vec3(grid.size - 1));
  const glm::ivec3 low(glm::floor(bounded));
  const glm::vec3 share = bounded - glm::vec3(low);
  CellLight light{};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 step(corner & 1, (corner >> 1) & 1, corner >> 2);
    const glm::vec3 weights = glm::mix(1.0F - share, share, glm::vec3(step));
    const float weight = weights.x * weights.y * weights.z;
    if (weight <= 0.0F) continue;
    const CellLight& cell = cells[grid.index(glm::min(low + step, grid.size - 1))];
    for (std::size_t i = 0; i < light.size(); ++i) light[i] += weight * cell[i];
  }
  return light;
}

BlockingVolume::BlockingVolume(const Grid& grid) : grid_(grid) {
  const glm::ivec3 nodes = grid.size + 1;
  nodes_.resize(static_cast<std::size_t>(nodes.x) * static_cast<std::size_t>(nodes.y) *
                    static_cast<std::size_t>(nodes.z),
                glm::vec4(0.0F));
}

std::size_t BlockingVolume::node_index(const glm::ivec3& node) const {
  return (static_cast<std::size_t>(node.z) * static_cast<std::size_t>(grid_.size.y + 1) +
          static_cast<std::size_t>(node.y)) *
             static_cast<std::size_t>(grid_.size.x + 1) +
         static_cast<std::size_t>(node.x);
}

void BlockingVolume::add(const glm::vec3& position, const glm::vec3& normal, float area_m2) {
  const glm::vec3 place = (position - grid_.corner) / grid_.cell_m;
  const glm::ivec3 node =
      glm::clamp(glm::ivec3(glm::floor(place + 0.5F)), glm::ivec3(0), grid_.size);
  nodes_[node_index(node)] += (area_m2 / (grid_.cell_m * grid_.cell_m)) * cosine_lobe(normal);
}

float BlockingVolume::transmission(const glm::ivec3& cell, int axis, bool is_greater,
                                   const glm::vec3& direction) const {
  float share = 0.0F;
  transmissions(cell, axis, is_greater, direction, {&share, 1});
  return share;
}

void BlockingVolume::transmissions(const glm::ivec3& first, int axis, bool is_greater,
                                   const glm::vec3& direction, std::span<float> shares) const {
  // A face's centre lies between its four corners.
  std::array<const glm::vec4*, 4> corners{};
  for (int corner = 0; corner < 4; ++corner) {
    glm::ivec3 node = first;
    node[axis] += is_greater ? 1 : 0;
    node[(axis + 1) % 3] += corner & 1;
    node[(axis + 2) % 3] += corner >> 1;
    corners[static_cast<std::size_t>(corner)] = &nodes_[node_index(node)];
  }
  const glm::vec4 towards = 0.25F * basis(-direction);
  for (std::size_t x = 0; x < shares.size(); ++x) {
    const glm::vec4 sum = (corners[0][x] + corners[1][x]) + (corners[2][x] + corners[3][x]);
    shares[x] = 1.0F - std::clamp(glm::dot(sum, towards), 0.0F, 1.0F);
  }
}

glm::vec3 irradiance(const LightVolume& volume, const glm::vec3& position, const glm::vec3& normal,
                     Lookup lookup) {
  constexpr float kFaceSolidAngle_sr = 2.0F * kPi / 3.0F;
  // Integrals of 1 and of the cosine over the directions through a cell's face, from its middle.
  constexpr float kFaceCosine_sr = 1.7408F;
  const float cell_m = volume.grid.cell_m;
  const CellLight light = volume.at(position + 0.5F * cell_m * normal);
  glm::vec3 value(0.0F);
  for (int c = 0; c < 3; ++c) {
    const glm::vec4 lobe = channel_of(light, c);
    const float towards = -kY1 * glm::dot(glm::vec3(lobe.y, lobe.z, lobe.w), normal);
    const float scaled = lookup == Lookup::half_cell
                             ? 4.0F * (kY0 * lobe.x + towards)
                             : kFaceSolidAngle_sr * kY0 * lobe.x + kFaceCosine_sr * towards;
    value[c] = scaled < 0.0F ? 0.0F : scaled / (cell_m * cell_m);
  }
  return value;
}

}  // namespace renderers::light_propagation
