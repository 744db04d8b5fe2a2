#include "renderers/ray_tracing/light_points.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/environment_sampler.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/piecewise_distribution.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::ray_tracing {

namespace {

/// Places of a texture that a point's share is averaged over, along each side of its cell.
constexpr int kCellPlaces = 4;
/// Against a division by 0 where a receiver lies on a light's point, m4.
constexpr float kLeastD4 = std::numeric_limits<float>::min();
/// Largest distance between corners that count as one, relative to an edge.
constexpr float kSameCorner = 1e-4F;

/// A triangle, or two that make the parallelogram v0 v1 v2 v3 with the diagonal v0 v2.
struct Patch {
  std::uint32_t object = 0;
  std::array<std::uint32_t, 2> triangles{};
  std::array<int, 2> turns{};  ///< which vertex of each triangle is v0
  bool is_pair = false;
  float area_m2 = 0.0F;
};

/// Weights of the vertices turn, turn + 1, turn + 2 as barycentrics of a triangle.
glm::vec2 turned(const glm::vec3& weights, int turn) {
  glm::vec3 own(0.0F);
  for (int i = 0; i < 3; ++i) own[(i + turn) % 3] = weights[i];
  return {own.y, own.z};
}

class PatchFinder {
 public:
  PatchFinder(const RayScene& rays, std::uint32_t object) : rays_(rays), object_(object) {}

  std::vector<Patch> patches() const {
    const auto count =
        static_cast<std::uint32_t>(rays_.scene().objects[object_].mesh->triangles.size());
    std::vector<Patch> found;
    for (std::uint32_t t = 0; t < count; ++t) {
      Patch patch{object_, {t, t}, {}, false, rays_.triangle_area_m2(object_, t)};
      if (t + 1 < count && joins(t, patch)) ++t;
      if (patch.area_m2 > 0.0F) found.push_back(patch);
    }
    return found;
  }

 private:
  std::array<glm::vec3, 3> corners(std::uint32_t triangle) const {
    return {rays_.point_on_triangle(object_, triangle, {0, 0}).position,
            rays_.point_on_triangle(object_, triangle, {1, 0}).position,
            rays_.point_on_triangle(object_, triangle, {0, 1}).position};
  }

  /// Whether triangles t and t + 1 are a parallelogram; completes the patch then.
  bool joins(std::uint32_t t, Patch& patch) const {
    if (patch.area_m2 <= 0.0F || rays_.triangle_area_m2(object_, t + 1) <= 0.0F) return false;
    const auto a = corners(t);
    const auto b = corners(t + 1);
    for (std::size_t i = 0; i < 9; ++i) {
      const std::size_t j = i / 3;
      const glm::vec3& v0 = a[i % 3];
      const glm::vec3& v1 = a[(i + 1) % 3];
      const glm::vec3& v2 = a[(i + 2) % 3];
      const float limit = kSameCorner * glm::distance(v0, v2);
      const bool is_parallelogram = glm::distance(b[j], v0) < limit &&
                                    glm::distance(b[(j + 1) % 3], v2) < limit &&
                                    glm::distance(v0 + v2 - v1, b[(j + 2) % 3]) < limit;
      if (!is_parallelogram) continue;
      patch.triangles[1] = t + 1;
      patch.turns = {static_cast<int>(i % 3), static_cast<int>(j)};
      patch.is_pair = true;
      patch.area_m2 += rays_.triangle_area_m2(object_, t + 1);
      return true;
    }
    return false;
  }

  const RayScene& rays_;
  std::uint32_t object_;
};

/// Area-preserving map from the unit square.
SurfacePoint point_on(const RayScene& rays, const Patch& patch, const glm::vec2& u) {
  if (!patch.is_pair) {
    return rays.point_on_triangle(patch.object, patch.triangles[0], uniform_triangle(u));
  }
  // P = v0 + u.x (v1 - v0) + u.y (v2 - v1), on either side of the diagonal.
  if (u.x >= u.y) {
    return rays.point_on_triangle(patch.object, patch.triangles[0],
                                  turned({1.0F - u.x, u.x - u.y, u.y}, patch.turns[0]));
  }
  return rays.point_on_triangle(patch.object, patch.triangles[1],
                                turned({1.0F - u.y, u.x, u.y - u.x}, patch.turns[1]));
}

void add_plane(const RayScene& rays, const Patch& patch, LightPointSet& set) {
  const SurfacePoint inside = point_on(rays, patch, {0.5F, 0.25F});
  set.planes.push_back({inside.position, inside.geometric_normal});
  for (std::size_t i = 0; i < (patch.is_pair ? 2U : 1U); ++i) {
    for (const glm::vec2& corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)}) {
      set.corners.push_back(
          rays.point_on_triangle(patch.object, patch.triangles[i], corner).position);
    }
  }
}

