#include "renderers/ray_tracing/ray_scene.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <string>
#include <vector>

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "perception/base/errors.h"

namespace renderers::ray_tracing {

namespace {

/// One object in world space; positions and indices lie in Embree's buffers.
struct WorldObject {
  const glm::vec3* positions = nullptr;
  const glm::uvec3* triangles = nullptr;
  std::vector<std::array<glm::vec3, 3>> corners;  ///< per triangle: one place in memory, not four
  std::vector<glm::vec3> normals;                 ///< per vertex, or empty
  const glm::vec2* uvs = nullptr;                 ///< per vertex, or null
  std::size_t triangle_count = 0;
  int material = 0;
};

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<RTCDeviceTy, DeviceRelease>;
using SceneHandle = std::unique_ptr<RTCSceneTy, SceneRelease>;

std::string error_text(RTCError error) {
  switch (error) {
    case RTC_ERROR_NONE:
      return "no error";
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "unsupported CPU (SSE2 is needed)";
    case RTC_ERROR_CANCELLED:
      return "cancelled";
    case RTC_ERROR_UNKNOWN:
      break;
  }
  return "unknown error";
}

void check(RTCDevice device, const char* step) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  throw base::DeviceError("Embree: " + error_text(error) + " while " + step);
}

bool count_memory(void* total, ssize_t bytes, bool) {
  static_cast<std::atomic<std::int64_t>*>(total)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

/// True if the transform mirrors, so that counter-clockwise triangles become clockwise.
bool is_mirroring(const glm::mat4& to_world) {
  return glm::determinant(glm::mat3(to_world)) < 0.0F;
}

std::vector<glm::vec3> world_normals(const scene::Object& object) {
  const glm::mat3 transform = glm::transpose(glm::inverse(glm::mat3(object.to_world)));
  std::vector<glm::vec3> normals;
  normals.reserve(object.mesh->normals.size());
  for (const glm::vec3& normal : object.mesh->normals) {
    normals.push_back(glm::normalize(transform * normal));
  }
  return normals;
}

/// Interpolated vertex normal on the side of the geometric one.
glm::vec3 shading_normal(const WorldObject& world, const glm::uvec3& index, const glm::vec3& weight,
                         const glm::vec3& geometric_normal) {
  const glm::vec3 normal = weight.x * world.normals[index.x] + weight.y * world.normals[index.y] +
                           weight.z * world.normals[index.z];
  // Opposite vertex normals may cancel out; the flat normal is the only one left then.
  const float length = glm::length(normal);
  if (length <= 0.0F) return geometric_normal;
  return glm::dot(normal, geometric_normal) < 0.0F ? normal / -length : normal / length;
}

/// From the ray's origin to its end, at time 0, for every geometry.
RTCRay embree_ray(const Ray& ray) {
  return {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          0.0F,
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          0.0F,
          ray.t_max,
          ~0U,
          0U,
          0U};
}

/// Rays of a packet of zeros; the others are not valid.
[[gnu::always_inline]] inline void fill_packet(std::span<const Ray> rays, RTCRay16& packet,
                                               std::array<int, kPacketRays>& valid) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    valid[i] = -1;
    packet.org_x[i] = rays[i].origin.x;
    packet.org_y[i] = rays[i].origin.y;
    packet.org_z[i] = rays[i].origin.z;
    packet.dir_x[i] = rays[i].direction.x;
    packet.dir_y[i] = rays[i].direction.y;
    packet.dir_z[i] = rays[i].direction.z;
    packet.tfar[i] = rays[i].t_max;
    packet.mask[i] = ~0U;
  }
}

/// Embree's context, followed by where hits go.
struct AllHitsContext {
  RTCIntersectContext base;
  std::vector<LineHit>* hits = nullptr;
};

