#pragma once

#include <array>
#include <cstddef>

namespace renderers::light_propagation {

/// Faces through which light comes from one neighbour: the far one, then the four at the sides.
inline constexpr std::size_t kFacesOfWay = 5;

/// One way's part of one channel of a row of cells.
struct WayRow {
  float sign = 1.0F;
  float least = 0.0F;  ///< of what is sent through a face
  /// The neighbours' coefficients: even, along the way, across it twice.
  std::array<const float*, 4> from{};
  std::array<const float*, kFacesOfWay> shares{};
  std::array<float*, 4> to{};  ///< the cells' coefficients, in the same order
};

/// Flux by pi through each face, sent on as a cosine lobe about the face's normal, is added to the
/// cells' coefficients. Values that are not finite stay so.
/// @param count  of cells
void add_way(const WayRow& row, int count);

}  // namespace renderers::light_propagation