/// Point `index` of the sequence; its first two coordinates are a (0, 2)-sequence.
glm::vec2 square_point(std::uint32_t index, std::uint64_t seed) {
  const auto bits = sobol_point(index);
  constexpr float kScale = 1.0F / static_cast<float>(1 << 24);
  const auto coordinate = [&](std::size_t axis) {
    const auto hash = static_cast<std::uint32_t>(hash_combine(seed, axis));
    return static_cast<float>(owen_scramble(bits[axis], hash) >> 8) * kScale;
  };
  return {coordinate(0), coordinate(1)};
}

/// One light's emission and area, by places in the unit square.
class LightArea {
 public:
  LightArea(const RayScene& rays, const LightSampler& emission, std::vector<Patch> patches)
      : rays_(rays), emission_(emission), patches_(std::move(patches)) {
    std::vector<double> areas;
    for (const Patch& patch : patches_) areas.push_back(static_cast<double>(patch.area_m2));
    choice_ = PiecewiseDistribution(areas);
    const scene::Scene& scene = rays.scene();
    const auto material = static_cast<std::size_t>(scene.objects[patches_[0].object].material);
    is_textured_ = scene.materials[material].emission_texture != scene::kNoTexture;
  }

  double area_m2() const { return choice_.total(); }
  SurfacePoint at(const glm::vec2& u) const {
    const auto chosen = choice_.choose(u.x);
    return point_on(rays_, patches_[chosen.index], {chosen.rest, u.y});
  }
  /// Mean radiance over the cell of the unit square that the point lies in. @param cells  each way
  glm::vec3 radiance(const glm::vec2& u, const glm::vec2& cells) const {
    if (!is_textured_) return radiance_at(u);
    const glm::vec2 corner = glm::floor(u * cells);
    glm::vec3 sum(0.0F);
    for (int i = 0; i < kCellPlaces * kCellPlaces; ++i) {
      const glm::vec2 inside((static_cast<float>(i % kCellPlaces) + 0.5F) / kCellPlaces,
                             (static_cast<float>(i / kCellPlaces) + 0.5F) / kCellPlaces);
      sum += radiance_at((corner + inside) / cells);
    }
    return sum / static_cast<float>(kCellPlaces * kCellPlaces);
  }

 private:
  glm::vec3 radiance_at(const glm::vec2& u) const {
    const SurfacePoint point = at(u);
    return emission_.emission(point, point.geometric_normal);
  }

  const RayScene& rays_;
  const LightSampler& emission_;
  std::vector<Patch> patches_;
  PiecewiseDistribution choice_;
  bool is_textured_ = false;
};

/// Cells of the unit square, one for each of 2^k points of a (0, 2)-sequence.
glm::vec2 cells_of(int count) {
  const int bits = std::bit_width(static_cast<unsigned>(count)) - 1;
  return {static_cast<float>(1 << (bits - bits / 2)), static_cast<float>(1 << (bits / 2))};
}

std::optional<LightPointSet> points_of(const RayScene& rays, const LightSampler& emission,
                                       std::uint32_t object, int count, std::uint64_t seed) {
  std::vector<Patch> patches = PatchFinder(rays, object).patches();
  if (patches.empty()) return std::nullopt;
  LightPointSet set;
  for (const Patch& patch : patches) add_plane(rays, patch, set);
  const LightArea area(rays, emission, std::move(patches));
  const float share_m2 = static_cast<float>(area.area_m2()) / static_cast<float>(count);
  for (int i = 0; i < count; ++i) {
    const glm::vec2 u = square_point(static_cast<std::uint32_t>(i), seed);
    const SurfacePoint point = area.at(u);
    const glm::vec3& normal = point.geometric_normal;
    set.points.push_back({point.position,
                          offset_from_surface(point.position, point.position_error, normal, normal),
                          normal, share_m2 * area.radiance(u, cells_of(count))});
  }
  return set;
}

std::optional<LightPointSet> points_of_environment(const scene::Environment& environment, int count,
                                                   std::uint64_t seed) {
  const EnvironmentSampler sampler(environment);
  if (sampler.power() <= 0.0) return std::nullopt;
  LightPointSet set;
  set.is_environment = true;
  for (int i = 0; i < count; ++i) {
    const auto drawn = sampler.sample(square_point(static_cast<std::uint32_t>(i), seed));
    LightPoint point;
    point.position = point.target = drawn.direction;
    if (drawn.pdf > 0.0F) {
      point.power = scene::sample_environment(environment, drawn.direction) /
                    (drawn.pdf * static_cast<float>(count));
    }
    set.points.push_back(point);
  }
  return set;
}

