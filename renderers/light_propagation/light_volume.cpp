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
constexpr float kFarFace_sr = 0.4006696846F;
constexpr float kSideFace_sr = 0.4234313545F;
constexpr float kPi = std::numbers::pi_v<float>;

/// One face of the receiving cell as its neighbour sees it.
struct Face {
  glm::vec3 direction{0.0F};  ///< from the neighbour's centre
  glm::vec4 weight{0.0F};     ///< intensity coefficients to flux by pi
  glm::vec4 lobe{0.0F};       ///< that is sent on
  int axis = 0;               ///< of the face's normal
  bool is_greater = false;    ///< on the cell's side with the greater coordinate
};

/// The six ways light comes from, each with five faces.
struct Way {
  glm::ivec3 step{0};  ///< from the neighbour to the cell
  std::array<Face, 5> faces{};
};

Face make_face(const glm::vec3& to_centre, float solid_angle_sr, int axis, bool is_greater) {
  Face face;
  face.direction = glm::normalize(to_centre);
  face.weight = basis(face.direction) * (solid_angle_sr / kPi);
  glm::vec3 normal(0.0F);
  normal[axis] = is_greater ? 1.0F : -1.0F;
  face.lobe = cosine_lobe(normal);
  face.axis = axis;
  face.is_greater = is_greater;
  return face;
}

std::array<Way, 6> make_ways() {
  std::array<Way, 6> ways;
  for (int i = 0; i < 6; ++i) {
    const int axis = i / 2;
    Way& way = ways[static_cast<std::size_t>(i)];
    way.step[axis] = i % 2 == 0 ? 1 : -1;
    const glm::vec3 along(way.step);
    way.faces[0] = make_face(along, kFarFace_sr, axis, way.step[axis] > 0);
    std::size_t face = 1;
    for (int side = 0; side < 3; ++side) {
      if (side == axis) continue;
      for (const float sign : {1.0F, -1.0F}) {
        glm::vec3 centre = 2.0F * along;
        centre[side] += sign;
        way.faces[face++] = make_face(centre, kSideFace_sr, side, sign > 0.0F);
      }
    }
  }
  return ways;
}

glm::ivec3 cell_of(const Grid& grid, std::size_t index) {
  const auto i = static_cast<int>(index);
  return {i % grid.size.x, i / grid.size.x % grid.size.y, i / (grid.size.x * grid.size.y)};
}

class Step {
 public:
  Step(const LightVolume& from, const BlockingVolume* blocking, bool has_clamp)
      : from_(from), blocking_(blocking), has_clamp_(has_clamp), ways_(make_ways()) {}

  CellLight gather(const glm::ivec3& cell) const {
    CellLight light{};
    for (const Way& way : ways_) {
      const glm::ivec3 neighbour = cell - way.step;
      if (from_.grid.holds(neighbour))
        add(way, cell, from_.cells[from_.grid.index(neighbour)], light);
    }
    return light;
  }

 private:
  void add(const Way& way, const glm::ivec3& cell, const CellLight& from, CellLight& light) const {
    for (const Face& face : way.faces) {
      const float passed =
          blocking_ == nullptr
              ? 1.0F
              : blocking_->transmission(cell, face.axis, face.is_greater, face.direction);
      for (std::size_t c = 0; c < 3; ++c) {
        float flux_by_pi = passed * glm::dot(face.weight, from[c]);
        if (has_clamp_) flux_by_pi = std::max(0.0F, flux_by_pi);
        light[c] += flux_by_pi * face.lobe;
      }
    }
  }

  const LightVolume& from_;
  const BlockingVolume* blocking_;
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
      sum[c] += static_cast<double>(light_propagation::flux(cell[static_cast<std::size_t>(c)]));
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
    for (std::size_t c = 0; c < 3; ++c) light[c] += weight * cell[c];
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
  LightVolume next(injected.grid);
  for (int i = 0; i < settings.steps; ++i) {
    // The first step leaves the surfaces that sent the light.
    const Step step(result.last, i == 0 ? nullptr : blocking, settings.has_clamp);
    base::parallel_for(next.cells.size(), kCellGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t cell = begin; cell < end; ++cell) {
        next.cells[cell] = step.gather(cell_of(next.grid, cell));
        for (std::size_t c = 0; c < 3; ++c) result.sum.cells[cell][c] += next.cells[cell][c];
      }
    });
    std::swap(result.last, next);
  }
  return result;
}

glm::vec3 irradiance(const LightVolume& volume, const glm::vec3& position, const glm::vec3& normal,
                     Lookup lookup) {
  constexpr float kFaceSolidAngle_sr = 2.0F * kPi / 3.0F;
  constexpr float kFaceCosine_sr = 1.7408F;
  const float cell_m = volume.grid.cell_m;
  const CellLight light = volume.at(position + 0.5F * cell_m * normal);
  glm::vec3 value(0.0F);
  for (int c = 0; c < 3; ++c) {
    const glm::vec4& lobe = light[static_cast<std::size_t>(c)];
    const float towards = -kY1 * glm::dot(glm::vec3(lobe.y, lobe.z, lobe.w), normal);
    const float scaled = lookup == Lookup::half_cell
                             ? 4.0F * (kY0 * lobe.x + towards)
                             : kFaceSolidAngle_sr * kY0 * lobe.x + kFaceCosine_sr * towards;
    value[c] = std::max(0.0F, scaled / (cell_m * cell_m));
  }
  return value;
}

}  // namespace renderers::light_propagation
