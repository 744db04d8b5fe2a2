#pragma once

#include <glm/vec3.hpp>

namespace renderers::photon_map {

/// A packet of light where it met a surface.
struct Photon {
  glm::vec3 position{0.0F};
  glm::vec3 power{0.0F};      ///< W; of stored irradiances W/m2
  glm::vec3 direction{0.0F};  ///< unit length, of flight
  glm::vec3 normal{0.0F};     ///< unit length, geometric, on the side that was met
};

}  // namespace renderers::photon_map
