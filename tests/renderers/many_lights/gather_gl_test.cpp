#include "renderers/many_lights/gather.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "renderers/opengl/gpu_scene.h"
#include "renderers/shadow_maps/hard_maps.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/many_lights/light_oracle.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::many_lights {
namespace {

constexpr double kPi = std::numbers::pi;
const glm::dvec3 kFlux{5.0, 3.0, 0.7};

class GatherTest : public test::GlTest {
 protected:
  test::Picture gather(const SurfaceImage& surfaces, const std::vector<VirtualLight>& lights,
                       const test::GatherCall& call) const {
    return test::gather_on_device(context(), surfaces, lights, opengl::GpuScene(context()), call);
  }
  /// Irradiance of one light at one receiver at the origin that looks along +z.
  glm::vec3 at_origin(const VirtualLight& light, float geometry_clamp) const {
    SurfaceImage surfaces = test::empty_surfaces(1, 1);
    test::put_flat(surfaces, 0, {0, 0, 0}, {0, 0, 1});
    return gather(surfaces, {light},
                  {.settings = {.interleave = 1, .geometry_clamp = geometry_clamp}})
        .irradiance[0];
  }
};

/// Normals that differ by up to some tens of degrees, on one side of each other.
glm::vec4 bent(const glm::dvec3& normal, test::Numbers& numbers) {
  return glm::vec4(glm::normalize(normal + 0.4 * numbers.direction()), 0.0);
}

/// Random surfaces, every fifth pixel background, of three materials in turn.
SurfaceImage random_surfaces(int width_px, int height_px, test::Numbers& numbers) {
  SurfaceImage surfaces = test::empty_surfaces(width_px, height_px);
  for (std::size_t i = 0; i < surfaces.position.size(); ++i) {
    if (i % 5 == 3) continue;
    const glm::dvec3 normal = numbers.direction();
    test::put_flat(surfaces, i, glm::vec3(numbers.in_box(1.0)), glm::vec3(normal));
    surfaces.shading_normal[i] = bent(normal, numbers);
    surfaces.geometric_normal[i].w = static_cast<float>(i % 3);
    surfaces.albedo[i].w = i % 3 > 0 ? 1.0F : 0.0F;
  }
  return surfaces;
}

std::vector<VirtualLight> random_lights(int count, test::Numbers& numbers) {
  std::vector<VirtualLight> lights;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 normal = numbers.direction();
    VirtualLight light =
        test::flat_light(numbers.in_box(1.0), normal, kFlux * numbers.between(0.1, 1.0));
    light.shading_normal = bent(normal, numbers);
    if (i % 7 == 2) light = VirtualLight{};
    lights.push_back(light);
  }
  return lights;
}

std::vector<scene::Material> materials() {
  return {test::lambert(glm::vec3(0.5F)), test::phong(glm::vec3(0.2F), {0.3F, 0.2F, 0.1F}, 7.0F),
          test::phong(glm::vec3(0.0F), glm::vec3(0.9F), 60.0F)};
}

/// One of each kind: a scene with GGX takes another shader.
std::vector<scene::Material> materials_with_ggx() {
  return {test::ggx(glm::vec3(0.2F), {0.3F, 0.2F, 0.1F}, 0.7F),
          test::phong(glm::vec3(0.2F), {0.3F, 0.2F, 0.1F}, 7.0F),
          test::ggx(glm::vec3(0.0F), glm::vec3(0.9F), 0.15F)};
}

/// The materials on the device; a triangle each.
opengl::GpuScene device_materials(const std::shared_ptr<opengl::Context>& context,
                                  const std::vector<scene::Material>& list = materials()) {
  test::SceneBuilder builder;
  for (const scene::Material& material : list) {
    builder.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, builder.add_material(material));
  }
  opengl::GpuScene scene(context);
  StageTimer timer;
  scene.load(builder.scene, timer);
  return scene;
}

/// Differences, of the largest value of the picture.
double relative_difference(const std::vector<glm::vec3>& a, const std::vector<glm::dvec3>& b) {
  double largest = 0.0;
  double difference = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, glm::length(b[i]));
    difference = std::max(difference, glm::length(glm::dvec3(a[i]) - b[i]));
  }
  return difference / largest;
}

