#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "renderers/area_shadows/pixel_surfaces.h"
#include "renderers/contract/stage_timer.h"
#include "renderers/ray_tracing/light_points.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::area_shadows {

/// Rays from a pixel's surface to those points of a group that it faces.
struct GroupRays {
  std::uint32_t pixel = 0;
  std::uint32_t light = 0;
  std::uint16_t group = 0;   ///< of the light's points
  std::uint16_t facing = 0;  ///< bit per point: a ray to it
};

/// Groups in a list that is found out about at once; what is longer is cut.
inline constexpr std::size_t kMostListedGroups = std::size_t{1} << 17;

/// Who casts the shadow rays of one picture. Rays are asked about in lists, so that a device gets
/// enough of them at a time; lists are asked about from one thread.
class PointVisibility {
 public:
  virtual ~PointVisibility() = default;
  /// @param rays     pixels with a surface
  /// @param visible  as many: receives the points that are seen, a bit each
  /// @param timer    receives the stage `rays` below the open one, and what a device takes besides
  virtual void find(std::span<const GroupRays> rays, std::span<std::uint16_t> visible,
                    StageTimer& timer) = 0;
};

/// Rays by Embree, on all threads; all of it is the stage `rays`.
class EmbreeVisibility final : public PointVisibility {
 public:
  /// All must live as long as this.
  EmbreeVisibility(const ray_tracing::RayScene& rays, const PixelSurfaces& surfaces,
                   const std::vector<ray_tracing::LightPointSet>& lights)
      : rays_(rays), surfaces_(surfaces), lights_(lights) {}
  void find(std::span<const GroupRays> rays, std::span<std::uint16_t> visible,
            StageTimer& timer) override;

 private:
  const ray_tracing::RayScene& rays_;
  const PixelSurfaces& surfaces_;
  const std::vector<ray_tracing::LightPointSet>& lights_;
};

/// The rays to a group: what of it the pixel's surface faces; none if the light cannot shine on it.
GroupRays rays_to_group(const PixelSurfaces& surfaces,
                        const std::vector<ray_tracing::LightPointSet>& lights, std::uint32_t pixel,
                        std::size_t light, std::size_t group);

/// The same for a list: fills in `facing`. Groups of one light that follow each other at a pixel
/// are cheaper than others.
/// @param factors  as many, or none: receives the factors of groups that `facing` has bits of
void find_facing(const PixelSurfaces& surfaces,
                 const std::vector<ray_tracing::LightPointSet>& lights, std::span<GroupRays> rays,
                 std::span<ray_tracing::GroupFactors> factors = {});

/// Rays of a list.
std::uint64_t count_rays(std::span<const GroupRays> rays);

/// All points of all lights, seen from one pixel.
struct PixelPoints {
  std::uint32_t pixel = 0;
  std::span<const GroupRays> groups;  ///< of the first light, of the second, ...
  std::span<const std::uint16_t> visible;
  std::span<const ray_tracing::GroupFactors> factors;  ///< of groups that are faced
};

/// Who is to be looked at: pixels with a surface, and what shines on them.
struct LitPixels {
  const PixelSurfaces& surfaces;
  const std::vector<ray_tracing::LightPointSet>& lights;
  std::span<const std::uint32_t> pixels;
};

/// Rays of some pixels, and how many of them nothing stops.
struct RayCounts {
  std::uint64_t rays = 0;
  std::uint64_t unhidden = 0;
};

/// Finds out about some pixels at a time, and calls `body` for each, from several threads.
RayCounts visit_pixels(PointVisibility& visibility, const LitPixels& lit, StageTimer& timer,
                       const std::function<void(const PixelPoints&)>& body);

/// Pixels with a surface, in order.
std::vector<std::uint32_t> surface_pixels(const PixelSurfaces& surfaces);

}  // namespace renderers::area_shadows
