#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/ray_tracing/ray_scene.h"

/// Fixed points on the lights of a scene that have an extent, the same for every lit point: what
/// techniques of soft shadows share, so that they differ in where they look and not in what they
/// look at.
namespace renderers::ray_tracing {

/// A point of an area light, or a direction of the environment.
struct LightPoint {
  glm::vec3 position{0.0F};  ///< m; of the environment: unit length, towards it
  glm::vec3 target{0.0F};    ///< where shadow rays end: just in front of the light's surface
  glm::vec3 normal{0.0F};    ///< unit length, front side; the environment's is not used
  /// Radiance times area by the number of points, W/sr; of the environment: radiance by density
  /// and number of points, W/m2.
  glm::vec3 power{0.0F};
};

/// Points stand in groups, each of which is traced as one packet of rays.
inline constexpr std::size_t kGroupPoints = kPacketRays;

/// Coordinates of a group's points, one after the other; of those that are missing all are 0.
struct GroupCoordinates {
  using Values = std::array<float, kGroupPoints>;
  std::array<Values, 3> position{};
  std::array<Values, 3> normal{};
  /// Of each point R, G, B and 0, so that the four are added at once.
  std::array<std::array<float, 4>, kGroupPoints> power{};
};

/// One object with emission, or the environment, as points.
struct LightPointSet {
  std::vector<LightPoint> points;
  std::vector<GroupCoordinates> coordinates;  ///< per group
  /// Corners of the emitting triangles and parallelograms, for tests that need no points.
  std::vector<glm::vec3> corners;
  /// A point and the normal of each plane that the light lies in.
  struct Plane {
    glm::vec3 point{0.0F};
    glm::vec3 normal{0.0F};
  };
  std::vector<Plane> planes;
  bool is_environment = false;
  bool has_one_power = false;  ///< all points have the same
  std::size_t group_size = kGroupPoints;

  std::size_t group_count() const { return (points.size() + group_size - 1) / group_size; }
  std::span<const LightPoint> group(std::size_t index) const {
    const std::size_t begin = index * group_size;
    return std::span(points).subspan(begin, std::min(group_size, points.size() - begin));
  }
};

/// A light's points: a Sobol' (0, 2)-sequence, Owen-scrambled, mapped to its area, so that any
/// 4, 16 or 64 points in a row from a multiple of that number on are stratified, too. Pairs of
/// triangles that make a parallelogram are mapped as one. Textured emission counts with its mean
/// over a point's share of the area; a point's share is a cell of the unit square.
///
/// Lights without a point in front (no emission, no area) are left out.
///
/// Source: Shirley, Wang, Zimmerman 1996, "Monte Carlo Techniques for Direct Lighting
/// Calculations", doi:10.1145/226150.226151, Sec. 3 (points uniform in area).
///
/// @param count  points of each light, a power of two from 4 on
/// @param seed   of the scrambling
/// @param group_size  points of a group, at most kGroupPoints
/// @return area lights in the order of their objects, then the environment
std::vector<LightPointSet> make_light_points(const RayScene& rays, int count, std::uint64_t seed,
                                             std::size_t group_size = kGroupPoints);

/// A surface point that lights may shine on; normals are on the viewer's side.
struct Receiver {
  glm::vec3 position{0.0F};
  glm::vec3 origin{0.0F};            ///< where shadow rays start: `position` off its surface
  glm::vec3 geometric_normal{0.0F};  ///< unit length
  glm::vec3 normal{0.0F};            ///< shading normal, unit length
};

/// @param viewer  any point in front of the side that is looked at
Receiver receiver_at(const SurfacePoint& point, const glm::vec3& viewer);

/// False only if no point of the light can shine on the receiver: all of it is below the
/// receiver's horizon, or the receiver is behind all of the light's planes.
bool may_shine_on(const LightPointSet& light, const Receiver& receiver);

/// Geometry factor of each point of a group: cos cos' / d2 in 1/m2, or the receiver's cosine for
/// the environment; 0 where one faces away from the other. Bit k of `facing`: factor k is above 0.
struct GroupFactors {
  std::array<float, kGroupPoints> values{};
  std::uint32_t facing = 0;
};
GroupFactors group_factors(const LightPointSet& light, std::size_t group, const Receiver& receiver);

/// Those bits alone, in less time; a factor so small that it is 0 still counts.
std::uint32_t facing_points(const LightPointSet& light, std::size_t group,
                            const Receiver& receiver);

/// Points of the group that the receiver sees, among those with a factor above 0: one ray each.
std::uint32_t visible_points(const RayScene& rays, const LightPointSet& light, std::size_t group,
                             const Receiver& receiver, std::uint32_t facing);

/// Irradiance by the points of a group, W/m2: sum of power x factor over the bits of `visible`.
glm::vec3 group_irradiance(const LightPointSet& light, std::size_t group,
                           const GroupFactors& factors, std::uint32_t visible);

/// Irradiance of a receiver by all points of a light as if nothing stood between, W/m2. Where all
/// have one power, the factors are added up first: but for rounding the sum of `group_irradiance`.
glm::vec3 open_irradiance(const LightPointSet& light, const Receiver& receiver);

/// Irradiance of a receiver by all points of all lights, W/m2: a ray to each that it faces.
/// @param rays_cast  receives the number of rays
glm::vec3 irradiance_by_points(const RayScene& rays, const std::vector<LightPointSet>& lights,
                               const Receiver& receiver, std::uint64_t& rays_cast);

}  // namespace renderers::ray_tracing
