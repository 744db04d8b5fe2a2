#pragma once

#include <array>
#include <cstddef>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/element_hierarchy/element.h"

namespace renderers::final_gather {

/// The part of a patch above a point's horizon, in weights of the patch's second and third corner.
class VisiblePart {
 public:
  /// @param normal  of the point, unit length
  VisiblePart(const element_hierarchy::Element& patch, const glm::vec3& point,
              const glm::vec3& normal);

  /// Share of the patch's area, [0, 1].
  double share() const { return share_; }
  /// A point uniform by area; only if `share() > 0`. Points of one plane that a patch is cut by
  /// get the same positions. @param u  in [0, 1)^2
  glm::vec2 sample(glm::vec2 u) const;

 private:
  double triangle_share(std::size_t last) const;

  std::array<glm::dvec2, 4> corners_{};
  std::size_t count_ = 0;
  double share_ = 0.0;
  double first_share_ = 0.0;  ///< of the first triangle of two
};

}  // namespace renderers::final_gather