/// Writes the points' coordinates group by group.
void pack_groups(LightPointSet& set) {
  set.coordinates.resize(set.group_count());
  for (std::size_t i = 0; i < set.points.size(); ++i) {
    GroupCoordinates& group = set.coordinates[i / set.group_size];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<int>(axis);
      group.position[axis][i % set.group_size] = set.points[i].position[a];
      group.normal[axis][i % set.group_size] = set.points[i].normal[a];
      group.power[i % set.group_size][axis] = set.points[i].power[a];
    }
  }
}

}  // namespace

std::vector<LightPointSet> make_light_points(const RayScene& rays, int count, std::uint64_t seed,
                                             std::size_t group_size) {
  assert(group_size >= 1 && group_size <= kGroupPoints);
  assert(count >= 4 && std::has_single_bit(static_cast<unsigned>(count)));
  const scene::Scene& scene = rays.scene();
  const LightSampler emission(rays, LightSet::hittable);
  std::vector<LightPointSet> sets;
  const auto add = [&](std::optional<LightPointSet> set) {
    if (!set) return;
    set->group_size = group_size;
    pack_groups(*set);
    set->has_one_power = std::ranges::all_of(set->points, [&](const LightPoint& point) {
      return point.power == set->points.front().power;
    });
    sets.push_back(std::move(*set));
  };
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    const auto material = static_cast<std::size_t>(scene.objects[object].material);
    if (!scene.materials[material].is_emissive()) continue;
    add(points_of(rays, emission, object, count, hash_combine(seed, object)));
  }
  if (scene.environment) {
    add(points_of_environment(*scene.environment, count, hash_combine(seed, scene.objects.size())));
  }
  return sets;
}

Receiver receiver_at(const SurfacePoint& point, const glm::vec3& viewer) {
  const float side = glm::dot(point.geometric_normal, viewer - point.position) < 0 ? -1.0F : 1.0F;
  Receiver receiver;
  receiver.position = point.position;
  receiver.geometric_normal = side * point.geometric_normal;
  receiver.normal = side * point.shading_normal;
  receiver.origin = offset_from_surface(point.position, point.position_error,
                                        receiver.geometric_normal, receiver.geometric_normal);
  return receiver;
}

bool may_shine_on(const LightPointSet& light, const Receiver& receiver) {
  if (light.is_environment) return true;
  const bool is_above = std::ranges::any_of(light.corners, [&](const glm::vec3& corner) {
    const glm::vec3 to_light = corner - receiver.position;
    return glm::dot(to_light, receiver.normal) > 0.0F;
  });
  return is_above && std::ranges::any_of(light.planes, [&](const LightPointSet::Plane& plane) {
           return glm::dot(receiver.position - plane.point, plane.normal) > 0.0F;
         });
}

namespace {

/// Factors of the points of a group. Without branches, so that several are worked out at once.
[[gnu::always_inline]] inline void find_factors(const LightPointSet& light, std::size_t group,
                                                const Receiver& receiver,
                                                GroupCoordinates::Values& values) {
  const GroupCoordinates& at = light.coordinates[group];
  const glm::vec3 from = light.is_environment ? glm::vec3(0.0F) : receiver.position;
  const glm::vec3& n = receiver.normal;
  const glm::vec3& g = receiver.geometric_normal;
  for (std::size_t k = 0; k < kGroupPoints; ++k) {
    const float x = at.position[0][k] - from.x;
    const float y = at.position[1][k] - from.y;
    const float z = at.position[2][k] - from.z;
    const float cosine = n.x * x + n.y * y + n.z * z;
    const float above = g.x * x + g.y * y + g.z * z;
    const float d2 = x * x + y * y + z * z;
    const float before = -(at.normal[0][k] * x + at.normal[1][k] * y + at.normal[2][k] * z);
    // cos cos' / d2 with both cosines from the vector between the points: (n . v)(-n' . v) / d4.
    const float by_d2 = light.is_environment ? 1.0F : before / std::max(d2 * d2, kLeastD4);
    const float value = cosine * by_d2;
    values[k] = (cosine > 0.0F) & (above > 0.0F) & (by_d2 > 0.0F) ? value : 0.0F;
  }
}

/// Sum of all factors, in an order that is the same however many are added at once.
[[gnu::target_clones("avx2", "default")]] float factor_sum(const LightPointSet& light,
                                                           const Receiver& receiver) {
  GroupCoordinates::Values sums{};
  for (std::size_t group = 0; group < light.coordinates.size(); ++group) {
    GroupCoordinates::Values values;
    find_factors(light, group, receiver, values);
    for (std::size_t k = 0; k < kGroupPoints; ++k) sums[k] += values[k];
  }
  float sum = 0.0F;
  for (const float value : sums) sum += value;
  return sum;
}

}  // namespace

