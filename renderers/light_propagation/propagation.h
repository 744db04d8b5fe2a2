#pragma once

#include <cstddef>

#include "renderers/light_propagation/light_volume.h"

namespace renderers::light_propagation {

struct PropagationSettings {
  int steps = 64;
  bool has_clamp = false;  ///< negative face intensities count as 0, which makes light
};

/// What propagation gives.
struct Propagation {
  LightVolume sum;             ///< of all steps, the injected light included
  LightVolume last;            ///< what still travels
  std::size_t work_bytes = 0;  ///< what was needed besides these
};

/// Lets light travel from cell to cell: per step each cell takes from each of its six neighbours
/// what passes the five faces that it does not share with it, and sends it on through each face as
/// a cosine lobe.
///
/// Flux through a face: intensity towards the face's centre times the face's exact solid angle,
/// from the neighbour's centre: 0.4006696846 sr for the far face, 0.4234313545 sr for each of the
/// four at the side; all faces of all neighbours make 4 pi. So without blockers, and but for what
/// leaves the grid, power is kept exactly. Source: Kaplanyan and Dachsbacher 2010,
/// doi:10.1145/1730804.1730821, Sec. 4 (recalled). Differs from common copies of it: their
/// 0.4234413544 sr has a wrong digit.
///
/// @param blocking  from the second step on; null: none
Propagation propagate(const LightVolume& injected, const BlockingVolume* blocking,
                      const PropagationSettings& settings);

}  // namespace renderers::light_propagation
