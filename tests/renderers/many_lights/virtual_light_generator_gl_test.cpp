#include "renderers/many_lights/virtual_light_generator.h"

#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "renderers/many_lights/emitter_views.h"
#include "renderers/opengl/gpu_scene.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/ray_tracing/surface_brdf.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/many_lights/light_oracle.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::many_lights {
namespace {

constexpr double kPi = std::numbers::pi;
const glm::vec3 kIntensity{3.0F, 2.0F, 0.5F};
const glm::vec3 kAlbedo{0.8F, 0.5F, 0.2F};

/// A generator and the scene on the device.
struct Made {
  Made(std::shared_ptr<opengl::Context> context, const scene::Scene& scene,
       const GeneratorSettings& settings)
      : gpu(context), generator(context, settings) {
    gpu.load(scene, timer);
    generator.load(scene);
    generate(0);
  }
  void generate(int pass) { generator.generate(gpu, pass, timer); }
  std::vector<VirtualLight> lights() const {
    return generator.lights().read<VirtualLight>(static_cast<std::size_t>(generator.light_count()));
  }

  StageTimer timer;
  opengl::GpuScene gpu;
  VirtualLightGenerator generator;
};

bool are_same(const std::vector<VirtualLight>& a, const std::vector<VirtualLight>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

test::SceneBuilder closed_box() {
  test::SceneBuilder builder;
  builder.add_box({-1, -1, -1}, {1, 1, 1}, builder.add_material(test::lambert(kAlbedo)), true);
  return builder;
}

scene::Light spot(float inner_deg, float outer_deg) {
  scene::Light light;
  light.type = scene::LightType::spot;
  light.position = {0.1F, 0.2F, -0.3F};
  light.intensity = kIntensity;
  light.direction = glm::normalize(glm::vec3(0.3F, -0.8F, 0.5F));
  light.inner_cone_rad = inner_deg * static_cast<float>(kPi) / 180.0F;
  light.outer_cone_rad = outer_deg * static_cast<float>(kPi) / 180.0F;
  return light;
}

class VirtualLightGeneratorTest : public test::GlTest {};

TEST_F(VirtualLightGeneratorTest, PointLightsPowerIsReflectedWhateverTheMapsSize) {
  test::SceneBuilder builder = closed_box();
  builder.add_point_light({0.2F, -0.1F, 0.3F}, kIntensity);
  // What a point of the room gets, too, whose only change is that of the texels' centres.
  const test::OracleReceiver receiver{{0.4, -0.9, 0.1}, {0, 1, 0}, {0, 1, 0}};
  std::optional<double> irradiance;
  for (const int size_px : {256, 512, 1024}) {
    const Made made(context(), builder.scene, {.map_size_px = size_px});
    const LightTotals totals = made.generator.read_totals();
    EXPECT_EQ(totals.valid, 1024);
    EXPECT_FALSE(totals.is_dark());
    EXPECT_EQ(made.generator.maps_drawn(), 6);
    const glm::dvec3 expected = 4.0 * kPi * glm::dvec3(kIntensity * kAlbedo);
    for (glm::length_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(totals.flux[c], expected[c], 1e-3 * expected[c]) << size_px;
    }
    double received = 0.0;
    for (const VirtualLight& light : made.lights()) {
      received += test::oracle_irradiance(test::oracle_light(light), receiver, 20.0).x;
    }
    if (irradiance) {
      EXPECT_NEAR(received, *irradiance, 5e-3 * received) << size_px;
    }
    irradiance = received;
  }
}

TEST_F(VirtualLightGeneratorTest, SpotsPowerIsReflected) {
  test::SceneBuilder builder = closed_box();
  builder.scene.lights.push_back(spot(20.0F, 40.0F));
  const double mean_cosine = 0.5 * (std::cos(20.0 * kPi / 180.0) + std::cos(40.0 * kPi / 180.0));
  const glm::dvec3 expected = 2.0 * kPi * (1.0 - mean_cosine) * glm::dvec3(kIntensity * kAlbedo);
  for (const LightSampling sampling : {LightSampling::map, LightSampling::solid_angle}) {
    const Made made(context(), builder.scene, {.emitters = {.sampling = sampling}});
    const LightTotals totals = made.generator.read_totals();
    const double gate = sampling == LightSampling::map ? 3e-3 : 1e-3;
    for (glm::length_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(totals.flux[c], expected[c], gate * expected[c]);
    }
    // A square around a disc: pi / 4 of the map's samples lie in the cone.
    const double share = sampling == LightSampling::map ? kPi / 4.0 : 1.0;
    EXPECT_NEAR(totals.valid / 1024.0, share, 0.01);
  }
}

TEST_F(VirtualLightGeneratorTest, AreaLightsPowerIsReflected) {
  test::SceneBuilder builder = closed_box();
  const glm::vec3 radiance(4.0F, 3.0F, 1.0F);
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), radiance));
  builder.add_quad({-0.3F, 0.999F, -0.2F}, {0.6F, 0, 0}, {0, 0, 0.4F}, lamp);
  const Made made(context(), builder.scene, {});
  const LightTotals totals = made.generator.read_totals();
  EXPECT_GE(totals.valid, 1022);
  const glm::dvec3 expected = kPi * 0.24 * glm::dvec3(radiance * kAlbedo);
  for (glm::length_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(totals.flux[c], expected[c], 3e-3 * expected[c]);
  }
}

