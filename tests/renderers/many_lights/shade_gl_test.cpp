#include "renderers/many_lights/shade.h"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/renderers/many_lights/gl_fixture.h"

namespace renderers::many_lights {
namespace {

using ShadeTest = test::GlTest;

TEST_F(ShadeTest, RadianceIsAlbedoOverPiTimesIrradiancePlusGlossy) {
  const double pi = std::numbers::pi;
  SurfaceImage surfaces = test::empty_surfaces(3, 1);
  test::put_flat(surfaces, 0, {0, 0, 0}, {0, 0, 1});
  test::put_flat(surfaces, 1, {0, 0, 0}, {0, 0, 1});
  surfaces.albedo[1] = {0.5F, 0.25F, 0.1F, 0.0F};
  const auto geometry = test::geometry_of(context(), surfaces);
  const std::vector<glm::dvec3> irradiance(3, {pi, 2.0 * pi, 3.0 * pi});
  const std::vector<glm::dvec3> glossy(3, {0.5, 0.25, 0.125});
  const GatherTargets light{test::texture_of(context(), 3, 1, irradiance),
                            test::texture_of(context(), 3, 1, glossy)};
  Shade shade(context());
  shade.begin(3, 1);
  shade.add(*geometry, light, false, 1.0F);
  auto radiance = test::read_rgb(shade.radiance());
  const auto expect_near = [&](std::size_t pixel, const glm::dvec3& expected) {
    for (glm::length_t c = 0; c < 3; ++c) EXPECT_NEAR(radiance[pixel][c], expected[c], 1e-6);
  };
  expect_near(0, {1, 2, 3});
  expect_near(1, {0.5, 0.5, 0.3});
  expect_near(2, {0, 0, 0});

  // Two passes of half the weight, one of them with the lobes.
  shade.begin(3, 1);
  shade.add(*geometry, light, false, 0.5F);
  shade.add(*geometry, light, true, 0.5F);
  radiance = test::read_rgb(shade.radiance());
  expect_near(0, {1.25, 2.125, 3.0625});
  expect_near(1, {0.75, 0.625, 0.3625});
  expect_near(2, {0, 0, 0});
  EXPECT_FLOAT_EQ(shade.radiance().read()[3], 1.0F);
}

}  // namespace
}  // namespace renderers::many_lights
