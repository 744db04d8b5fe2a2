#include <cstdint>

#include <benchmark/benchmark.h>

#include "renderers/light_propagation/intensity_lobe.h"
#include "renderers/light_propagation/propagation.h"

/// Propagation of light from cell to cell, set-up of the blockers included: cell steps per second.
/// A step reads 12 numbers and 30 shares of a cell and writes 12 twice, 264 bytes: volumes that do
/// not fit the caches run at the speed of memory.
namespace {

using namespace renderers::light_propagation;
using benchmark::Counter;

/// A lit floor, and surfaces across the middle.
struct Setting {
  explicit Setting(int cells) : grid{glm::ivec3(cells), glm::vec3(0.0F), 1.0F} {
    for (int x = 0; x < cells; ++x) {
      for (int z = 0; z < cells; ++z) {
        CellLight& cell = light.cells[grid.index({x, 0, z})];
        add_lobe(cell, cosine_lobe({0, 1, 0}), glm::vec3(1.0F));
        blocking.add(glm::vec3(x, cells / 2, z), {0, -1, 0}, 0.5F);
      }
    }
  }
  Grid grid;
  LightVolume light{grid};
  BlockingVolume blocking{grid};
};

void propagation(benchmark::State& state) {
  const Setting setting(static_cast<int>(state.range(0)));
  const auto steps = static_cast<int>(state.range(1));
  std::int64_t done = 0;
  for (auto step : state) {
    benchmark::DoNotOptimize(propagate(setting.light, &setting.blocking, {steps, false}));
    done += steps * static_cast<std::int64_t>(setting.grid.cell_count());
  }
  state.counters["cell_steps"] = Counter(static_cast<double>(done), Counter::kIsRate);
}

BENCHMARK(propagation)->ArgsProduct({{16, 32, 64}, {8, 64}})->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