TEST_F(VirtualLightGeneratorTest, EnvironmentsPowerIsReflected) {
  // A sheet in the open: radiance 1 from all sides gives pi L A to both of its sides.
  test::SceneBuilder builder;
  builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, builder.add_material(test::lambert(kAlbedo)));
  builder.set_environment(glm::vec3(1.0F));
  const Made made(context(), builder.scene,
                  {.light_count = 4096, .emitters = {.environment_directions = 64}});
  const LightTotals totals = made.generator.read_totals();
  const double expected = 2.0 * kPi * 4.0;
  EXPECT_NEAR(totals.flux.x / static_cast<double>(kAlbedo.x), expected, 0.03 * expected);
}

/// What a ray through the nearest texel's centre says, in place of the map.
std::optional<VirtualLight> cast_sample(const ray_tracing::RayScene& rays, const Emitter& emitter,
                                        const EmittedSample& sample, int size_px) {
  const opengl::View& view = emitter.views[static_cast<std::size_t>(sample.view)];
  const glm::dvec2 center = (glm::floor(sample.map_position * static_cast<double>(size_px)) + 0.5) /
                            static_cast<double>(size_px);
  glm::dvec3 origin(view.origin);
  glm::dvec3 direction = direction_through(view, center);
  if (view.is_orthographic) {
    direction = glm::dvec3(view.forward);
    origin +=
        glm::dvec3(view.right) * ((2.0 * center.x - 1.0) * static_cast<double>(view.half_width)) -
        glm::dvec3(view.up) * ((2.0 * center.y - 1.0) * static_cast<double>(view.half_height));
  }
  ray_tracing::Hit hit;
  if (!rays.intersect({glm::vec3(origin), glm::vec3(direction)}, hit)) return std::nullopt;
  const glm::dvec3 to_emitter = -direction;
  const double side = glm::dot(glm::dvec3(hit.geometric_normal), to_emitter) < 0.0 ? -1.0 : 1.0;
  const glm::dvec3 geometric = side * glm::dvec3(hit.geometric_normal);
  const glm::dvec3 shading = side * glm::dvec3(hit.shading_normal);
  const double cosine_s = glm::dot(shading, to_emitter);
  if (cosine_s <= 0.0) return std::nullopt;
  const glm::dvec3 albedo(ray_tracing::diffuse_albedo(rays.scene(), hit));
  const glm::dvec3 flux = sample.flux * albedo * (cosine_s / glm::dot(geometric, to_emitter));
  if (luminance(flux) <= 0.0) return std::nullopt;  // a black surface
  return VirtualLight{glm::vec4(hit.position, 1.0F), glm::vec4(geometric, 0.0),
                      glm::vec4(shading, 0.0), glm::vec4(flux, 0.0)};
}

