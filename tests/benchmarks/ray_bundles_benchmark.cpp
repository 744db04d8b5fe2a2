#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <benchmark/benchmark.h>

#include "renderers/opengl/context.h"
#include "renderers/ray_bundles/bundle_transport.h"
#include "renderers/scene/scene_file.h"
#include "tests/places.h"

/// A direction of a bundle, lists and exchange, by what makes and exchanges them: time, its shares,
/// and the three rates of throughput: slots (lines times 8, empty or not: Hermes et al. 2010,
/// Sec. 6.3), pairs of surfaces that saw each other, pairs that carried light.
namespace {

using namespace renderers;
using namespace renderers::ray_bundles;
using benchmark::Counter;

constexpr int kSlots = 8;

enum class Place { cpu, read_back, device };

void direction(benchmark::State& state, const std::string& scene_name, Place place,
               ListKind lists) {
  const std::filesystem::path scenes =
      std::filesystem::path(tests::kSourceFolder) / "suites/scenes";
  const scene::Scene scene = scene::read_scene_file(scenes / (scene_name + ".yaml")).at_frame(0);
  StageTimer timer;
  const bool has_traced_lists = lists == ListKind::trace && place == Place::cpu;
  const ray_tracing::RayScene rays(
      scene, timer,
      has_traced_lists ? ray_tracing::RayQueries::all_hits : ray_tracing::RayQueries::first_hits);
  texel_atlas::AtlasSettings atlas_settings;
  atlas_settings.side_px = static_cast<int>(state.range(1));
  const texel_atlas::TexelAtlas atlas(rays, atlas_settings, timer);
  TransportSettings settings;
  settings.lines_across = static_cast<int>(state.range(0));
  settings.lists = lists;
  settings.slots = {kSlots, true};
  settings.exchange = place == Place::device ? ExchangePlace::device : ExchangePlace::cpu;
  if (place != Place::cpu) settings.device = opengl::Context::create("auto");
  BundleTransport transport(rays, atlas, settings, timer);
  // Shaders compile, buffers grow, light gets around.
  for (int i = 0; i < 16; ++i) transport.add_direction(timer);
  transport.fetch(timer);
  const TransportCounts before = transport.counts();
  const double lists_s = timer.wall_of("visibility");
  const double exchange_s = timer.wall_of("transport");
  for (auto step : state) transport.add_direction(timer);
  transport.fetch(timer);
  const TransportCounts& after = transport.counts();
  const auto rate = [](std::uint64_t count) {
    return Counter(static_cast<double>(count), Counter::kIsRate);
  };
  const auto mean_ms = [](double seconds) {
    return Counter(1e3 * seconds, Counter::kAvgIterations);
  };
  state.counters["lists_ms"] = mean_ms(timer.wall_of("visibility") - lists_s);
  state.counters["exchange_ms"] = mean_ms(timer.wall_of("transport") - exchange_s);
  state.counters["slots"] = rate(kSlots * (after.lines - before.lines));
  state.counters["pairs"] = rate(after.exchange.pairs - before.exchange.pairs);
  state.counters["lit_pairs"] = rate(after.exchange.lit_pairs - before.exchange.lit_pairs);
  state.SetLabel(settings.device ? settings.device->facts().renderer : "cpu");
}

void sizes(benchmark::internal::Benchmark* of) {
  of->Args({512, 512})->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK_CAPTURE(direction, box_cpu, "bundles-box", Place::cpu, ListKind::raster)->Apply(sizes);
BENCHMARK_CAPTURE(direction, box_read_back, "bundles-box", Place::read_back, ListKind::raster)
    ->Apply(sizes);
BENCHMARK_CAPTURE(direction, box_device, "bundles-box", Place::device, ListKind::raster)
    ->Apply(sizes);
BENCHMARK_CAPTURE(direction, box_slots_cpu, "bundles-box", Place::cpu, ListKind::fixed_k)
    ->Apply(sizes);
BENCHMARK_CAPTURE(direction, box_slots_device, "bundles-box", Place::device, ListKind::fixed_k)
    ->Apply(sizes);
BENCHMARK_CAPTURE(direction, box_traced_cpu, "bundles-box", Place::cpu, ListKind::trace)
    ->Apply(sizes);
BENCHMARK_CAPTURE(direction, box_traced_read_back, "bundles-box", Place::read_back, ListKind::trace)
    ->Apply(sizes);
BENCHMARK_CAPTURE(direction, box_traced_device, "bundles-box", Place::device, ListKind::trace)
    ->Apply(sizes);
BENCHMARK_CAPTURE(direction, shelves_cpu, "shelves", Place::cpu, ListKind::raster)->Apply(sizes);
BENCHMARK_CAPTURE(direction, shelves_device, "shelves", Place::device, ListKind::raster)
    ->Apply(sizes);
BENCHMARK_CAPTURE(direction, shelves_traced_cpu, "shelves", Place::cpu, ListKind::trace)
    ->Apply(sizes);
BENCHMARK_CAPTURE(direction, shelves_traced_device, "shelves", Place::device, ListKind::trace)
    ->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
