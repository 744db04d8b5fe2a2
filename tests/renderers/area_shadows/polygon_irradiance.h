#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "renderers/scene/scene.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::test {

/// Irradiance of a Lambert polygon of radiance 1, all of it above the receiver's horizon:
/// E = 1/2 sum of theta_i (n . gamma_i), theta_i the angle that edge i is seen under, gamma_i the
/// unit normal of the plane through edge and receiver.
/// Source: Lambert 1760, as in Arvo 1995, "Applications of Irradiance Tensors to the Simulation of
/// Non-Lambertian Phenomena", doi:10.1145/218380.218467, Sec. 2 (number recalled).
/// @param polygon  clockwise or counter-clockwise; the result is not negative
double polygon_irradiance(const glm::dvec3& receiver, const glm::dvec3& normal,
                          const std::vector<glm::dvec3>& polygon);

/// A square floor of albedo 1 with a lamp of radiance 1 above it, looked at from above, so that the
/// radiance times pi is the irradiance. The camera is above the lamp, which looks down.
struct LampOverFloor {
  double half_floor_m = 2.0;
  double half_lamp_m = 0.25;
  double height_m = 1.5;

  SceneBuilder scene() const;
  std::vector<glm::dvec3> lamp() const;
  /// The point of the floor at a pixel's centre. The floor fills the image.
  glm::dvec3 point(int x, int y, int side_px) const;
  double irradiance(const glm::dvec3& at) const {
    return polygon_irradiance(at, {0, 1, 0}, lamp());
  }
};

/// An image's channel 0 times pi, at a pixel.
double irradiance_at(const perception::Image& radiance, int x, int y);

/// Root mean square of the difference of two images by that of the second.
double relative_rmse(const perception::Image& test, const perception::Image& reference);

}  // namespace renderers::test