/// Largest distance in units in the last place.
std::int64_t ulps(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  std::int64_t worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (glm::length_t c = 0; c < 3; ++c) {
      const std::int64_t bits_a = std::bit_cast<std::int32_t>(a[i][c]);
      const std::int64_t bits_b = std::bit_cast<std::int32_t>(b[i][c]);
      worst = std::max(worst, std::abs(bits_a - bits_b));
    }
  }
  return worst;
}

TEST_F(GatherTest, SingleLightFollowsTheFormula) {
  const glm::dvec3 position(0.6, -0.3, 0.9);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.2, 0.5, -1.0));
  const double distance2 = glm::dot(position, position);
  const glm::dvec3 to_light = position / std::sqrt(distance2);
  const glm::dvec3 expected = kFlux / kPi * to_light.z * -glm::dot(normal, to_light) / distance2;
  const glm::vec3 value = at_origin(test::flat_light(position, normal, kFlux), 0.0F);
  for (glm::length_t c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], 1e-5 * expected[c]);
}

TEST_F(GatherTest, ClampIsHitExactly) {
  // G = 1 / 0.01^2 head on; with the clamp what is left is b flux / pi.
  const VirtualLight close = test::flat_light({0, 0, 0.01}, {0, 0, -1}, kFlux);
  const glm::vec3 clamped = at_origin(close, 25.0F);
  for (glm::length_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(clamped[c], 25.0 * kFlux[c] / kPi, 1e-5 * 25.0 * kFlux[c] / kPi);
    EXPECT_NEAR(at_origin(close, 0.0F)[c], 1e4 * kFlux[c] / kPi, 1e-5 * 1e4 * kFlux[c] / kPi);
  }
  // Beyond 1 / sqrt(b) it changes nothing.
  const VirtualLight far = test::flat_light({0, 0, 0.21}, {0, 0, -1}, kFlux);
  EXPECT_EQ(at_origin(far, 23.0F), at_origin(far, 0.0F));
}

TEST_F(GatherTest, NothingCrossesEitherPlane) {
  const glm::vec3 none(0.0F);
  EXPECT_EQ(at_origin(test::flat_light({0.1, 0, -1}, {0, 0, 1}, kFlux), 0.0F), none)
      << "light below the receiver";
  EXPECT_EQ(at_origin(test::flat_light({0.1, 0, 1}, {0, 0, 1}, kFlux), 0.0F), none)
      << "receiver behind the light";
  EXPECT_EQ(at_origin(test::flat_light({0, 0, 0}, {0, 0, 1}, kFlux), 0.0F), none)
      << "receiver in the light";
  EXPECT_EQ(at_origin(VirtualLight{}, 0.0F), none) << "no light";
  // Above the shading normal's horizon, below the geometric one.
  SurfaceImage surfaces = test::empty_surfaces(1, 1);
  test::put_flat(surfaces, 0, {0, 0, 0}, {0, 0, 1});
  surfaces.geometric_normal[0] = glm::vec4(glm::normalize(glm::vec3(-1.0F, 0, 0.2F)), 0.0F);
  const VirtualLight light = test::flat_light({1, 0, 0.15}, {-1, 0, 0}, kFlux);
  EXPECT_EQ(gather(surfaces, {light}, {.settings = {.interleave = 1}}).irradiance[0], none);
}

TEST_F(GatherTest, EqualsTheOracle) {
  test::Numbers numbers;
  const opengl::GpuScene scene = device_materials(context());
  const GatherSettings settings[]{
      {.interleave = 1, .geometry_clamp = 4.0F},
      {.interleave = 2, .with_glossy = true, .camera_position = {0.1F, 3.0F, -2.0F}},
      {.interleave = 3, .geometry_clamp = 2.0F, .with_glossy = true},
      {.interleave = 8, .geometry_clamp = 4.0F}};
  for (const auto& [width_px, height_px] : {std::pair(7, 5), std::pair(13, 9), std::pair(70, 40)}) {
    const SurfaceImage surfaces = random_surfaces(width_px, height_px, numbers);
    // Divisible by n^2, not divisible, and fewer than n^2.
    for (const int count : {192, 101, 17, 1}) {
      const auto lights = random_lights(count, numbers);
      for (const GatherSettings& s : settings) {
        const auto expected = test::oracle_gather(surfaces, lights, materials(), s);
        const auto picture =
            test::gather_on_device(context(), surfaces, lights, scene, {.settings = s});
        if (count > 1) {
          EXPECT_LT(relative_difference(picture.irradiance, expected.irradiance), 1e-5)
              << width_px << " px, " << count << " lights, n = " << s.interleave;
        }
        for (std::size_t i = 3; i < surfaces.position.size(); i += 5) {
          EXPECT_EQ(picture.irradiance[i], glm::vec3(0.0F)) << "background";
        }
        if (!s.with_glossy || count < 100) continue;
        EXPECT_LT(relative_difference(picture.glossy, expected.glossy), 2e-5)
            << width_px << " px, " << count << " lights, n = " << s.interleave;
      }
    }
  }
}

