#include <cstdint>
#include <span>
#include <vector>

#include <benchmark/benchmark.h>

#include "renderers/opengl/context.h"
#include "renderers/shadow_maps/hard_maps.h"
#include "renderers/shadow_maps/hemicube_maps.h"
#include "renderers/shadow_maps/imperfect_maps.h"
#include "tests/renderers/scene_builder.h"
#include "tests/renderers/shadow_maps/map_bench.h"
#include "tests/renderers/shadow_maps/visibility_truth.h"

/// Hemispherical shadow maps per second: size of a map in px, triangles of the scene.
namespace {

using namespace renderers;

constexpr int kMaps = 256;

/// Closed box with a sphere of about so many triangles, 12 without.
scene::Scene box_with_sphere(std::int64_t triangles) {
  test::SceneBuilder builder;
  const int white = builder.add_material(test::lambert(glm::vec3(0.7F)));
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F), white, true);
  int segments = 0;
  while (4 * segments * (segments - 1) < triangles - 12) ++segments;
  if (segments > 1) builder.add_sphere({0.2F, -0.4F, 0.1F}, 0.6F, segments, white);
  return builder.scene;
}

void hard_maps(benchmark::State& state) {
  const test::MapBench bench(box_with_sphere(state.range(1)));
  const auto origins = test::origins_on_surfaces(bench.scene(), kMaps);
  const auto buffer = opengl::Buffer::of(bench.context(), std::span<const test::Origin>(origins));
  shadow_maps::HemisphereMaps maps(bench.context(), static_cast<int>(state.range(0)), kMaps);
  shadow_maps::HardMaps filler(bench.context(), {.counts_work = true});
  filler.fill(maps, bench.gpu(), {&buffer, 2}, 0, kMaps);
  const shadow_maps::HardMapWork work = filler.work();
  filler = shadow_maps::HardMaps(bench.context());
  filler.fill(maps, bench.gpu(), {&buffer, 2}, 0, kMaps);
  bench.context()->finish();
  for (auto step : state) {
    filler.fill(maps, bench.gpu(), {&buffer, 2}, 0, kMaps);
    bench.context()->finish();
  }
  const auto rate = [&](std::int64_t items) {
    return benchmark::Counter(static_cast<double>(items) * static_cast<double>(state.iterations()),
                              benchmark::Counter::kIsRate);
  };
  state.counters["maps"] = rate(kMaps);
  state.counters["pairs"] = rate(work.pairs);
  state.counters["texel_tests"] = rate(work.texels_tested);
  state.counters["triangles"] = bench.gpu().triangle_count();
}

/// The paper's numbers: 30 maps of 256 x 256 px of whole scenes.
constexpr int kPaperMaps = 30;
constexpr int kPaperSize_px = 256;

void run_scene(benchmark::State& state, const char* name, auto&& make_filler) {
  const test::MapBench bench(test::catalog_scene(name));
  const auto origins = test::origins_on_surfaces(bench.scene(), kPaperMaps);
  const auto buffer = opengl::Buffer::of(bench.context(), std::span<const test::Origin>(origins));
  shadow_maps::HemisphereMaps maps(bench.context(), kPaperSize_px, kPaperMaps);
  auto filler = make_filler(bench);
  const auto fill = [&] {
    filler.fill(maps, bench.gpu(), {&buffer, 2}, 0, kPaperMaps);
    bench.context()->finish();
  };
  fill();
  for (auto step : state) fill();
  state.counters["triangles"] = bench.gpu().triangle_count();
  state.counters["MiB"] = static_cast<double>(filler.memory_bytes()) / (1 << 20);
}

void hard_scene(benchmark::State& state, const char* name) {
  run_scene(state, name,
            [](const test::MapBench& bench) { return shadow_maps::HardMaps(bench.context()); });
}

void hemicube_scene(benchmark::State& state, const char* name) {
  run_scene(state, name,
            [](const test::MapBench& bench) { return shadow_maps::HemicubeMaps(bench.context()); });
}

void vertex_scene(benchmark::State& state, const char* name,
                  shadow_maps::LayerChoice layer_choice) {
  StageTimer timer;
  run_scene(state, name, [&](const test::MapBench& bench) {
    shadow_maps::VertexMaps filler(bench.context(), {.layer_choice = layer_choice});
    filler.load(bench.scene(), timer);
    state.counters["pieces"] = filler.piece_count();
    return filler;
  });
  state.counters["tessellation_ms"] = 1e3 * timer.wall_of("tessellation");
}

void imperfect_maps(benchmark::State& state) {
  const test::MapBench bench(box_with_sphere(7000));
  const auto origins = test::origins_on_surfaces(bench.scene(), kMaps);
  const auto buffer = opengl::Buffer::of(bench.context(), std::span<const test::Origin>(origins));
  shadow_maps::HemisphereMaps maps(bench.context(), static_cast<int>(state.range(0)), kMaps);
  shadow_maps::ImperfectMapSettings settings;
  settings.points_per_map = static_cast<int>(state.range(1));
  shadow_maps::ImperfectMaps filler(bench.context(), settings);
  StageTimer timer;
  filler.load(bench.scene(), timer);
  filler.fill(maps, {&buffer, 2}, 0, kMaps);
  bench.context()->finish();
  for (auto step : state) {
    filler.fill(maps, {&buffer, 2}, 0, kMaps);
    bench.context()->finish();
  }
  state.counters["maps"] =
      benchmark::Counter(static_cast<double>(kMaps) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
  state.counters["points_ms"] = 1e3 * timer.wall_of("points");
}

BENCHMARK(hard_maps)
    ->ArgNames({"px", "triangles"})
    ->ArgsProduct({{32, 64, 128, 256}, {12, 7000, 100000}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(imperfect_maps)
    ->ArgNames({"px", "points"})
    ->ArgsProduct({{32, 64, 128}, {256, 1024}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

BENCHMARK_CAPTURE(hard_scene, atrium, "common-atrium")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(hard_scene, horse, "cornell-horse")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(hemicube_scene, atrium, "common-atrium")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(hemicube_scene, horse, "cornell-horse")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(vertex_scene, atrium_vs_layer, "common-atrium",
                  shadow_maps::LayerChoice::vs_layer)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(vertex_scene, atrium_gs_layer, "common-atrium",
                  shadow_maps::LayerChoice::gs_layer)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(vertex_scene, atrium_per_layer, "common-atrium",
                  shadow_maps::LayerChoice::per_layer)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(vertex_scene, horse_vs_layer, "cornell-horse", shadow_maps::LayerChoice::vs_layer)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(vertex_scene, horse_gs_layer, "cornell-horse", shadow_maps::LayerChoice::gs_layer)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(vertex_scene, horse_per_layer, "cornell-horse",
                  shadow_maps::LayerChoice::per_layer)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
