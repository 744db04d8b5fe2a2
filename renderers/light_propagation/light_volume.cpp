#include "renderers/light_propagation/light_volume.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/light_propagation/intensity_lobe.h"

namespace renderers::light_propagation {

namespace {

constexpr std::size_t kCellGrain = 512;
/// Solid angles of the far face and of the other four of a neighbour, seen from a cell's middle;
/// with kFarFace_sr = 4 atan(1 / (3 sqrt(11))) those of all faces around six cells add up to 4 pi.
constexpr float kFarFace_sr = 0.4006696846F;
constexpr float kSideFace_sr = 0.4234313545F;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kRoot5 = 2.23606798F;

glm::ivec3 cell_of(const Grid& grid, std::size_t index) {
  const auto i = static_cast<int>(index);
  return {i % grid.size.x, i / grid.size.x % grid.size.y, i / (grid.size.x * grid.size.y)};
}

/// One face of the receiving cell: its normal is an axis with a sign.
struct Face {
  std::size_t axis = 0;
  float sign = 1.0F;
  glm::vec3 direction{0.0F};  ///< of light from the neighbour's centre to the face's, unit length
};

/// One of the six ways that light comes: along an axis, with a sign, through five faces, the far
/// one first.
struct Way {
  std::size_t axis = 0;
  float sign = 1.0F;
  glm::ivec3 step{0};  ///< from the neighbour to the cell
  std::array<Face, 5> faces{};
};

constexpr std::size_t kFaces = 30;

std::array<Way, 6> make_ways() {
  std::array<Way, 6> ways;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    Way& way = ways[i];
    way.axis = i / 2;
    way.sign = i % 2 == 0 ? 1.0F : -1.0F;
    way.step[static_cast<int>(way.axis)] = i % 2 == 0 ? 1 : -1;
    const glm::vec3 along(way.step);
    way.faces[0] = {way.axis, way.sign, along};
    std::size_t face = 1;
    for (std::size_t side = 0; side < 3; ++side) {
      if (side == way.axis) continue;
      for (const float sign : {1.0F, -1.0F}) {
        glm::vec3 centre = 2.0F * along;
        centre[static_cast<int>(side)] += sign;
        way.faces[face++] = {side, sign, glm::normalize(centre)};
      }
    }
  }
  return ways;
}

/// Shares of light that pass each face of each way into each cell.
std::vector<float> transmissions(const Grid& grid, const BlockingVolume& blocking) {
  const std::array<Way, 6> ways = make_ways();
  std::vector<float> shares(grid.cell_count() * kFaces);
  base::parallel_for(grid.cell_count(), kCellGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      std::size_t slot = cell * kFaces;
      for (const Way& way : ways) {
        for (const Face& face : way.faces) {
          shares[slot++] = blocking.transmission(cell_of(grid, cell), static_cast<int>(face.axis),
                                                 face.sign > 0.0F, face.direction);
        }
      }
    }
  });
  return shares;
}

class Step {
 public:
  /// @param shares  of `transmissions`, or null: all light passes
  Step(const LightVolume& from, const float* shares, bool has_clamp)
      : from_(from), shares_(shares), has_clamp_(has_clamp), ways_(make_ways()) {}

  CellLight gather(std::size_t index) const {
    const glm::ivec3 cell = cell_of(from_.grid, index);
    CellLight light{};
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      const glm::ivec3 neighbour = cell - ways_[i].step;
      if (!from_.grid.holds(neighbour)) continue;
      const CellLight& sent = from_.cells[from_.grid.index(neighbour)];
      if (sent == CellLight{}) continue;
      add(ways_[i], shares_ == nullptr ? nullptr : shares_ + index * kFaces + 5 * i, sent, light);
    }
    return light;
  }

 private:
  /// Flux by pi through each face, sent on as a cosine lobe about the face's normal.
  void add(const Way& way, const float* shares, const CellLight& from, CellLight& light) const {
    constexpr float kAlong = 2.0F / kRoot5;
    constexpr float kAcross = 1.0F / kRoot5;
    constexpr float kLobe0 = 0.88622693F;
    constexpr float kLobe1 = 1.02332671F;
    const glm::vec4 even = kY0 * from[0];
    const glm::vec4 along = (kY1 * way.sign) * from[1 + way.axis];
    for (std::size_t i = 0; i < way.faces.size(); ++i) {
      const Face& face = way.faces[i];
      glm::vec4 sent =
          i == 0 ? (kFarFace_sr / kPi) * (even + along)
                 : (kSideFace_sr / kPi) *
                       (even + kAlong * along + (kAcross * kY1 * face.sign) * from[1 + face.axis]);
      if (has_clamp_) sent = glm::max(sent, glm::vec4(0.0F));
      if (shares != nullptr) sent *= shares[i];
      light[0] += kLobe0 * sent;
      light[1 + face.axis] += (kLobe1 * face.sign) * sent;
    }
  }

  const LightVolume& from_;
  const float* shares_;
  bool has_clamp_;
  std::array<Way, 6> ways_;
};

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
  // A face's centre lies between its four corners.
  glm::vec4 sum(0.0F);
  for (int corner = 0; corner < 4; ++corner) {
    glm::ivec3 node = cell;
    node[axis] += is_greater ? 1 : 0;
    node[(axis + 1) % 3] += corner & 1;
    node[(axis + 2) % 3] += corner >> 1;
    sum += nodes_[node_index(node)];
  }
  return 1.0F - std::clamp(intensity(0.25F * sum, -direction), 0.0F, 1.0F);
}

Propagation propagate(const LightVolume& injected, const BlockingVolume* blocking,
                      const PropagationSettings& settings) {
  Propagation result{injected, injected};
  std::vector<float> shares;
  if (blocking != nullptr) shares = transmissions(injected.grid, *blocking);
  LightVolume next(injected.grid);
  for (int i = 0; i < settings.steps; ++i) {
    // The first step leaves the surfaces that sent the light.
    const bool is_blocked = i > 0 && blocking != nullptr;
    const Step step(result.last, is_blocked ? shares.data() : nullptr, settings.has_clamp);
    base::parallel_for(next.cells.size(), kCellGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t cell = begin; cell < end; ++cell) {
        next.cells[cell] = step.gather(cell);
        for (std::size_t k = 0; k < 4; ++k) result.sum.cells[cell][k] += next.cells[cell][k];
      }
    });
    std::swap(result.last, next);
  }
  return result;
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
    value[c] = std::max(0.0F, scaled / (cell_m * cell_m));
  }
  return value;
}

}  // namespace renderers::light_propagation