TEST_F(VirtualLightGeneratorTest, LightsAreWhereRaysSay) {
  test::SceneBuilder builder = closed_box();
  builder.scene.objects.pop_back();  // one wall open, so that samples can miss
  scene::Texture texture;
  texture.image = perception::make_rgb_image(4, 4, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < texture.image.pixels.size(); ++i) {
    texture.image.pixels[i] = 0.2F + 0.05F * static_cast<float>(i % 13);
  }
  builder.scene.textures.push_back(texture);
  scene::Material textured = test::lambert(glm::vec3(0.9F));
  textured.albedo_texture = 0;
  builder.scene.objects[2].material = builder.add_material(textured);
  builder.add_sphere({0.3F, -0.4F, 0.2F}, 0.4F, 24, 0);
  builder.add_point_light({-0.4F, 0.5F, -0.2F}, kIntensity);
  builder.scene.lights.push_back(spot(10.0F, 50.0F));
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(3.0F)));
  builder.add_quad({-0.3F, 0.9F, -0.2F}, {0.6F, 0, 0}, {0, 0, 0.4F}, lamp);
  builder.set_environment(glm::vec3(0.3F));

  const GeneratorSettings settings{.light_count = 600, .emitters = {.area_light_points = 4}};
  const Made made(context(), builder.scene, settings);
  const auto lights = made.lights();
  StageTimer timer;
  const ray_tracing::RayScene rays(builder.scene, timer);
  const auto& emitters = made.generator.emitters();
  ASSERT_EQ(emitters.size(), 4U);
  std::vector<double> weights;
  for (const Emitter& emitter : emitters) weights.push_back(luminance(emitter.flux));
  const auto counts = light_counts(weights, 600);
  const auto slots = assign_lights(weights, 600);

  int valid = 0;
  int different = 0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto e = static_cast<std::size_t>(slots[i].emitter);
    const int size_px = emitters[e].kind == EmitterKind::area ? settings.area_map_size_px
                        : emitters[e].kind == EmitterKind::environment
                            ? settings.environment_map_size_px
                            : settings.map_size_px;
    const auto expected =
        cast_sample(rays, emitters[e], emitters[e].sample(slots[i].index, counts[e], 0), size_px);
    const bool is_valid = lights[i].position.w > 0.0F;
    valid += is_valid ? 1 : 0;
    if (!is_valid) {
      EXPECT_EQ(lights[i].flux, glm::vec4(0.0F));
    }
    if (is_valid != expected.has_value()) {
      ++different;
      continue;
    }
    if (!is_valid) continue;
    const double scale = glm::length(glm::dvec3(expected->flux));
    const bool is_same =
        glm::distance(lights[i].position, expected->position) < 1e-3F &&
        glm::distance(lights[i].geometric_normal, expected->geometric_normal) < 1e-3F &&
        glm::distance(lights[i].shading_normal, expected->shading_normal) < 1e-3F &&
        glm::distance(glm::dvec3(lights[i].flux), glm::dvec3(expected->flux)) <= 5e-3 * scale;
    different += is_same ? 0 : 1;
  }
  EXPECT_GT(valid, 400);
  EXPECT_LT(valid, 600) << "some samples leave through the open wall";
  EXPECT_LE(different, 3) << "texels at the rims of triangles";
}

TEST_F(VirtualLightGeneratorTest, NothingLitIsDark) {
  test::SceneBuilder builder;
  builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, builder.add_material(test::lambert(kAlbedo)));
  scene::Light away = spot(10.0F, 30.0F);
  away.direction = {0, 1, 0};
  builder.scene.lights.push_back(away);
  const Made lit_nothing(context(), builder.scene, {});
  EXPECT_EQ(lit_nothing.generator.read_totals().valid, 0);
  EXPECT_TRUE(lit_nothing.generator.read_totals().is_dark());

  builder.scene.lights.clear();
  const Made no_light(context(), builder.scene, {});
  EXPECT_TRUE(no_light.generator.read_totals().is_dark());
  EXPECT_TRUE(no_light.generator.emitters().empty());
  EXPECT_EQ(no_light.generator.maps_drawn(), 0);
}