/// Notes every hit of a packet and turns it down, so that traversal goes on to the rays' ends.
void note_and_reject(const RTCFilterFunctionNArguments* arguments) {
  auto* hits = reinterpret_cast<AllHitsContext*>(arguments->context)->hits;
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    arguments->valid[i] = 0;
    RTCRayN* ray = arguments->ray;
    RTCHitN* hit = arguments->hit;
    const glm::vec3 direction(RTCRayN_dir_x(ray, n, i), RTCRayN_dir_y(ray, n, i),
                              RTCRayN_dir_z(ray, n, i));
    const glm::vec3 normal(RTCHitN_Ng_x(hit, n, i), RTCHitN_Ng_y(hit, n, i),
                           RTCHitN_Ng_z(hit, n, i));
    hits->push_back({RTCRayN_tfar(ray, n, i),
                     RTCRayN_id(ray, n, i),
                     RTCHitN_geomID(hit, n, i),
                     RTCHitN_primID(hit, n, i),
                     {RTCHitN_u(hit, n, i), RTCHitN_v(hit, n, i)},
                     glm::dot(normal, direction) < 0.0F});
  }
}

}  // namespace

struct RayScene::Content {
  const scene::Scene* scene = nullptr;
  std::atomic<std::int64_t> embree_bytes = 0;
  DeviceHandle device;
  SceneHandle embree_scene;
  std::vector<WorldObject> objects;
  std::size_t triangle_count = 0;
  glm::vec3 box_min{std::numeric_limits<float>::infinity()};
  glm::vec3 box_max{-std::numeric_limits<float>::infinity()};

  void open_device(RayQueries queries);
  void add(const scene::Object& object);
  void copy_positions(const scene::Object& object, glm::vec3* positions);
  void find_point(std::uint32_t object, std::uint32_t triangle, const glm::vec2& barycentrics,
                  SurfacePoint& point) const;
};

void RayScene::Content::open_device(RayQueries queries) {
  device.reset(rtcNewDevice(nullptr));
  if (!device) {
    throw base::DeviceError("Embree: no device, " + error_text(rtcGetDeviceError(nullptr)));
  }
  rtcSetDeviceMemoryMonitorFunction(device.get(), count_memory, &embree_bytes);
  embree_scene.reset(rtcNewScene(device.get()));
  check(device.get(), "making a scene");
  // Filters cost every query a little.
  const int filter = queries == RayQueries::all_hits ? RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION
                                                     : RTC_SCENE_FLAG_NONE;
  rtcSetSceneFlags(embree_scene.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | filter));
}

void RayScene::Content::copy_positions(const scene::Object& object, glm::vec3* positions) {
  for (std::size_t i = 0; i < object.mesh->positions.size(); ++i) {
    positions[i] = glm::vec3(object.to_world * glm::vec4(object.mesh->positions[i], 1.0F));
    box_min = glm::min(box_min, positions[i]);
    box_max = glm::max(box_max, positions[i]);
  }
}

void RayScene::Content::add(const scene::Object& object) {
  const scene::Mesh& mesh = *object.mesh;
  RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<glm::vec3*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(glm::vec3), mesh.positions.size()));
  auto* triangles = static_cast<glm::uvec3*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              sizeof(glm::uvec3), mesh.triangles.size()));
  const bool has_triangles = !mesh.triangles.empty();
  if (has_triangles) check(device.get(), "making the buffers of a mesh");

  if (has_triangles) copy_positions(object, positions);
  const bool mirrors = is_mirroring(object.to_world);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3& t = mesh.triangles[i];
    triangles[i] = mirrors ? glm::uvec3(t.x, t.z, t.y) : t;
  }

  WorldObject& world = objects.emplace_back();
  world.positions = positions;
  world.triangles = triangles;
  world.corners.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3& t = triangles[i];
    world.corners.push_back({positions[t.x], positions[t.y], positions[t.z]});
  }
  world.normals = world_normals(object);
  world.uvs = mesh.uvs.empty() ? nullptr : mesh.uvs.data();
  world.triangle_count = mesh.triangles.size();
  world.material = object.material;
  triangle_count += mesh.triangles.size();

  rtcCommitGeometry(geometry);
  if (has_triangles) {
    rtcAttachGeometryByID(embree_scene.get(), geometry, static_cast<unsigned>(objects.size() - 1));
  }
  rtcReleaseGeometry(geometry);
}

