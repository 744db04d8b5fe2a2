#include "renderers/area_shadows/point_visibility.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "renderers/area_shadows/shadow_tracer.h"

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

/// Pixels at the origin that look up.
PixelSurfaces floor_pixels(std::size_t count) {
  PixelSurface up;
  up.receiver.normal = up.receiver.geometric_normal = {0, 1, 0};
  PixelSurfaces surfaces;
  surfaces.pixels.assign(count, up);
  return surfaces;
}

/// Every point is seen; how long lists are is kept.
class NothingBetween final : public PointVisibility {
 public:
  void find(std::span<const GroupRays> rays, std::span<std::uint16_t> visible,
            StageTimer& /*timer*/) override {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      visible[i] = static_cast<std::uint16_t>(rays[i].facing);
    }
    lengths.push_back(rays.size());
  }

  std::vector<std::size_t> lengths;
};

TEST(PointVisibility, MoreLightsThanSixteenBitsNumberAreToldApart) {
  constexpr std::size_t kLight = (std::size_t{1} << 16) + 1;
  std::vector<LightPointSet> lights(kLight + 1);
  lights[kLight] = light_above();
  const GroupRays rays = rays_to_group(floor_pixels(1), lights, 0, kLight, 0);
  EXPECT_EQ(rays.light, kLight);
  EXPECT_EQ(rays.facing, 1U);
}

TEST(PointVisibility, EveryPixelComesOnceWithItsFactors) {
  constexpr std::size_t kPixels = kMostListedGroups / 2 + 100;
  const PixelSurfaces surfaces = floor_pixels(kPixels);
  const std::vector<LightPointSet> lights(2, light_above());
  std::vector<std::uint32_t> pixels(kPixels);
  for (std::uint32_t i = 0; i < kPixels; ++i) pixels[i] = i;
  NothingBetween visibility;
  StageTimer timer;
  std::vector<int> visits(kPixels, 0);
  std::vector<float> factors(kPixels, 0.0F);
  const RayCounts counts =
      visit_pixels(visibility, {surfaces, lights, pixels}, timer, [&](const PixelPoints& points) {
        ++visits[points.pixel];
        for (const auto& of_group : points.factors) factors[points.pixel] += of_group.values[0];
      });
  EXPECT_EQ(std::ranges::count(visits, 1), static_cast<std::ptrdiff_t>(kPixels));
  EXPECT_EQ(std::ranges::count(factors, 2.0F), static_cast<std::ptrdiff_t>(kPixels));
  EXPECT_EQ(counts.rays, 2 * kPixels);
  EXPECT_EQ(counts.unhidden, 2 * kPixels);
  EXPECT_EQ(visibility.lengths, (std::vector<std::size_t>{kMostListedGroups, 200}));
}

TEST(ShadowTracer, AsksInListsOfBoundedLengthAndNothingTwice) {
  constexpr std::size_t kPixels = kMostListedGroups + 100;
  const PixelSurfaces surfaces = floor_pixels(kPixels);
  const std::vector<LightPointSet> lights{light_above()};
  NothingBetween visibility;
  StageTimer timer;
  ShadowTracer tracer(visibility, surfaces, lights, timer);
  for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    tracer.ask({pixel, 0, 0});
    tracer.ask_pixel(pixel);
  }
  EXPECT_EQ(visibility.lengths, std::vector<std::size_t>{kMostListedGroups});
  EXPECT_EQ(tracer.trace(), kPixels);
  EXPECT_EQ(visibility.lengths, (std::vector<std::size_t>{kMostListedGroups, 100}));
  EXPECT_EQ(tracer.trace(), 0U);
  EXPECT_EQ(tracer.trace_pixels(std::vector<std::uint32_t>{0, 7}), 0U);
  EXPECT_EQ(tracer.known(7, 0, 0), 1U);
}

}  // namespace
}  // namespace renderers::area_shadows