TEST_F(VirtualLightGeneratorTest, LightInsideGeometryLightsItsInside) {
  test::SceneBuilder builder = closed_box();
  builder.add_sphere({0, 0, 0}, 0.5F, 32, 0);
  builder.add_point_light({0.1F, 0, 0}, kIntensity);
  const Made made(context(), builder.scene, {.light_count = 300});
  for (const VirtualLight& light : made.lights()) {
    const glm::vec3 position(light.position);
    ASSERT_EQ(light.position.w, 1.0F);
    EXPECT_NEAR(glm::length(position), 0.5F, 5e-3F);
    EXPECT_LT(glm::dot(glm::vec3(light.geometric_normal), position), 0.0F) << "the lit side";
  }
}

TEST_F(VirtualLightGeneratorTest, LaterPassesReuseTheMaps) {
  test::SceneBuilder builder = closed_box();
  builder.add_point_light({0.2F, -0.1F, 0.3F}, kIntensity);
  Made kept(context(), builder.scene, {.light_count = 512});
  const auto first = kept.lights();
  kept.generate(1);
  EXPECT_EQ(kept.generator.maps_drawn(), 0);
  const auto second = kept.lights();
  EXPECT_FALSE(are_same(first, second));
  kept.generate(0);
  EXPECT_TRUE(are_same(first, kept.lights())) << "bit by bit the same as before";

  // Without room for maps they are drawn again, with the same result.
  Made drawn(context(), builder.scene, {.light_count = 512, .kept_map_bytes = 0});
  EXPECT_TRUE(are_same(first, drawn.lights()));
  drawn.generate(1);
  EXPECT_EQ(drawn.generator.maps_drawn(), 6);
  EXPECT_TRUE(are_same(second, drawn.lights()));
  EXPECT_GT(kept.generator.memory_bytes(), drawn.generator.memory_bytes());

  // A new state of the scene needs new maps.
  builder.scene.lights[0].position = {0, 0, 0};
  kept.generator.load(builder.scene);
  kept.generate(0);
  EXPECT_EQ(kept.generator.maps_drawn(), 6);
  EXPECT_FALSE(are_same(first, kept.lights()));
}

/// A point light, a lamp and an environment.
test::SceneBuilder lit_by_all() {
  test::SceneBuilder builder = closed_box();
  builder.add_point_light({0.2F, -0.1F, 0.3F}, kIntensity);
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(4.0F)));
  builder.add_quad({-0.3F, 0.999F, -0.2F}, {0.6F, 0, 0}, {0, 0, 0.4F}, lamp);
  builder.set_environment(glm::vec3(0.1F));
  return builder;
}

const GeneratorSettings kSmallMaps{
    .light_count = 512,
    .emitters = {.area_light_points = 4, .environment_directions = 4},
    .map_size_px = 64,
    .area_map_size_px = 32,
    .environment_map_size_px = 32};

TEST_F(VirtualLightGeneratorTest, LightOffAndOnAgainTakesNoMoreMemory) {
  test::SceneBuilder builder = lit_by_all();
  Made made(context(), builder.scene, kSmallMaps);
  const std::int64_t with_light = made.generator.memory_bytes();
  const auto lights = made.lights();

  scene::Scene off = builder.scene;
  off.lights.clear();
  const Made cold_off(context(), off, kSmallMaps);
  made.generator.load(off);
  made.generate(0);
  EXPECT_EQ(made.generator.memory_bytes(), cold_off.generator.memory_bytes());
  EXPECT_LT(made.generator.memory_bytes(), with_light);

  // Room for the maps of this state alone.
  GeneratorSettings narrow = kSmallMaps;
  narrow.kept_map_bytes =
      with_light - static_cast<std::int64_t>(made.generator.lights().size_bytes());
  Made again(context(), builder.scene, narrow);
  for (int time = 0; time < 3; ++time) {
    again.generator.load(off);
    again.generate(0);
    again.generator.load(builder.scene);
    again.generate(0);
    EXPECT_EQ(again.generator.memory_bytes(), with_light);
    EXPECT_TRUE(are_same(lights, again.lights()));
    again.generate(0);
    EXPECT_EQ(again.generator.maps_drawn(), 0) << "all maps are kept";
  }
}

