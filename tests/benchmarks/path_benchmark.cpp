#include <atomic>
#include <vector>

#include <benchmark/benchmark.h>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "tests/renderers/scene_builder.h"

/// Rays per second of the path tracer at 512 x 512, and of the intersector alone on like rays.
namespace {

using namespace renderers;

/// Closed box of 12 triangles with a lamp and a sphere of the given segments inside.
scene::Scene closed_box(int sphere_segments) {
  test::SceneBuilder builder;
  const int wall = builder.add_material(test::lambert({0.7F, 0.6F, 0.5F}));
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(8.0F)));
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F), wall, true);
  builder.add_quad({-0.3F, 0.99F, -0.3F}, {0.6F, 0, 0}, {0, 0, 0.6F}, lamp);
  if (sphere_segments > 0) builder.add_sphere({0.2F, -0.5F, 0.2F}, 0.5F, sphere_segments, wall);
  builder.look({-0.1F, 0, -0.95F}, {0, 0, 1}, 80.0F);
  return builder.scene;
}

void path(benchmark::State& state, const std::vector<std::string>& settings) {
  const scene::Scene scene = closed_box(static_cast<int>(state.range(0)));
  double rays = 0.0;
  double samples = 0.0;
  for (auto step : state) {
    const Frame frame = test::render(
        scene, {.settings = settings, .width_px = 512, .height_px = 512, .samples = 4});
    rays += test::counter(frame, "rays");
    samples += test::counter(frame, "camera_rays");
  }
  state.counters["rays"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
  state.counters["paths"] = benchmark::Counter(samples, benchmark::Counter::kIsRate);
  state.counters["rays_per_path"] = rays / samples;
}

void intersector(benchmark::State& state) {
  const scene::Scene scene = closed_box(static_cast<int>(state.range(0)));
  StageTimer timer;
  const ray_tracing::RayScene ray_scene(scene, timer);
  constexpr std::size_t kRays = 1 << 20;
  for (auto step : state) {
    std::atomic<std::size_t> hits = 0;
    base::parallel_for(kRays, 4096, [&](std::size_t begin, std::size_t end) {
      std::size_t found = 0;
      // A random walk, as incoherent as the path tracer's rays.
      ray_tracing::Ray ray{{0, 0.2F, -0.5F}, {0.3F, 0.2F, 1.0F}};
      ray_tracing::Hit hit;
      for (std::size_t i = begin; i < end; ++i) {
        const auto bits = ray_tracing::hash_combine(7, i);
        const glm::vec2 u(static_cast<float>(bits >> 40) * 0x1p-24F,
                          static_cast<float>(bits & 0xffffffU) * 0x1p-24F);
        if (!ray_scene.intersect(ray, hit)) break;
        ++found;
        const float side = glm::dot(hit.geometric_normal, ray.direction) < 0.0F ? 1.0F : -1.0F;
        const auto frame = ray_tracing::frame_around(side * hit.geometric_normal);
        ray = ray_from(hit, frame.to_world(ray_tracing::cosine_hemisphere(u)));
      }
      hits += found;
    });
    benchmark::DoNotOptimize(hits.load());
  }
  state.counters["rays"] =
      benchmark::Counter(static_cast<double>(kRays) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(path, full, std::vector<std::string>{})
    ->Arg(0)
    ->Arg(128)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(path, direct, std::vector<std::string>{"transport=direct"})
    ->Arg(0)
    ->Arg(128)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(path, random, std::vector<std::string>{"sampler=random"})
    ->Arg(0)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(intersector)->Arg(0)->Arg(128)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