TEST_F(GatherTest, LobesOfGgxEqualTheOracle) {
  test::Numbers numbers;
  const std::vector<scene::Material> list = materials_with_ggx();
  const opengl::GpuScene scene = device_materials(context(), list);
  EXPECT_TRUE(scene.has_ggx());
  EXPECT_FALSE(device_materials(context()).has_ggx());
  SurfaceImage surfaces = random_surfaces(70, 40, numbers);
  for (std::size_t i = 0; i < surfaces.albedo.size(); ++i) {
    surfaces.albedo[i].w = surfaces.position[i].w;
  }
  const auto lights = random_lights(192, numbers);
  const GatherSettings settings{
      .interleave = 2, .with_glossy = true, .camera_position = {0.1F, 3.0F, -2.0F}};
  const auto expected = test::oracle_gather(surfaces, lights, list, settings);
  const auto picture =
      test::gather_on_device(context(), surfaces, lights, scene, {.settings = settings});
  EXPECT_LT(relative_difference(picture.glossy, expected.glossy), 2e-5);
}

TEST_F(GatherTest, OracleTellsTheMistakesApart) {
  // The comparison above would notice: each mistake moves the oracle by far more than its gate.
  test::Numbers numbers;
  const SurfaceImage surfaces = random_surfaces(7, 5, numbers);
  const auto lights = random_lights(101, numbers);
  const auto right = test::oracle_gather(surfaces, lights, materials(), {.interleave = 1});
  for (const auto mistake : {test::Mistake::swapped_normal, test::Mistake::missing_pi,
                             test::Mistake::distance_to_the_fourth}) {
    std::vector<glm::vec3> wrong(right.irradiance.size(), glm::vec3(0.0F));
    for (std::size_t i = 0; i < wrong.size(); ++i) {
      if (surfaces.position[i].w <= 0.0F) continue;
      for (const VirtualLight& light : lights) {
        wrong[i] += test::oracle_irradiance(test::oracle_light(light),
                                            test::oracle_receiver(surfaces, i), 0.0, mistake);
      }
    }
    EXPECT_GT(relative_difference(wrong, right.irradiance), 0.1);
  }
}

TEST_F(GatherTest, OrdersAgreeToTheLastDigit) {
  test::Numbers numbers;
  const opengl::GpuScene scene = device_materials(context());
  const SurfaceImage surfaces = random_surfaces(61, 43, numbers);
  const auto lights = random_lights(300, numbers);
  for (const int interleave : {1, 3, 8}) {
    test::GatherCall call{.settings = {.interleave = interleave,
                                       .geometry_clamp = 3.0F,
                                       .with_glossy = true,
                                       .camera_position = {0, 0, 3}}};
    const auto in_place = test::gather_on_device(context(), surfaces, lights, scene, call);
    for (const GatherOrder order : {GatherOrder::naive, GatherOrder::split_merge}) {
      call.order = order;
      const auto other = test::gather_on_device(context(), surfaces, lights, scene, call);
      EXPECT_LE(ulps(in_place.irradiance, other.irradiance), 1) << interleave;
      EXPECT_LE(ulps(in_place.glossy, other.glossy), 1) << interleave;
    }
  }
}

