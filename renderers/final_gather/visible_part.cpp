#include "renderers/final_gather/visible_part.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"

namespace renderers::final_gather {

VisiblePart::VisiblePart(const element_hierarchy::Element& patch, const glm::vec3& point,
                         const glm::vec3& normal) {
  constexpr std::array<glm::dvec2, 3> kCorners{{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}};
  std::array<double, 3> height{};
  for (std::size_t i = 0; i < 3; ++i) {
    height[i] = glm::dot(glm::dvec3(patch.positions[i]) - glm::dvec3(point), glm::dvec3(normal));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    if (height[i] >= 0.0) corners_[count_++] = kCorners[i];
    if ((height[i] > 0.0 && height[next] < 0.0) || (height[i] < 0.0 && height[next] > 0.0)) {
      const double along = height[i] / (height[i] - height[next]);
      corners_[count_++] = kCorners[i] + along * (kCorners[next] - kCorners[i]);
    }
  }
  if (count_ < 3) return;
  first_share_ = triangle_share(2);
  share_ = first_share_ + (count_ == 4 ? triangle_share(3) : 0.0);
}

/// Area of the fan's triangle that ends at a corner; that of the patch is 1/2 in these coordinates.
double VisiblePart::triangle_share(std::size_t last) const {
  const glm::dvec2 a = corners_[last - 1] - corners_[0];
  const glm::dvec2 b = corners_[last] - corners_[0];
  return std::fabs(a.x * b.y - a.y * b.x);
}

glm::vec2 VisiblePart::sample(glm::vec2 u) const {
  std::size_t last = 2;
  const double split = first_share_ / share_;
  const auto x = static_cast<double>(u.x);
  if (x >= split) {
    last = count_ - 1;
    u.x = static_cast<float>((x - split) / std::max(1e-30, 1.0 - split));
  } else {
    u.x = static_cast<float>(x / split);
  }
  const glm::vec2 weights = ray_tracing::uniform_triangle(glm::min(u, glm::vec2(0x1.fffffep-1F)));
  const glm::dvec2 place = corners_[0] +
                           static_cast<double>(weights.x) * (corners_[last - 1] - corners_[0]) +
                           static_cast<double>(weights.y) * (corners_[last] - corners_[0]);
  return glm::vec2(place);
}

}  // namespace renderers::final_gather
