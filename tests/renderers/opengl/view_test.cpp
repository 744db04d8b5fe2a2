#include "renderers/opengl/view.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

namespace renderers::opengl {
namespace {

constexpr int kWidth_px = 37;
constexpr int kHeight_px = 23;

scene::Camera test_camera() { return {{1.0F, 2.0F, -3.0F}, {0.5F, -1.0F, 4.0F}, {0.1F, 1, 0}, 47}; }

/// The documented direction of a pixel's ray.
glm::vec3 direction_through(const View& view, float px, float py) {
  const float x = view.center.x + (2.0F * px / kWidth_px - 1.0F) * view.half_width;
  const float y = view.center.y - (2.0F * py / kHeight_px - 1.0F) * view.half_height;
  return view.forward + x * view.right + y * view.up;
}

/// Pixel that the matrix moves a point to, and its depth.
glm::vec3 pixel_of(const glm::mat4& clip_from_world, const glm::vec3& point) {
  const glm::vec4 clip = clip_from_world * glm::vec4(point, 1.0F);
  const glm::vec3 device = glm::vec3(clip) / clip.w;
  return {0.5F * (device.x + 1.0F) * kWidth_px, 0.5F * (device.y + 1.0F) * kHeight_px, device.z};
}

TEST(View, OfACameraLooksAlongItsRays) {
  const glm::vec2 offset_px(0.25F, -0.4F);
  const View plain = camera_view(test_camera(), kWidth_px, kHeight_px);
  const View moved = camera_view(test_camera(), kWidth_px, kHeight_px, offset_px);
  for (int y = 0; y < kHeight_px; ++y) {
    for (int x = 0; x < kWidth_px; ++x) {
      const float px = static_cast<float>(x) + 0.5F;
      const float py = static_cast<float>(y) + 0.5F;
      const auto ray = [&](float at_x, float at_y) {
        return scene::camera_ray_direction(test_camera(), kWidth_px, kHeight_px, at_x, at_y);
      };
      const glm::vec3 direction = glm::normalize(direction_through(plain, px, py));
      EXPECT_LT(glm::length(direction - ray(px, py)), 5e-7F);
      const glm::vec3 moved_direction = glm::normalize(direction_through(moved, px, py));
      EXPECT_LT(glm::length(moved_direction - ray(px + offset_px.x, py + offset_px.y)), 5e-7F);
    }
  }
}

TEST(View, MovesThePointsOfARayToItsPixel) {
  const View view = camera_view(test_camera(), kWidth_px, kHeight_px, {0.3F, 0.1F});
  const glm::mat4 matrix = clip_from_world(view, 0.01F, 100.0F);
  for (const float distance_m : {0.02F, 1.0F, 30.0F}) {
    const glm::vec3 pixel =
        pixel_of(matrix, view.origin + distance_m * direction_through(view, 3.5F, 20.5F));
    EXPECT_NEAR(pixel.x, 3.5F, 2e-3F);
    EXPECT_NEAR(pixel.y, 20.5F, 2e-3F);
    EXPECT_NEAR(pixel.z, 0.01F / distance_m, 1e-4F * 0.01F / distance_m);
  }
}

TEST(View, OfParallelRaysHasLinearDepth) {
  View view = camera_view(test_camera(), kWidth_px, kHeight_px);
  view.is_orthographic = true;
  view.half_width = 2.0F;
  view.half_height = 1.5F;
  view.center = {0.5F, -0.25F};
  const glm::mat4 matrix = clip_from_world(view, 0.01F, 8.0F);
  for (const float distance_m : {0.0F, 2.0F, 8.0F}) {
    const glm::vec3 across = direction_through(view, 10.5F, 7.5F) - view.forward;
    const glm::vec3 pixel = pixel_of(matrix, view.origin + across + distance_m * view.forward);
    EXPECT_NEAR(pixel.x, 10.5F, 1e-4F);
    EXPECT_NEAR(pixel.y, 7.5F, 1e-4F);
    EXPECT_NEAR(pixel.z, 1.0F - distance_m / 8.0F, 1e-6F);
  }
}

/// Every direction lies in exactly one face, the one of its largest coordinate.
TEST(View, FacesOfACubeSeeEveryDirectionOnce) {
  const glm::vec3 right = glm::normalize(glm::vec3(1.0F, 2.0F, -0.5F));
  const glm::vec3 up = glm::normalize(glm::cross(right, glm::vec3(0.0F, 0.3F, 1.0F)));
  const glm::mat3 axes(right, up, glm::cross(right, up));
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 local(normal(random), normal(random), normal(random));
    const glm::vec3 direction = axes * local;
    int seen_by = -1;
    for (int face = 0; face < 6; ++face) {
      const View view = cube_face(glm::vec3(0.0F), axes, face);
      const float depth = glm::dot(direction, view.forward);
      if (std::fabs(glm::dot(direction, view.right)) < depth * view.half_width &&
          std::fabs(glm::dot(direction, view.up)) < depth * view.half_height) {
        EXPECT_EQ(seen_by, -1);
        seen_by = face;
      }
      EXPECT_LT(glm::length(glm::cross(view.forward, view.up) - view.right), 1e-6F);
    }
    int largest = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (std::fabs(local[axis]) > std::fabs(local[largest])) largest = axis;
    }
    EXPECT_EQ(seen_by, 2 * largest + (local[largest] < 0.0F ? 1 : 0));
  }
}

}  // namespace
}  // namespace renderers::opengl
