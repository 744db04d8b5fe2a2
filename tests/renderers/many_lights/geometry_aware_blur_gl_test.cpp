#include "renderers/many_lights/geometry_aware_blur.h"

#include <cmath>
#include <iostream>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "renderers/many_lights/gather.h"
#include "renderers/opengl/gpu_scene.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/many_lights/light_oracle.h"

namespace renderers::many_lights {
namespace {

class GeometryAwareBlurTest : public test::GlTest {
 protected:
  std::vector<glm::vec3> blur(const SurfaceImage& surfaces, const std::vector<glm::dvec3>& values,
                              const BlurSettings& settings) const {
    const auto geometry = test::geometry_of(context(), surfaces);
    opengl::Texture texture =
        test::texture_of(context(), surfaces.width_px, surfaces.height_px, values);
    GeometryAwareBlur(context()).apply(*geometry, settings, texture);
    return test::read_rgb(texture);
  }
  std::vector<glm::dvec3> gather(const SurfaceImage& surfaces,
                                 const std::vector<VirtualLight>& lights, int interleave) const {
    const auto picture =
        test::gather_on_device(context(), surfaces, lights, opengl::GpuScene(context()),
                               {.settings = {.interleave = interleave}});
    return {picture.irradiance.begin(), picture.irradiance.end()};
  }
};

/// A floor under lights, a pixel every 1 / width of its side; `side_m` 0: one point in every pixel.
SurfaceImage floor_of(int size_px, float side_m) {
  SurfaceImage surfaces = test::empty_surfaces(size_px, size_px);
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) {
      const glm::vec2 place((static_cast<float>(x) + 0.5F) / static_cast<float>(size_px) - 0.5F,
                            (static_cast<float>(y) + 0.5F) / static_cast<float>(size_px) - 0.5F);
      test::put_flat(surfaces, static_cast<std::size_t>(y * size_px + x),
                     {side_m * place.x, 0.0F, side_m * place.y}, {0, 1, 0});
    }
  }
  return surfaces;
}

std::vector<VirtualLight> lights_above(int count) {
  test::Numbers numbers;
  std::vector<VirtualLight> lights;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 place = numbers.in_box(1.0);
    lights.push_back(test::flat_light({place.x, 1.0, place.z}, {0, -1, 0},
                                      glm::dvec3(numbers.next(), numbers.next(), 1.0)));
  }
  return lights;
}

glm::dvec3 mean_of(const std::vector<glm::dvec3>& values) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TEST_F(GeometryAwareBlurTest, EqualsTheOracle) {
  test::Numbers numbers;
  for (const auto& [width_px, height_px] : {std::pair(7, 5), std::pair(13, 9), std::pair(37, 21)}) {
    SurfaceImage surfaces = test::empty_surfaces(width_px, height_px);
    std::vector<glm::dvec3> values(surfaces.position.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i < values.size(); ++i) {
      // Three kinds of places and normals, some background, so that all conditions matter.
      if (numbers.next() < 0.15) continue;
      const glm::dvec3 position =
          glm::dvec3(2.0 * std::floor(2.0 * numbers.next()), 0, 0) + 0.3 * numbers.direction();
      const glm::dvec3 normal = glm::normalize(glm::dvec3(0, numbers.next() < 0.3 ? -1 : 1, 0) +
                                               0.3 * numbers.direction());
      test::put_flat(surfaces, i, glm::vec3(position), glm::vec3(normal));
      values[i] = {numbers.next(), numbers.next(), numbers.next()};
    }
    for (const BlurKind kind : {BlurKind::box, BlurKind::separable, BlurKind::centred}) {
      for (const int n : {1, 2, 3, 8}) {
        const BlurSettings settings{.kind = kind, .interleave = n, .alpha_m = 0.5F, .beta = 0.8F};
        const auto expected = test::oracle_blur(surfaces, values, settings);
        const auto blurred = blur(surfaces, values, settings);
        for (std::size_t i = 0; i < values.size(); ++i) {
          EXPECT_LT(glm::distance(glm::dvec3(blurred[i]), expected[i]), 1e-5)
              << "kind " << static_cast<int>(kind) << ", n = " << n << ", pixel " << i;
        }
      }
    }
  }
}

TEST_F(GeometryAwareBlurTest, ConstantReceiverGetsTheFullSum) {
  const auto lights = lights_above(512);
  const SurfaceImage surfaces = floor_of(40, 0.0F);
  const glm::dvec3 full = gather(surfaces, lights, 1)[0];
  const auto interleaved = gather(surfaces, lights, 8);
  EXPECT_GT(glm::distance(interleaved[0], full), 0.05 * glm::length(full))
      << "classes differ, so there is something to blur";
  for (const BlurKind kind : {BlurKind::box, BlurKind::separable, BlurKind::centred}) {
    const auto blurred =
        blur(surfaces, interleaved, {.kind = kind, .interleave = 8, .alpha_m = 0.3F});
    for (int y = 8; y < 32; ++y) {
      for (int x = 8; x < 32; ++x) {
        const glm::dvec3 value(blurred[static_cast<std::size_t>(y * 40 + x)]);
        EXPECT_LT(glm::distance(value, full), 1e-4 * glm::length(full));
      }
    }
  }
}