/// Views of an emitter's kind with or without point sets that lights of a pass come from.
int views_in_use(const VirtualLightGenerator& generator, int pass, bool with_point_set) {
  std::vector<double> weights;
  for (const Emitter& emitter : generator.emitters()) weights.push_back(luminance(emitter.flux));
  const std::vector<int> counts = light_counts(weights, generator.light_count());
  int views = 0;
  for (std::size_t e = 0; e < counts.size(); ++e) {
    const Emitter& emitter = generator.emitters()[e];
    if (has_point_set(emitter) != with_point_set) continue;
    std::set<int> used;
    for (int i = 0; i < counts[e]; ++i) used.insert(emitter.sample(i, counts[e], pass).view);
    views += static_cast<int>(used.size());
  }
  return views;
}

TEST_F(VirtualLightGeneratorTest, AnotherPointSetKeepsTheMapsOfLights) {
  const test::SceneBuilder builder = lit_by_all();
  Made made(context(), builder.scene, kSmallMaps);
  ASSERT_TRUE(made.generator.has_point_sets());
  ASSERT_EQ(views_in_use(made.generator, 0, false), 6);
  EXPECT_EQ(made.generator.maps_drawn(), 6 + views_in_use(made.generator, 0, true));
  const auto first = made.lights();

  made.generator.use_point_set(builder.scene, 1);
  made.generate(0);
  EXPECT_EQ(made.generator.maps_drawn(), views_in_use(made.generator, 0, true));
  EXPECT_GT(made.generator.maps_drawn(), 4 + 4);
  const auto second = made.lights();
  EXPECT_FALSE(are_same(first, second));

  // What is kept is what a start without any maps draws.
  Made cold(context(), builder.scene, kSmallMaps);
  cold.generator.load(builder.scene);
  cold.generator.use_point_set(builder.scene, 1);
  cold.generate(0);
  EXPECT_EQ(cold.generator.maps_drawn(), 6 + made.generator.maps_drawn());
  EXPECT_TRUE(are_same(second, cold.lights()));
  EXPECT_EQ(made.generator.memory_bytes(), cold.generator.memory_bytes());

  made.generator.use_point_set(builder.scene, 0);
  made.generate(0);
  EXPECT_TRUE(are_same(first, made.lights())) << "the first set again";
}

TEST_F(VirtualLightGeneratorTest, FewLightsForManyEmitters) {
  test::SceneBuilder builder = closed_box();
  for (int i = 0; i < 3; ++i) {
    builder.add_point_light({0.2F * static_cast<float>(i), 0, 0}, kIntensity);
  }
  const Made made(context(), builder.scene, {.light_count = 2, .map_size_px = 64});
  EXPECT_EQ(made.generator.emitters_left_out(), 1);
  EXPECT_EQ(made.generator.read_totals().valid, 2);
  const Made enough(context(), builder.scene, {.light_count = 3, .map_size_px = 64});
  EXPECT_EQ(enough.generator.emitters_left_out(), 0);
  EXPECT_EQ(enough.generator.read_totals().valid, 3);
}

TEST_F(VirtualLightGeneratorTest, TimesItsStages) {
  test::SceneBuilder builder = closed_box();
  builder.add_point_light({0.2F, -0.1F, 0.3F}, kIntensity);
  const Made made(context(), builder.scene, {});
  EXPECT_GT(made.timer.wall_of("lights"), 0.0);
  EXPECT_GT(made.timer.wall_of("lights/map"), 0.0);
  EXPECT_GT(made.timer.wall_of("lights/sample"), 0.0);
}

}  // namespace
}  // namespace renderers::many_lights