RayScene::RayScene(const scene::Scene& scene, StageTimer& timer, RayQueries queries)
    : content_(std::make_unique<Content>()) {
  content_->scene = &scene;
  {
    const auto stage = timer.stage("triangles");
    content_->open_device(queries);
    content_->objects.reserve(scene.objects.size());
    for (const scene::Object& object : scene.objects) content_->add(object);
  }
  auto stage = timer.stage("bvh");
  rtcCommitScene(content_->embree_scene.get());
  check(content_->device.get(), "building the BVH");
  stage.add_bytes(memory_bytes());
}

RayScene::~RayScene() = default;

void RayScene::follow(const scene::Scene& scene) {
  assert(scene.objects.size() == content_->objects.size());
  content_->scene = &scene;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const scene::Mesh& mesh = *scene.objects[i].mesh;
    assert(mesh.triangles.size() == content_->objects[i].triangle_count);
    content_->objects[i].uvs = mesh.uvs.empty() ? nullptr : mesh.uvs.data();
  }
}

bool RayScene::nearest(const Ray& ray, LineHit& hit) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query;
  query.ray = embree_ray(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(content_->embree_scene.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit.t = query.ray.tfar;
  hit.ray = 0;
  hit.object = query.hit.geomID;
  hit.triangle = query.hit.primID;
  hit.barycentrics = {query.hit.u, query.hit.v};
  const glm::vec3 normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
  hit.looks_back = glm::dot(normal, ray.direction) < 0.0F;
  return true;
}

bool RayScene::intersect(const Ray& ray, Hit& hit) const {
  LineHit found;
  if (!nearest(ray, found)) return false;
  hit = hit_at(found);
  return true;
}

Hit RayScene::hit_at(const LineHit& found) const {
  Hit hit;
  content_->find_point(found.object, found.triangle, found.barycentrics, hit);
  hit.t = found.t;
  return hit;
}

std::uint32_t RayScene::nearest(std::span<const Ray> rays, std::span<LineHit> hits,
                                RayOrder order) const {
  assert(rays.size() <= kPacketRays && hits.size() >= rays.size());
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (order == RayOrder::beside) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRayHit16 packet{};
  alignas(64) std::array<int, kPacketRays> valid{};
  fill_packet(rays, packet.ray, valid);
  std::ranges::fill(packet.hit.geomID, RTC_INVALID_GEOMETRY_ID);
  std::ranges::fill(packet.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
  rtcIntersect16(valid.data(), content_->embree_scene.get(), &context, &packet);
  std::uint32_t found = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    found |= 1U << i;
    const glm::vec3 normal(packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]);
    hits[i] = {packet.ray.tfar[i],
               static_cast<std::uint32_t>(i),
               packet.hit.geomID[i],
               packet.hit.primID[i],
               {packet.hit.u[i], packet.hit.v[i]},
               glm::dot(normal, rays[i].direction) < 0.0F};
    // Who asks for the points next finds the triangles in the cache.
    __builtin_prefetch(&content_->objects[hits[i].object].corners[hits[i].triangle]);
  }
  return found;
}

bool RayScene::is_occluded(const Ray& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay query = embree_ray(ray);
  rtcOccluded1(content_->embree_scene.get(), &context, &query);
  return query.tfar < 0.0F;
}

