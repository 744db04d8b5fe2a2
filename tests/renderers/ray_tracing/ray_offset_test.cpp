#include "renderers/ray_tracing/ray_offset.h"

#include <gtest/gtest.h>

namespace renderers::ray_tracing {
namespace {

TEST(NextFloat, IsTheStandardsOfFiniteNumbers) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kMost = std::numeric_limits<float>::max();
  for (const float magnitude :
       {0.0F, 1e-45F, 1.2e-38F, 0.5F, 0.99999994F, 1.0F, 3.7F, 2.0F, 16777216.0F, 1e30F, kMost}) {
    for (const float value : {magnitude, -magnitude}) {
      EXPECT_EQ(next_float(value, true), std::nextafter(value, kInfinity)) << value;
      EXPECT_EQ(next_float(value, false), std::nextafter(value, -kInfinity)) << value;
    }
  }
}

TEST(OffsetFromSurface, LeavesToTheSideOfTheDirectionBeyondTheError) {
  const glm::vec3 position(3.0F, -2.0F, 0.0F);
  const glm::vec3 error(1e-6F, 2e-6F, 1e-6F);
  const glm::vec3 normal = glm::normalize(glm::vec3(1.0F, 2.0F, -0.5F));
  for (const float side : {1.0F, -1.0F}) {
    const glm::vec3 moved = offset_from_surface(position, error, normal, side * normal);
    EXPECT_GE(side * glm::dot(glm::dvec3(normal), glm::dvec3(moved) - glm::dvec3(position)),
              glm::dot(glm::dvec3(glm::abs(normal)), glm::dvec3(error)));
  }
}

}  // namespace
}  // namespace renderers::ray_tracing