// Eight at a time where the processor can; products and sums are not fused, so bits are the same.
[[gnu::target_clones("avx2", "default")]] GroupFactors group_factors(const LightPointSet& light,
                                                                     std::size_t group,
                                                                     const Receiver& receiver) {
  GroupFactors factors;
  find_factors(light, group, receiver, factors.values);
  // Those of missing points are 0.
  for (std::size_t k = 0; k < kGroupPoints; ++k) {
    factors.facing |= factors.values[k] > 0.0F ? 1U << k : 0U;
  }
  return factors;
}

[[gnu::target_clones("avx2", "default")]] std::uint32_t facing_points(const LightPointSet& light,
                                                                      std::size_t group,
                                                                      const Receiver& receiver) {
  const GroupCoordinates& at = light.coordinates[group];
  const glm::vec3 from = light.is_environment ? glm::vec3(0.0F) : receiver.position;
  const glm::vec3& n = receiver.normal;
  const glm::vec3& g = receiver.geometric_normal;
  const float whatever = light.is_environment ? 1.0F : 0.0F;  // directions have no other side
  std::uint32_t facing = 0;
  for (std::size_t k = 0; k < kGroupPoints; ++k) {
    const float x = at.position[0][k] - from.x;
    const float y = at.position[1][k] - from.y;
    const float z = at.position[2][k] - from.z;
    const float cosine = n.x * x + n.y * y + n.z * z;
    const float above = g.x * x + g.y * y + g.z * z;
    const float before =
        whatever - (at.normal[0][k] * x + at.normal[1][k] * y + at.normal[2][k] * z);
    const bool faces = (cosine > 0.0F) & (above > 0.0F) & (before > 0.0F);
    facing |= faces ? 1U << k : 0U;
  }
  return facing;
}

std::uint32_t visible_points(const RayScene& rays, const LightPointSet& light, std::size_t group,
                             const Receiver& receiver, std::uint32_t facing) {
  if (facing == 0) return 0;
  const auto points = light.group(group);
  std::array<Ray, kGroupPoints> packet;
  std::size_t count = 0;
  for (std::uint32_t left = facing; left != 0; left &= left - 1) {
    const LightPoint& point = points[static_cast<std::size_t>(std::countr_zero(left))];
    Ray& ray = packet[count++];
    ray.origin = receiver.origin;
    ray.direction = point.target;
    if (light.is_environment) continue;
    ray.direction -= receiver.origin;
    ray.t_max = kSegmentEnd;
  }
  const std::uint32_t occluded = rays.occluded_mask(std::span(packet).first(count));
  std::uint32_t visible = 0;
  std::size_t ray = 0;
  for (std::uint32_t left = facing; left != 0; left &= left - 1, ++ray) {
    if (((occluded >> ray) & 1U) == 0) visible |= left & (~left + 1U);
  }
  return visible;
}

glm::vec3 group_irradiance(const LightPointSet& light, std::size_t group,
                           const GroupFactors& factors, std::uint32_t visible) {
  using Four [[gnu::vector_size(4 * sizeof(float))]] = float;
  const auto& power = light.coordinates[group].power;
  Four sum{};
  const auto add = [&](std::size_t k) {
    Four of_point;
    std::memcpy(&of_point, power[k].data(), sizeof(of_point));
    sum += factors.values[k] * of_point;
  };
  if (visible == factors.facing) {
    // Factors of the other points are 0, and adding 0 is cheaper than finding out.
    for (std::size_t k = 0; k < kGroupPoints; ++k) add(k);
  } else {
    for (std::uint32_t left = visible; left != 0; left &= left - 1) {
      add(static_cast<std::size_t>(std::countr_zero(left)));
    }
  }
  return {sum[0], sum[1], sum[2]};
}

glm::vec3 open_irradiance(const LightPointSet& light, const Receiver& receiver) {
  if (light.has_one_power) return factor_sum(light, receiver) * light.points.front().power;
  glm::vec3 sum(0.0F);
  for (std::size_t group = 0; group < light.group_count(); ++group) {
    const GroupFactors factors = group_factors(light, group, receiver);
    sum += group_irradiance(light, group, factors, factors.facing);
  }
  return sum;
}

glm::vec3 irradiance_by_points(const RayScene& rays, const std::vector<LightPointSet>& lights,
                               const Receiver& receiver, std::uint64_t& rays_cast) {
  glm::vec3 sum(0.0F);
  for (const LightPointSet& light : lights) {
    if (!may_shine_on(light, receiver)) continue;
    for (std::size_t group = 0; group < light.group_count(); ++group) {
      const GroupFactors factors = group_factors(light, group, receiver);
      rays_cast += static_cast<std::uint64_t>(std::popcount(factors.facing));
      const std::uint32_t bits = visible_points(rays, light, group, receiver, factors.facing);
      if (bits != 0) sum += group_irradiance(light, group, factors, bits);
    }
  }
  return sum;
}

}  // namespace renderers::ray_tracing
