#include "suites/new_view.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <gtest/gtest.h>

namespace {

using renderers::scene::Camera;

/// Angle between the arms from look_at to the eye, degrees, seen along the axis.
double turned_by_deg(const Camera& before, const Camera& after) {
  const glm::vec3 axis = glm::normalize(before.up);
  const auto flat = [&](const Camera& camera) {
    const glm::vec3 arm = camera.position - camera.look_at;
    return glm::normalize(arm - glm::dot(arm, axis) * axis);
  };
  const double sine = glm::dot(axis, glm::cross(flat(before), flat(after)));
  return glm::degrees(std::asin(sine));
}

TEST(NewView, TurnsTheEyeAboutThePointItLooksAt) {
  Camera camera;
  camera.position = {1.0F, 2.0F, -4.0F};
  camera.look_at = {0.5F, 1.0F, 1.0F};
  camera.up = {0.2F, 3.0F, 0.1F};  // of any length, and not at a right angle to the view
  const Camera turned = suites::turned_camera(camera);
  EXPECT_NEAR(turned_by_deg(camera, turned), 5.0, 1e-3);
  EXPECT_NEAR(glm::length(turned.position - turned.look_at),
              glm::length(camera.position - camera.look_at), 1e-5);
  // Its height above the point, along the axis, stays.
  EXPECT_NEAR(glm::dot(turned.position - camera.position, glm::normalize(camera.up)), 0.0, 1e-6);
  EXPECT_EQ(turned.look_at, camera.look_at);
  EXPECT_EQ(turned.up, camera.up);
  EXPECT_EQ(turned.vertical_fov_deg, camera.vertical_fov_deg);
}

TEST(NewView, GoesAroundOnceInSeventyTwoSteps) {
  Camera camera;
  camera.position = {0.0F, 1.0F, -3.0F};
  camera.look_at = {0.0F, 1.0F, 1.0F};
  Camera turned = camera;
  for (int i = 0; i < 72; ++i) turned = suites::turned_camera(turned);
  EXPECT_NEAR(glm::length(turned.position - camera.position), 0.0, 1e-4);
}

}  // namespace
