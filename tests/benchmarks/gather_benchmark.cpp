#include <benchmark/benchmark.h>

#include <memory>

#include "renderers/many_lights/gather.h"
#include "renderers/many_lights/geometry_aware_blur.h"
#include "renderers/many_lights/shade.h"
#include "renderers/many_lights/virtual_light_generator.h"
#include "renderers/opengl/gpu_scene.h"
#include "tests/renderers/scene_builder.h"

/// The passes of the virtual lights' kit at 800 x 800 with 1024 lights, unshadowed: evaluations
/// (pairs of light and pixel) per second of the gather, seconds of the other passes.
namespace {

using namespace renderers;
using namespace renderers::many_lights;

constexpr int kSize_px = 800;
constexpr int kLights = 1024;

/// A box with a sphere that fills the picture, lit by a point light or a lamp.
scene::Scene closed_box(bool has_lamp) {
  test::SceneBuilder builder;
  const int wall = builder.add_material(test::lambert({0.7F, 0.6F, 0.5F}));
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F), wall, true);
  builder.add_sphere({0.2F, -0.5F, 0.2F}, 0.4F, 64, wall);
  if (has_lamp) {
    const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(8.0F)));
    builder.add_quad({-0.3F, 0.99F, -0.3F}, {0.6F, 0, 0}, {0, 0, 0.6F}, lamp);
  } else {
    builder.add_point_light({0, 0.6F, 0}, glm::vec3(1.0F));
  }
  builder.look({-0.1F, 0, -0.95F}, {0, 0, 1}, 80.0F);
  return builder.scene;
}

/// A context with everything that a pass needs.
struct Setting {
  explicit Setting(bool has_lamp = false)
      : scene(closed_box(has_lamp)),
        context(opengl::Context::create("auto")),
        gpu(context),
        generator(context, {.light_count = kLights}),
        surfaces(context, kSize_px, kSize_px) {
    gpu.load(scene, timer);
    generator.load(scene);
    generator.generate(gpu, 0, timer);
    surfaces.render(gpu, opengl::camera_view(scene.camera, kSize_px, kSize_px));
    context->finish();
  }

  scene::Scene scene;
  std::shared_ptr<opengl::Context> context;
  StageTimer timer;
  opengl::GpuScene gpu;
  VirtualLightGenerator generator;
  opengl::GeometryBuffer surfaces;
};

void gather(benchmark::State& state, GatherOrder order, float geometry_clamp) {
  Setting setting;
  const GatherSettings settings{.interleave = static_cast<int>(state.range(0)),
                                .geometry_clamp = geometry_clamp};
  Gather gather(setting.context);
  const GatherLights lights{
      .lights = &setting.generator.lights(), .count = kLights, .first = 0, .batch = kLights};
  for (auto step : state) {
    gather.begin(setting.surfaces, settings);
    gather.add(setting.surfaces, setting.gpu, lights, settings, order);
    setting.context->finish();
  }
  const double per_frame = static_cast<double>(kSize_px) * kSize_px * kLights /
                           static_cast<double>(state.range(0) * state.range(0));
  state.counters["evaluations"] = benchmark::Counter(
      per_frame * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

/// The lookups alone: the maps hold nothing.
void gather_with_maps(benchmark::State& state) {
  Setting setting;
  const GatherSettings settings{.interleave = 8, .geometry_clamp = 30.0F};
  Gather gather(setting.context);
  shadow_maps::HemisphereMaps maps(setting.context, 128, kLights);
  maps.clear();
  const GatherLights lights{.lights = &setting.generator.lights(),
                            .count = kLights,
                            .first = 0,
                            .batch = kLights,
                            .maps = &maps};
  for (auto step : state) {
    gather.begin(setting.surfaces, settings);
    gather.add(setting.surfaces, setting.gpu, lights, settings);
    setting.context->finish();
  }
}

void blur(benchmark::State& state, BlurKind kind) {
  Setting setting;
  Gather gather(setting.context);
  gather.begin(setting.surfaces, {});
  opengl::Texture values(setting.context, gather.targets().irradiance.shape());
  GeometryAwareBlur blur(setting.context);
  for (auto step : state) {
    blur.apply(setting.surfaces, {.kind = kind, .interleave = 8, .alpha_m = 0.35F}, values);
    setting.context->finish();
  }
}

void shade(benchmark::State& state) {
  Setting setting;
  Gather gather(setting.context);
  gather.begin(setting.surfaces, {});
  Shade shade(setting.context);
  for (auto step : state) {
    shade.begin(kSize_px, kSize_px);
    shade.add(setting.surfaces, gather.targets(), false, 1.0F);
    setting.context->finish();
  }
}

void geometry_buffer(benchmark::State& state) {
  Setting setting;
  for (auto step : state) {
    setting.surfaces.render(setting.gpu,
                            opengl::camera_view(setting.scene.camera, kSize_px, kSize_px));
    setting.context->finish();
  }
}

/// Maps and lights of a new scene state; of a further pass over the same maps if `is_kept`.
void virtual_lights(benchmark::State& state, bool has_lamp, bool is_kept) {
  Setting setting(has_lamp);
  int pass = 0;
  for (auto step : state) {
    if (!is_kept) setting.generator.load(setting.scene);
    setting.generator.generate(setting.gpu, ++pass, setting.timer);
  }
  state.counters["maps"] = setting.generator.maps_drawn();
}

BENCHMARK_CAPTURE(gather, in_place, GatherOrder::in_place, 30.0F)
    ->Arg(8)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(gather, in_place_unclamped, GatherOrder::in_place, 0.0F)
    ->Arg(8)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(gather, naive, GatherOrder::naive, 30.0F)
    ->Arg(8)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(gather, split_merge, GatherOrder::split_merge, 30.0F)
    ->Arg(8)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(gather_with_maps)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK_CAPTURE(blur, box, BlurKind::box)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(blur, separable, BlurKind::separable)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(blur, centred, BlurKind::centred)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(shade)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(geometry_buffer)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK_CAPTURE(virtual_lights, point_light, false, false)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(virtual_lights, lamp, true, false)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(virtual_lights, point_light_kept_maps, false, true)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
