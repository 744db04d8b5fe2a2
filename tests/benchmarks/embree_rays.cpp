#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <span>
#include <vector>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "perception/base/parallel.h"
#include "renderers/contract/stage_timer.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/pixel_tiles.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/scene/scene_file.h"

/// What the intersector alone does with the rays of `path`: paths of 8 surfaces from every pixel,
/// with a shadow ray to the first light at each. Prints million rays per core second of Embree as a
/// renderer may use it (robust or not), called with nothing around it; then of robust Embree asked
/// for the same rays one by one, in packets of 16 (those of 4 x 4 pixels at the same surface of
/// their paths) and in streams of 256: camera rays, reflected rays, shadow rays.
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

/// The same rays path by path, and by the surface they leave (0: the camera), tile by tile.
struct OrderedRays {
  PathRays by_path;
  std::array<PathRays, kSurfaces> by_surface;
};

/// The rays of one path of a pixel, in order.
void append_path(const ray_tracing::RayScene& rays, Ray ray, std::uint64_t seed, OrderedRays& all) {
  const glm::vec3 light = rays.scene().lights.front().position;
  ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::random, seed, 0);
  Hit hit;
  for (int surface = 0; surface < kSurfaces; ++surface) {
    PathRays& of_surface = all.by_surface[static_cast<std::size_t>(surface)];
    all.by_path.extension.push_back(ray);
    of_surface.extension.push_back(ray);
    if (!rays.intersect(ray, hit)) return;
    const float side = glm::dot(hit.geometric_normal, ray.direction) < 0.0F ? 1.0F : -1.0F;
    const glm::vec3 normal = side * hit.geometric_normal;
    if (glm::dot(normal, light - hit.position) > 0.0F) {
      all.by_path.shadow.push_back(segment_to(hit, light));
      of_surface.shadow.push_back(all.by_path.shadow.back());
    }
    const glm::vec4 u = numbers.next();
    const auto frame = ray_tracing::frame_around(normal);
    ray = ray_from(hit, frame.to_world(ray_tracing::cosine_hemisphere({u.x, u.y})));
  }
}

