#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "renderers/scene/scene.h"

namespace renderers::light_propagation {

/// A grid of cubic cells around a box, with a margin of one cell.
struct Grid {
  glm::ivec3 size{0};
  glm::vec3 corner{0.0F};  ///< of the first cell, m
  float cell_m = 1.0F;

  std::size_t cell_count() const {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
           static_cast<std::size_t>(size.z);
  }
  bool holds(const glm::ivec3& cell) const {
    return cell.x >= 0 && cell.y >= 0 && cell.z >= 0 && cell.x < size.x && cell.y < size.y &&
           cell.z < size.z;
  }
  std::size_t index(const glm::ivec3& cell) const {
    return (static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(size.y) +
            static_cast<std::size_t>(cell.y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(cell.x);
  }
  /// The cell of an index.
  glm::ivec3 cell(std::size_t index) const {
    const auto i = static_cast<int>(index);
    return {i % size.x, i / size.x % size.y, i / (size.x * size.y)};
  }
  /// The cell that a point lies in, moved into the grid.
  glm::ivec3 cell_at(const glm::vec3& point) const;
};

/// @param cells  along the longest side, margins included; >= 4
Grid grid_around(const scene::Box& box, int cells);

/// Intensity of a cell, W/sr: per coefficient of intensity_lobe.h the values of R, G and B; the
/// fourth numbers stay 0.
using CellLight = std::array<glm::vec4, 4>;

/// Adds a lobe, the same in all channels but for a factor.
inline void add_lobe(CellLight& cell, const glm::vec4& lobe, const glm::vec3& factor) {
  for (int i = 0; i < 4; ++i) {
    cell[static_cast<std::size_t>(i)] += lobe[i] * glm::vec4(factor, 0.0F);
  }
}

/// One channel's coefficients.
inline glm::vec4 channel_of(const CellLight& cell, int channel) {
  return {cell[0][channel], cell[1][channel], cell[2][channel], cell[3][channel]};
}

/// Intensity in all cells.
struct LightVolume {
  explicit LightVolume(const Grid& of) : grid(of), cells(of.cell_count(), CellLight{}) {}
  Grid grid;
  std::vector<CellLight> cells;

  /// Sum of the cells' flux, W.
  glm::dvec3 flux() const;
  /// Trilinear between the cells' centres; ends at the outermost ones.
  CellLight at(const glm::vec3& point) const;
};

/// What surfaces take away from light, on nodes at the corners of cells.
///
/// A node's blocking towards w is the sum of A max(0, -n . w) over the surface parts nearest to
/// it, by a cell's face: the share of the face that they hide from light along w.
/// Source: Kaplanyan and Dachsbacher 2010, "Cascaded Light Propagation Volumes for Real-Time
/// Indirect Illumination", doi:10.1145/1730804.1730821 (geometry volume, half a cell off;
/// recalled).
class BlockingVolume {
 public:
  explicit BlockingVolume(const Grid& grid);
  /// @param normal  mean one of the surface's blocking side: of unit length if it is flat
  void add(const glm::vec3& position, const glm::vec3& normal, float area_m2);
  /// Share of light along a direction that passes a face of a cell, in [0, 1].
  /// @param axis, is_greater  which face
  float transmission(const glm::ivec3& cell, int axis, bool is_greater,
                     const glm::vec3& direction) const;
  /// The same of a row of cells along x, from a first one on.
  void transmissions(const glm::ivec3& first, int axis, bool is_greater, const glm::vec3& direction,
                     std::span<float> shares) const;

 private:
  std::size_t node_index(const glm::ivec3& node) const;

  Grid grid_;
  std::vector<glm::vec4> nodes_;
};

/// How irradiance is read from a cell's intensity.
enum class Lookup {
  face_flux,  ///< what passes a cell's face against the normal, by the face
  half_cell   ///< intensity from half a cell away: 4 I / s^2
};

/// Irradiance of a surface, W/m2, not below 0. The volume is read half a cell in front of it.
///
/// `face_flux`: with I(w) = a + d . w the flux towards -n through the face of a cell, seen from its
/// centre under 2 pi / 3 sr, is (2 pi / 3) a - 1.7408 d . n; by the face's area s^2. 1.7408 is the
/// integral of the cosine over that solid angle.
/// @param normal  unit length, on the side that is lit
glm::vec3 irradiance(const LightVolume& volume, const glm::vec3& position, const glm::vec3& normal,
                     Lookup lookup);

}  // namespace renderers::light_propagation
