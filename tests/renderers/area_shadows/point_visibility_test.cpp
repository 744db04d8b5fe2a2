#include "renderers/area_shadows/point_visibility.h"

#include <gtest/gtest.h>

/// Lists of groups of light points.
namespace renderers::area_shadows {
namespace {

using ray_tracing::LightPointSet;

/// A light of one point straight above the origin.
LightPointSet light_above() {
  LightPointSet light;
  ray_tracing::LightPoint point;
  point.position = point.target = {0, 1, 0};
  point.normal = {0, -1, 0};
  point.power = glm::vec3(1.0F);
  light.points = {point};
  light.corners = {point.position};
  light.planes = {{point.position, point.normal}};
  light.coordinates.resize(1);
  light.coordinates[0].position[1][0] = 1.0F;
  light.coordinates[0].normal[1][0] = -1.0F;
  return light;
}

/// One pixel at the origin that looks up.
PixelSurfaces floor_pixel() {
  PixelSurfaces surfaces;
  surfaces.pixels.resize(1);
  surfaces.pixels[0].receiver.normal = surfaces.pixels[0].receiver.geometric_normal = {0, 1, 0};
  return surfaces;
}

TEST(PointVisibility, MoreLightsThanSixteenBitsNumberAreToldApart) {
  constexpr std::size_t kLight = (std::size_t{1} << 16) + 1;
  std::vector<LightPointSet> lights(kLight + 1);
  lights[kLight] = light_above();
  const GroupRays rays = rays_to_group(floor_pixel(), lights, 0, kLight, 0);
  EXPECT_EQ(rays.light, kLight);
  EXPECT_EQ(rays.facing, 1U);
}

}  // namespace
}  // namespace renderers::area_shadows