OrderedRays rays_of(const scene::Scene& scene) {
  StageTimer timer;
  const ray_tracing::RayScene rays(scene, timer);
  const ray_tracing::CameraRays camera(scene.camera, kSide, kSide);
  const base::ThreadLimit one_thread(1);  // tiles in order
  OrderedRays all;
  ray_tracing::for_each_tile(kSide, kSide, [&](const ray_tracing::PixelTile& tile) {
    for (std::size_t i = 0; i < tile.count; ++i) {
      const glm::ivec2 pixel = tile.pixels[i];
      const Ray ray =
          camera.through(static_cast<float>(pixel.x) + 0.5F, static_cast<float>(pixel.y) + 0.5F);
      append_path(rays, ray, static_cast<std::uint64_t>(pixel.y * kSide + pixel.x), all);
    }
  });
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

RTCRayHit query_for_hit(const Ray& ray) {
  RTCRayHit query{};
  query.ray = query_of(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return query;
}

/// Seconds of the cores for all rays.
double core_seconds(RTCScene scene, const PathRays& rays) {
  const std::clock_t start = std::clock();
  base::parallel_for(rays.extension.size(), 4096, [&](std::size_t begin, std::size_t end) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t i = begin; i < end; ++i) {
      RTCRayHit query = query_for_hit(rays.extension[i]);
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

enum class Query { one, packet, stream };

constexpr std::size_t kPacket = 16;
constexpr std::size_t kStream = 256;

/// 16 rays for Embree, those that are missing not valid.
struct Packet {
  RTCRayHit16 rays{};
  alignas(64) std::array<int, kPacket> valid{};

  explicit Packet(std::span<const Ray> from) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      valid[i] = -1;
      rays.ray.org_x[i] = from[i].origin.x;
      rays.ray.org_y[i] = from[i].origin.y;
      rays.ray.org_z[i] = from[i].origin.z;
      rays.ray.dir_x[i] = from[i].direction.x;
      rays.ray.dir_y[i] = from[i].direction.y;
      rays.ray.dir_z[i] = from[i].direction.z;
      rays.ray.tfar[i] = from[i].t_max;
      rays.ray.mask[i] = ~0U;
      rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
  }
};

/// Asks for up to as many rays as a query takes; nothing reads the answers.
/// @param context  says whether the rays are alike
void ask(RTCScene scene, RTCIntersectContext& context, Query query, bool is_shadow,
         std::span<const Ray> rays) {
  if (query == Query::packet) {
    Packet packet(rays);
    if (is_shadow) {
      rtcOccluded16(packet.valid.data(), scene, &context, &packet.rays.ray);
    } else {
      rtcIntersect16(packet.valid.data(), scene, &context, &packet.rays);
    }
    return;
  }
  static thread_local std::array<RTCRayHit, kStream> queries;
  for (std::size_t i = 0; i < rays.size(); ++i) queries[i] = query_for_hit(rays[i]);
  const auto count = static_cast<unsigned>(rays.size());
  if (query == Query::one) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (is_shadow) {
        rtcOccluded1(scene, &context, &queries[i].ray);
      } else {
        rtcIntersect1(scene, &context, &queries[i]);
      }
    }
  } else if (is_shadow) {
    rtcOccluded1M(scene, &context, &queries[0].ray, count, sizeof(RTCRayHit));
  } else {
    rtcIntersect1M(scene, &context, queries.data(), count, sizeof(RTCRayHit));
  }
}

/// Million rays per core second of one way to ask, best of five.
double rate(RTCScene scene, Query query, bool is_coherent, bool is_shadow,
            std::span<const std::vector<Ray>* const> lists) {
  const std::size_t at_once = query == Query::packet ? kPacket : kStream;
  double least_s = 1e9;
  std::size_t count = 0;
  for (int round = 0; round < 5; ++round) {
    const std::clock_t start = std::clock();
    count = 0;
    for (const std::vector<Ray>* list : lists) {
      count += list->size();
      const std::size_t calls = (list->size() + at_once - 1) / at_once;
      base::parallel_for(calls, 64, [&](std::size_t begin, std::size_t end) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        if (is_coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        for (std::size_t call = begin; call < end; ++call) {
          const std::size_t first = call * at_once;
          ask(scene, context, query, is_shadow,
              std::span(*list).subspan(first, std::min(at_once, list->size() - first)));
        }
      });
    }
    least_s = std::min(least_s, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return static_cast<double>(count) / least_s * 1e-6;
}

/// What packets and streams give for each kind of ray.
void print_ways(const scene::Scene& scene, const std::array<PathRays, kSurfaces>& by_surface) {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene target = embree_scene(device, scene, RTC_SCENE_FLAG_ROBUST);
  std::vector<const std::vector<Ray>*> reflected;
  std::vector<const std::vector<Ray>*> shadow;
  for (const PathRays& rays : by_surface) {
    if (&rays != by_surface.data()) reflected.push_back(&rays.extension);
    shadow.push_back(&rays.shadow);
  }
  const std::array<const std::vector<Ray>*, 1> camera{&by_surface.front().extension};
  const auto print = [&](const char* name, bool is_shadow,
                         std::span<const std::vector<Ray>* const> lists) {
    fmt::print("{}-rays-one {:.2f}\n", name, rate(target, Query::one, false, is_shadow, lists));
    for (const bool is_coherent : {false, true}) {
      const char* flag = is_coherent ? "-coherent" : "";
      fmt::print("{}-rays-packet{} {:.2f}\n", name, flag,
                 rate(target, Query::packet, is_coherent, is_shadow, lists));
      fmt::print("{}-rays-stream{} {:.2f}\n", name, flag,
                 rate(target, Query::stream, is_coherent, is_shadow, lists));
    }
  };
  print("camera", false, camera);
  print("reflected", false, reflected);
  print("shadow", true, shadow);
  print("first-shadow", true, std::span(shadow).first(1));
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
  const OrderedRays rays = rays_of(scene);
  print_rate("embree-robust", scene, RTC_SCENE_FLAG_ROBUST, rays.by_path);
  print_rate("embree-fast", scene, RTC_SCENE_FLAG_NONE, rays.by_path);
  print_ways(scene, rays.by_surface);
  return 0;
}