std::uint32_t RayScene::occluded_mask(std::span<const Ray> rays) const {
  assert(rays.size() <= kPacketRays);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  // The flag for coherent rays stays off: with it, even rays from one point are slower.
  RTCRay16 packet{};
  alignas(64) std::array<int, kPacketRays> valid{};
  fill_packet(rays, packet, valid);
  rtcOccluded16(valid.data(), content_->embree_scene.get(), &context, &packet);
  std::uint32_t mask = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (packet.tfar[i] < 0.0F) mask |= 1U << i;
  }
  return mask;
}

void RayScene::all_hits(std::span<const Ray> rays, std::vector<LineHit>& hits) const {
  assert(rays.size() <= kPacketRays);
  AllHitsContext context;
  rtcInitIntersectContext(&context.base);
  context.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.base.filter = note_and_reject;
  context.hits = &hits;
  RTCRayHit16 packet{};
  alignas(64) std::array<int, kPacketRays> valid{};
  fill_packet(rays, packet.ray, valid);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    packet.ray.id[i] = static_cast<unsigned>(i);
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect16(valid.data(), content_->embree_scene.get(), &context.base, &packet);
}

/// @param point  fresh; receives, in place, as copies of what was just written in parts wait for it
void RayScene::Content::find_point(std::uint32_t object, std::uint32_t triangle,
                                   const glm::vec2& barycentrics, SurfacePoint& point) const {
  const WorldObject& world = objects[object];
  const auto& [a, b, c] = world.corners[triangle];
  const glm::vec3 scaled_normal = glm::cross(b - a, c - a);

  point.object = object;
  point.triangle = triangle;
  point.material = world.material;
  point.position_error = triangle_point_error(a, b, c);
  const glm::vec3 weight =
      weights_off_edges({1.0F - barycentrics.x - barycentrics.y, barycentrics.x, barycentrics.y}, a,
                        b, c, scaled_normal, point.position_error);
  point.barycentrics = {weight.y, weight.z};
  point.position = weight.x * a + weight.y * b + weight.z * c;
  point.geometric_normal = glm::normalize(scaled_normal);
  point.shading_normal = point.geometric_normal;
  if (world.normals.empty() && world.uvs == nullptr) return;
  const glm::uvec3 index = world.triangles[triangle];
  if (!world.normals.empty()) {
    point.shading_normal = shading_normal(world, index, weight, point.geometric_normal);
  }
  if (world.uvs != nullptr) {
    point.uv = weight.x * world.uvs[index.x] + weight.y * world.uvs[index.y] +
               weight.z * world.uvs[index.z];
  }
}

SurfacePoint RayScene::point_on_triangle(std::uint32_t object, std::uint32_t triangle,
                                         const glm::vec2& barycentrics) const {
  SurfacePoint point;
  content_->find_point(object, triangle, barycentrics, point);
  return point;
}

const std::array<glm::vec3, 3>& RayScene::triangle_corners(std::uint32_t object,
                                                           std::uint32_t triangle) const {
  return content_->objects[object].corners[triangle];
}

float RayScene::triangle_area_m2(std::uint32_t object, std::uint32_t triangle) const {
  const WorldObject& world = content_->objects[object];
  const glm::uvec3 index = world.triangles[triangle];
  const glm::vec3& a = world.positions[index.x];
  return 0.5F * glm::length(glm::cross(world.positions[index.y] - a, world.positions[index.z] - a));
}

const scene::Scene& RayScene::scene() const { return *content_->scene; }
std::size_t RayScene::triangle_count() const { return content_->triangle_count; }
const glm::vec3& RayScene::box_min() const { return content_->box_min; }
const glm::vec3& RayScene::box_max() const { return content_->box_max; }

std::int64_t RayScene::memory_bytes() const {
  std::int64_t bytes = content_->embree_bytes.load();
  for (const WorldObject& world : content_->objects) {
    bytes += static_cast<std::int64_t>(world.normals.size() * sizeof(glm::vec3) +
                                       world.corners.size() * sizeof(world.corners[0]));
  }
  return bytes;
}

}  // namespace renderers::ray_tracing
