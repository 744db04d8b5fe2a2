#include <benchmark/benchmark.h>

#include "renderers/many_lights/bias_compensation.h"
#include "renderers/many_lights/ray_gather.h"
#include "renderers/ray_tracing/direct_light_pass.h"
#include "tests/renderers/many_lights/ray_cast_inputs.h"
#include "tests/renderers/scene_builder.h"

/// Rays per second of the passes that techniques with virtual point lights run on the CPU: direct
/// light, the gather with shadow rays, and the compensation of the clamp.
namespace {

using namespace renderers;
using benchmark::Counter;

constexpr int kSide_px = 256;
constexpr int kLights = 256;

/// Closed box with a lamp, a spot and a sphere of the given segments inside.
scene::Scene lit_box(int sphere_segments) {
  test::SceneBuilder builder;
  const int wall = builder.add_material(test::lambert({0.7F, 0.6F, 0.5F}));
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(8.0F)));
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F), wall, true);
  builder.add_quad({-0.3F, 0.99F, -0.3F}, {0.6F, 0, 0}, {0, 0, 0.6F}, lamp);
  if (sphere_segments > 0) builder.add_sphere({0.2F, -0.5F, 0.2F}, 0.5F, sphere_segments, wall);
  builder.add_point_light({-0.5F, 0.5F, -0.4F}, glm::vec3(3.0F));
  builder.look({-0.1F, 0, -0.95F}, {0, 0, 1}, 80.0F);
  return builder.scene;
}

/// A scene, its rays, and what its camera and its point light see.
struct Setting {
  explicit Setting(int sphere_segments) : scene(lit_box(sphere_segments)) {}

  scene::Scene scene;
  StageTimer timer;
  ray_tracing::RayScene rays{scene, timer};
  many_lights::SurfaceImage surfaces = test::cast_surfaces(rays, kSide_px, kSide_px);
  std::vector<many_lights::VirtualLight> lights = test::cast_lights(rays, scene.lights[0], kLights);
};

int segments_of(const benchmark::State& state) { return static_cast<int>(state.range(0)); }

void direct_light(benchmark::State& state) {
  const Setting setting(segments_of(state));
  const ray_tracing::DirectLightPass pass(setting.rays, {});
  double rays = 0.0;
  std::uint32_t done = 0;
  for (auto step : state) {
    const auto light = pass.render({kSide_px, kSide_px, setting.scene.camera, 1, done++});
    rays += static_cast<double>(light.counts.rays());
  }
  state.counters["rays"] = Counter(rays, Counter::kIsRate);
}

void path_direct(benchmark::State& state) {
  const scene::Scene scene = lit_box(segments_of(state));
  double rays = 0.0;
  for (auto step : state) {
    const Frame frame = test::render(scene, {.settings = {"transport=direct"},
                                             .width_px = kSide_px,
                                             .height_px = kSide_px,
                                             .samples = 4});
    rays += test::counter(frame, "rays");
  }
  state.counters["rays"] = Counter(rays, Counter::kIsRate);
}

void gather(benchmark::State& state, bool has_visibility) {
  const Setting setting(segments_of(state));
  double rays = 0.0;
  double lights = 0.0;
  for (auto step : state) {
    const auto light =
        many_lights::gather_by_rays({.scene = setting.scene,
                                     .surfaces = setting.surfaces,
                                     .lights = setting.lights,
                                     .rays = has_visibility ? &setting.rays : nullptr},
                                    {.interleave = 1});
    rays += static_cast<double>(light.rays);
    lights += static_cast<double>(kSide_px) * kSide_px * kLights;
  }
  state.counters["rays"] = Counter(rays, Counter::kIsRate);
  state.counters["lights"] = Counter(lights, Counter::kIsRate);
}

void bias_compensation(benchmark::State& state) {
  const Setting setting(segments_of(state));
  const ray_tracing::LightSampler lights(setting.rays);
  many_lights::BiasCompensationSettings settings{
      .geometry_clamp = 25.0F, .rays = 4, .camera_position = setting.scene.camera.position};
  double rays = 0.0;
  for (auto step : state) {
    const auto light =
        many_lights::compensate_bias(setting.rays, lights, setting.surfaces, settings);
    rays += static_cast<double>(light.short_rays + light.shadow_rays);
    settings.pass += 1;
  }
  state.counters["rays"] = Counter(rays, Counter::kIsRate);
}

void both_scenes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(0)->Arg(128)->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(direct_light)->Apply(both_scenes);
BENCHMARK(path_direct)->Apply(both_scenes);
BENCHMARK_CAPTURE(gather, with_shadow_rays, true)->Apply(both_scenes);
BENCHMARK_CAPTURE(gather, without_shadow_rays, false)->Apply(both_scenes);
BENCHMARK(bias_compensation)->Apply(both_scenes);

}  // namespace

BENCHMARK_MAIN();
