#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "perception/base/parallel.h"
#include "renderers/contract/stage_timer.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/scene/scene_file.h"

/// What the intersector alone does with the rays of `path`: paths of 8 surfaces from every pixel,
/// with a shadow ray to the first light at each. Prints million rays per core second of Embree as a
/// renderer may use it (robust or not), called with nothing around it.
///
///   benchmark_embree_rays SCENE.yaml
namespace {

using namespace renderers;
using ray_tracing::Hit;
using ray_tracing::Ray;

constexpr int kSide = 512;
constexpr int kSurfaces = 8;

struct PathRays {
  std::vector<Ray> extension;
  std::vector<Ray> shadow;
};

/// The rays of one path of a pixel, in order.
void append_path(const ray_tracing::RayScene& rays, Ray ray, std::uint64_t seed, PathRays& all) {
  const glm::vec3 light = rays.scene().lights.front().position;
  ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::random, seed, 0);
  Hit hit;
  for (int surface = 0; surface < kSurfaces; ++surface) {
    all.extension.push_back(ray);
    if (!rays.intersect(ray, hit)) return;
    const float side = glm::dot(hit.geometric_normal, ray.direction) < 0.0F ? 1.0F : -1.0F;
    const glm::vec3 normal = side * hit.geometric_normal;
    if (glm::dot(normal, light - hit.position) > 0.0F) {
      all.shadow.push_back(segment_to(hit, light));
    }
    const glm::vec4 u = numbers.next();
    const auto frame = ray_tracing::frame_around(normal);
    ray = ray_from(hit, frame.to_world(ray_tracing::cosine_hemisphere({u.x, u.y})));
  }
}

PathRays rays_of(const scene::Scene& scene) {
  StageTimer timer;
  const ray_tracing::RayScene rays(scene, timer);
  const ray_tracing::CameraRays camera(scene.camera, kSide, kSide);
  PathRays all;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Ray ray = camera.through(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      append_path(rays, ray, static_cast<std::uint64_t>(y * kSide + x), all);
    }
  }
  return all;
}

/// The scene's triangles in an Embree scene of their own.
RTCScene embree_scene(RTCDevice device, const scene::Scene& scene, RTCSceneFlags flags) {
  RTCScene target = rtcNewScene(device);
  rtcSetSceneFlags(target, flags);
  for (const scene::Object& object : scene.objects) {
    const scene::Mesh& mesh = *object.mesh;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<glm::vec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(glm::vec3), mesh.positions.size()));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      positions[i] = glm::vec3(object.to_world * glm::vec4(mesh.positions[i], 1.0F));
    }
    auto* triangles = static_cast<glm::uvec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(glm::uvec3), mesh.triangles.size()));
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(target, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(target);
  return target;
}

RTCRay query_of(const Ray& ray) {
  const glm::vec3& o = ray.origin;
  const glm::vec3& d = ray.direction;
  return {o.x, o.y, o.z, 0.0F, d.x, d.y, d.z, 0.0F, ray.t_max, ~0U, 0U, 0U};
}

/// Seconds of the cores for all rays.
double core_seconds(RTCScene scene, const PathRays& rays) {
  const std::clock_t start = std::clock();
  base::parallel_for(rays.extension.size(), 4096, [&](std::size_t begin, std::size_t end) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t i = begin; i < end; ++i) {
      RTCRayHit query;
      query.ray = query_of(rays.extension[i]);
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene, &context, &query);
    }
  });
  base::parallel_for(rays.shadow.size(), 4096, [&](std::size_t begin, std::size_t end) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t i = begin; i < end; ++i) {
      RTCRay query = query_of(rays.shadow[i]);
      rtcOccluded1(scene, &context, &query);
    }
  });
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void print_rate(const char* name, const scene::Scene& scene, RTCSceneFlags flags,
                const PathRays& rays) {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene target = embree_scene(device, scene, flags);
  double least_s = core_seconds(target, rays);
  for (int i = 0; i < 4; ++i) least_s = std::min(least_s, core_seconds(target, rays));
  const auto count = static_cast<double>(rays.extension.size() + rays.shadow.size());
  fmt::print("{} {:.2f}\n", name, count / least_s * 1e-6);
  rtcReleaseScene(target);
  rtcReleaseDevice(device);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: benchmark_embree_rays SCENE.yaml\n", stderr);
    return 2;
  }
  const scene::Scene scene = scene::read_scene_file(argv[1]).at_frame(0);
  const PathRays rays = rays_of(scene);
  print_rate("embree-robust", scene, RTC_SCENE_FLAG_ROBUST, rays);
  print_rate("embree-fast", scene, RTC_SCENE_FLAG_NONE, rays);
  return 0;
}