TEST_F(GatherTest, BatchesAddUp) {
  test::Numbers numbers;
  const SurfaceImage surfaces = random_surfaces(29, 31, numbers);
  const auto lights = random_lights(130, numbers);
  for (const GatherOrder order :
       {GatherOrder::in_place, GatherOrder::naive, GatherOrder::split_merge}) {
    for (const int interleave : {1, 4, 16}) {
      test::GatherCall call{.settings = {.interleave = interleave}, .order = order};
      const auto at_once = gather(surfaces, lights, call);
      for (const int batch : {1, 7, 64}) {
        if (batch == 1 && interleave != 4) continue;
        call.batch = batch;
        const auto batched = gather(surfaces, lights, call);
        const std::vector<glm::dvec3> expected(at_once.irradiance.begin(),
                                               at_once.irradiance.end());
        EXPECT_LT(relative_difference(batched.irradiance, expected), 1e-6)
            << "n = " << interleave << ", batches of " << batch;
      }
    }
  }
}

TEST_F(GatherTest, LayersOfMapsBelongToTheBatchsLights) {
  // A plate of half width 0.25 m hangs between a floor and five lights in a row.
  test::SceneBuilder builder;
  const int grey = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_quad({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, grey);
  builder.add_quad({-0.25F, -0.25F, 1}, {0.5F, 0, 0}, {0, 0.5F, 0}, grey);
  opengl::GpuScene scene(context());
  StageTimer timer;
  scene.load(builder.scene, timer);
  std::vector<VirtualLight> lights;
  for (int i = 0; i < 5; ++i) {
    lights.push_back(test::flat_light({0.8 * i - 1.6, 0, 2}, {0, 0, -1}, kFlux * (1.0 + i)));
  }
  SurfaceImage surfaces = test::empty_surfaces(9, 1);
  std::vector<glm::dvec3> expected(9, glm::dvec3(0.0));
  int shadowed = 0;
  for (std::size_t pixel = 0; pixel < 9; ++pixel) {
    const double x = 0.4 * static_cast<double>(pixel) - 1.6;
    test::put_flat(surfaces, pixel, {static_cast<float>(x), 0, 0}, {0, 0, 1});
    for (const VirtualLight& light : lights) {
      // Halfway up, the ray is midway; edges of the shadow are 0.1 m away from all receivers.
      const bool is_hidden = std::abs(0.5 * (x + static_cast<double>(light.position.x))) < 0.25;
      shadowed += is_hidden ? 1 : 0;
      if (is_hidden) continue;
      expected[pixel] += test::oracle_irradiance(test::oracle_light(light),
                                                 test::oracle_receiver(surfaces, pixel), 0.0);
    }
  }
  EXPECT_GT(shadowed, 5);

  const auto geometry = test::geometry_of(context(), surfaces);
  const auto buffer = opengl::Buffer::of(context(), std::span<const VirtualLight>(lights));
  for (const int batch : {5, 2}) {
    Gather gather(context());
    const GatherSettings settings{.interleave = 1};
    gather.begin(*geometry, settings);
    shadow_maps::HemisphereMaps maps(context(), 128, batch);
    shadow_maps::HardMaps hard_maps(context());
    for (int first = 0; first < 5; first += batch) {
      const int count = std::min(batch, 5 - first);
      hard_maps.fill(maps, scene, {.buffer = &buffer, .stride = 4}, first, count);
      gather.add(*geometry, scene,
                 {.lights = &buffer, .count = 5, .first = first, .batch = count, .maps = &maps},
                 settings);
    }
    EXPECT_LT(relative_difference(test::read_rgb(gather.targets().irradiance), expected), 1e-5)
        << "batches of " << batch;
  }
}

TEST_F(GatherTest, RunsAreThoseOfTheHeader) {
  for (const auto& [interleave, count] :
       {std::pair(8, 1024), std::pair(8, 100), std::pair(8, 17), std::pair(3, 64)}) {
    int covered = 0;
    for (int y = 0; y < interleave; ++y) {
      for (int x = 0; x < interleave; ++x) {
        const LightRun run = light_run(x + interleave, y + 2 * interleave, interleave, count);
        const auto expected = test::oracle_run(x, y, interleave, count);
        ASSERT_EQ(static_cast<std::size_t>(run.count), expected.size());
        if (!expected.empty()) {
          EXPECT_EQ(static_cast<std::size_t>(run.first), expected.front());
        }
        covered += run.count;
      }
    }
    EXPECT_EQ(covered, count) << "every light is in one run";
  }
}

}  // namespace
}  // namespace renderers::many_lights
