#include "tests/renderers/area_shadows/polygon_irradiance.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace renderers::test {

double polygon_irradiance(const glm::dvec3& receiver, const glm::dvec3& normal,
                          const std::vector<glm::dvec3>& polygon) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 a = glm::normalize(polygon[i] - receiver);
    const glm::dvec3 b = glm::normalize(polygon[(i + 1) % polygon.size()] - receiver);
    const glm::dvec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine <= 0.0) continue;
    sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(normal, across) / sine;
  }
  return 0.5 * std::fabs(sum);
}

namespace {
constexpr float kCameraHeight_m = 10.0F;
}

SceneBuilder LampOverFloor::scene() const {
  const auto f = static_cast<float>(half_floor_m);
  const auto l = static_cast<float>(half_lamp_m);
  const auto h = static_cast<float>(height_m);
  SceneBuilder builder;
  const int floor = builder.add_material(lambert(glm::vec3(1.0F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  builder.add_quad({-f, 0, -f}, {0, 0, 2 * f}, {2 * f, 0, 0}, floor);
  builder.add_quad({-l, h, -l}, {2 * l, 0, 0}, {0, 0, 2 * l}, lamp);
  const float fov_deg = 2.0F * std::atan(f / kCameraHeight_m) * 180.0F / std::numbers::pi_v<float>;
  builder.look({0, kCameraHeight_m, 0}, {0, 0, 0}, fov_deg);
  return builder;
}

std::vector<glm::dvec3> LampOverFloor::lamp() const {
  const double l = half_lamp_m;
  return {{-l, height_m, -l}, {l, height_m, -l}, {l, height_m, l}, {-l, height_m, l}};
}

glm::dvec3 LampOverFloor::point(int x, int y, int side_px) const {
  const double pixel = 2.0 * half_floor_m / side_px;
  // Looking down with +z up in the image: x grows to the left.
  return {half_floor_m - (x + 0.5) * pixel, 0.0, half_floor_m - (y + 0.5) * pixel};
}

double irradiance_at(const perception::Image& radiance, int x, int y) {
  return static_cast<double>(radiance.at(x, y)) * std::numbers::pi;
}

double relative_rmse(const perception::Image& test, const perception::Image& reference) {
  double error = 0.0;
  double power = 0.0;
  for (std::size_t i = 0; i < test.pixels.size(); ++i) {
    const auto a = static_cast<double>(test.pixels[i]);
    const auto b = static_cast<double>(reference.pixels[i]);
    error += (a - b) * (a - b);
    power += b * b;
  }
  return std::sqrt(error / power);
}

}  // namespace renderers::test
