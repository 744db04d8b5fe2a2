#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "renderers/area_shadows/gpu_visibility.h"
#include "renderers/gpu_tracing/triangle_bvh.h"
#include "renderers/scene/scene_file.h"
#include "tests/places.h"

/// Shadow rays from every pixel to 64 points of each light, by compute shaders of the device and by
/// Embree, in turn: rays per second of both and their ratio, which a busy machine changes least.
///
/// `boxes` are those that a ray of the device tests if nothing ends it. On Mesa's software driver
/// eight rays go together as long as one of them has boxes left, and nodes and triangles, eight
/// different ones at worst, are read number by number: time is boxes: as many a second in
/// every scene of some size. Embree tests eight boxes of one ray at a time, and four triangles.
namespace {

using namespace renderers;
using area_shadows::GroupRays;

constexpr int kWidth_px = 128;
constexpr int kHeight_px = 96;

scene::Scene scene_named(const std::string& name) {
  const auto folder = std::filesystem::path(tests::kSourceFolder) / "suites" / "scenes";
  return scene::read_scene_file(folder / (name + ".yaml")).at_frame(0);
}

/// All rays of one picture.
struct Setting {
  explicit Setting(const std::string& name) : scene(scene_named(name)), rays(scene, timer) {
    RenderJob job;
    job.width_px = kWidth_px;
    job.height_px = kHeight_px;
    job.camera = scene.camera;
    surfaces = area_shadows::find_pixel_surfaces(rays, job);
    lights = ray_tracing::make_light_points(rays, 64, 1);
    for (const std::uint32_t pixel : area_shadows::surface_pixels(surfaces)) {
      for (std::size_t light = 0; light < lights.size(); ++light) {
        for (std::size_t group = 0; group < lights[light].group_count(); ++group) {
          groups.push_back(area_shadows::rays_to_group(surfaces, lights, pixel, light, group));
        }
      }
    }
    std::erase_if(groups, [](const GroupRays& group) { return group.facing == 0; });
    visible.resize(groups.size());
  }

  StageTimer timer;
  scene::Scene scene;
  ray_tracing::RayScene rays;
  area_shadows::PixelSurfaces surfaces;
  std::vector<ray_tracing::LightPointSet> lights;
  std::vector<GroupRays> groups;
  std::vector<std::uint16_t> visible;
};

/// Boxes that a ray tests on its whole way.
double boxes_on(const gpu_tracing::TriangleBvh& bvh, const glm::vec3& origin,
                const glm::vec3& direction, float t_max) {
  double boxes = 0.0;
  for (std::uint32_t node = 0; node < bvh.nodes.size(); ++boxes) {
    const gpu_tracing::BvhNode& box = bvh.nodes[node];
    const glm::vec3 to_low = (box.low - origin) / direction;
    const glm::vec3 to_high = (box.high - origin) / direction;
    const glm::vec3 enters = glm::min(to_low, to_high);
    const glm::vec3 leaves = glm::max(to_low, to_high);
    const float first = std::max({enters.x, enters.y, enters.z, 0.0F});
    node = first > std::min({leaves.x, leaves.y, leaves.z, t_max}) ? box.skip : node + 1;
  }
  return boxes;
}

/// Mean over the first ray of each group.
double mean_boxes(const Setting& setting, const gpu_tracing::TriangleBvh& bvh) {
  double sum = 0.0;
  for (const GroupRays& group : setting.groups) {
    const ray_tracing::LightPointSet& light = setting.lights[group.light];
    const glm::vec3& target = light.group(group.group).front().target;
    const glm::vec3& origin = setting.surfaces.pixels[group.pixel].receiver.origin;
    sum += light.is_environment
               ? boxes_on(bvh, origin, target, std::numeric_limits<float>::infinity())
               : boxes_on(bvh, origin, target - origin, ray_tracing::kSegmentEnd);
  }
  return sum / static_cast<double>(setting.groups.size());
}

double seconds_of(area_shadows::PointVisibility& visibility, Setting& setting) {
  const double start_s = steady_seconds();
  visibility.find(setting.groups, setting.visible, setting.timer);
  return steady_seconds() - start_s;
}

void shadow_rays(benchmark::State& state, const std::string& name) {
  Setting setting(name);
  const auto context = opengl::Context::create("auto");
  area_shadows::DeviceRays device(context);
  const gpu_tracing::TriangleBvh bvh = gpu_tracing::build_bvh(setting.rays);
  device.bvh.load(bvh, setting.timer);
  area_shadows::GpuVisibility gpu(device, setting.surfaces, setting.lights, setting.timer);
  area_shadows::EmbreeVisibility embree(setting.rays, setting.surfaces, setting.lights);
  seconds_of(gpu, setting);  // compiles
  double gpu_s = 0.0;
  double embree_s = 0.0;
  for (auto step : state) {
    const double of_gpu_s = seconds_of(gpu, setting);
    gpu_s += of_gpu_s;
    embree_s += seconds_of(embree, setting);
    state.SetIterationTime(of_gpu_s);
  }
  const double rays = static_cast<double>(state.iterations()) *
                      static_cast<double>(area_shadows::count_rays(setting.groups));
  state.counters["device_rays_per_s"] = rays / gpu_s;
  state.counters["embree_rays_per_s"] = rays / embree_s;
  state.counters["device_by_embree"] = embree_s / gpu_s;
  state.counters["boxes"] = mean_boxes(setting, bvh);
  state.counters["triangles"] = static_cast<double>(bvh.triangles.size());
  state.SetLabel(context->facts().renderer);
}

BENCHMARK_CAPTURE(shadow_rays, bar_under_lamp, std::string("bar-under-lamp"))->UseManualTime();
BENCHMARK_CAPTURE(shadow_rays, atrium_area, std::string("atrium-area"))->UseManualTime();
BENCHMARK_CAPTURE(shadow_rays, common_atrium, std::string("common-atrium"))->UseManualTime();
BENCHMARK_CAPTURE(shadow_rays, cornell_bunny, std::string("cornell-bunny"))->UseManualTime();

}  // namespace

BENCHMARK_MAIN();