TEST_F(GeometryAwareBlurTest, KeepsTheMean) {
  const auto lights = lights_above(512);
  const SurfaceImage surfaces = floor_of(160, 2.0F);
  const glm::dvec3 full = mean_of(gather(surfaces, lights, 1));
  const auto interleaved = gather(surfaces, lights, 8);
  const glm::dvec3 mean = mean_of(interleaved);
  EXPECT_LT(glm::distance(mean, full), 5e-3 * glm::length(full)) << "interleaving alone";
  std::vector<std::vector<glm::dvec3>> pictures;
  for (const BlurKind kind : {BlurKind::box, BlurKind::separable, BlurKind::centred}) {
    const auto blurred =
        blur(surfaces, interleaved, {.kind = kind, .interleave = 8, .alpha_m = 0.3F});
    pictures.emplace_back(blurred.begin(), blurred.end());
    EXPECT_LT(glm::distance(mean_of(pictures.back()), mean), 5e-3 * glm::length(mean));
  }
}

TEST_F(GeometryAwareBlurTest, SheetsTwoAlphaApartDoNotMix) {
  // Columns in turn on two parallel sheets, as through a grating.
  SurfaceImage surfaces = test::empty_surfaces(24, 24);
  std::vector<glm::dvec3> values;
  for (std::size_t i = 0; i < surfaces.position.size(); ++i) {
    const bool is_far = i % 2 == 1;
    test::put_flat(surfaces, i, {0, is_far ? -0.4F : 0.0F, 0}, {0, 1, 0});
    values.emplace_back(is_far ? 3.0 : 1.0);
  }
  for (const BlurKind kind : {BlurKind::box, BlurKind::separable, BlurKind::centred}) {
    const auto apart = blur(surfaces, values, {.kind = kind, .interleave = 8, .alpha_m = 0.2F});
    const auto mixed = blur(surfaces, values, {.kind = kind, .interleave = 8, .alpha_m = 0.5F});
    for (std::size_t i = 0; i < values.size(); ++i) {
      // A weighted mean of equal numbers may miss them by a rounding.
      EXPECT_FLOAT_EQ(apart[i].x, static_cast<float>(values[i].x));
      EXPECT_FLOAT_EQ(apart[i].y, static_cast<float>(values[i].y));
      EXPECT_FLOAT_EQ(apart[i].z, static_cast<float>(values[i].z));
      EXPECT_GT(std::abs(static_cast<double>(mixed[i].x) - values[i].x), 0.5)
          << "a wider alpha mixes them";
    }
  }
}

TEST_F(GeometryAwareBlurTest, PixelAlwaysCounts) {
  // A normal that was interpolated short of unit length is not like itself.
  SurfaceImage surfaces = test::empty_surfaces(3, 3);
  test::put_flat(surfaces, 4, {0, 0, 0}, {0, 0.5F, 0});
  std::vector<glm::dvec3> values(9, glm::dvec3(0.0));
  values[4] = {1, 2, 3};
  for (const BlurKind kind : {BlurKind::box, BlurKind::separable, BlurKind::centred}) {
    const auto blurred = blur(surfaces, values, {.kind = kind, .interleave = 8, .alpha_m = 0.2F});
    EXPECT_EQ(blurred[4], glm::vec3(1, 2, 3));
    EXPECT_EQ(blurred[0], glm::vec3(0, 0, 0));
  }
}

TEST_F(GeometryAwareBlurTest, SeparableIsNearTheBoxNextToAnEdge) {
  // A wall rises from the floor along a diagonal of the picture.
  SurfaceImage surfaces = floor_of(64, 2.0F);
  for (int y = 0; y < 64; ++y) {
    for (int x = y; x < 64; ++x) {
      const auto pixel = static_cast<std::size_t>(y * 64 + x);
      const glm::vec3 position(surfaces.position[pixel]);
      test::put_flat(surfaces, pixel, position, glm::normalize(glm::vec3(-1, 0.2F, 1)));
    }
  }
  const auto interleaved = gather(surfaces, lights_above(512), 8);
  const auto box =
      blur(surfaces, interleaved, {.kind = BlurKind::box, .interleave = 8, .alpha_m = 0.3F});
  const auto separable =
      blur(surfaces, interleaved, {.kind = BlurKind::separable, .interleave = 8, .alpha_m = 0.3F});
  double squares = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < box.size(); ++i) {
    const glm::dvec3 difference(box[i] - separable[i]);
    squares += glm::dot(difference, difference);
    total += glm::dot(glm::dvec3(box[i]), glm::dvec3(box[i]));
  }
  const double relative = std::sqrt(squares / total);
  std::cout << "separable against box: relative RMS " << relative << "\n";
  EXPECT_LT(relative, 0.1);
  EXPECT_GT(relative, 0.0) << "they are not the same";
}

}  // namespace
}  // namespace renderers::many_lights
