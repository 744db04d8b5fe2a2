#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/final_gather/camera_samples.h"

namespace renderers::final_gather {

/// A surface point that a camera ray meets.
struct Anchor {
  glm::vec3 place{0.0F};
  glm::vec3 towards{0.0F};  ///< to the camera
  std::uint32_t object = 0;
  std::uint32_t triangle = 0;
  glm::vec2 barycentrics{0.0F};
  std::uint32_t leaf = 0;
  std::uint32_t pixel = 0;
  float weight = 1.0F;  ///< share of its pixel
  bool is_back = false;
};

/// All points that the camera sees on sides that light reaches, in the order of pixels and rays.
std::vector<Anchor> camera_anchors(const element_hierarchy::ElementTree& tree,
                                   const CameraSamples& samples);

}  // namespace renderers::final_gather
