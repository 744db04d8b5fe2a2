#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/area_shadows/pixel_surfaces.h"
#include "renderers/area_shadows/point_visibility.h"
#include "renderers/contract/stage_timer.h"
#include "renderers/ray_tracing/light_points.h"

namespace renderers::area_shadows {

/// Irradiance of a pixel, W/m2.
struct PixelLight {
  glm::vec3 irradiance{0.0F};
  glm::vec3 open{0.0F};  ///< what it would be if nothing stood between
};

/// A group of a light's points, as seen from a pixel.
struct PointGroup {
  std::uint32_t pixel = 0;
  std::uint32_t light = 0;
  std::uint16_t group = 0;
};

/// What each pixel has found out about the light points so far: a bit per point, kept, so that no
/// ray is traced twice. A bit is set if the point and the pixel face and see each other.
///
/// Rays are asked for and cast in lists, from one thread; what is known can be read from all.
class ShadowTracer {
 public:
  /// At most so many groups of points a light: the flags of a pixel and light are one word.
  static constexpr std::size_t kMostGroups = 16;

  /// All arguments must live as long as this. @param lights  each of at most kMostGroups groups
  ShadowTracer(PointVisibility& visibility, const PixelSurfaces& surfaces,
               const std::vector<ray_tracing::LightPointSet>& lights, StageTimer& timer);

  /// Asks for the bits of a group at a pixel with a surface, unless they are known or asked for.
  /// They can be read after `trace`; what is asked for meanwhile takes no more memory than one
  /// list.
  void ask(const PointGroup& group);
  /// The same for all groups of all lights.
  void ask_pixel(std::uint32_t pixel);
  /// Finds what was asked for. @return rays cast since the last time
  std::uint64_t trace();
  /// Asks for all groups of all lights and finds them. @param pixels  with a surface
  std::uint64_t trace_pixels(std::span<const std::uint32_t> pixels);
  /// The bits of a group that was asked for before.
  std::uint32_t known(std::size_t pixel, std::size_t light, std::size_t group) const {
    return bits_[(pixel * lights_.size() + light) * groups_ + group].seen;
  }
  /// Of a group that was asked for before: the points that the pixel faces, seen or not.
  std::uint32_t facing(std::size_t pixel, std::size_t light, std::size_t group) const {
    return bits_[(pixel * lights_.size() + light) * groups_ + group].facing;
  }
  bool is_known(std::size_t pixel, std::size_t light, std::size_t group) const {
    return ((traced_[pixel * lights_.size() + light] >> group) & 1U) != 0;
  }
  /// Whether there is a surface at the pixel, and some light may shine on it.
  bool may_be_lit(std::size_t pixel) const { return may_be_lit_[pixel] != 0; }

  /// Irradiance of a pixel by all points of all lights, all of them known, to the bit what
  /// `ray_tracing::irradiance_by_points` gives.
  PixelLight light_of(std::size_t pixel) const;
  /// What it would be if nothing stood between; needs no rays.
  glm::vec3 open_light_of(std::size_t pixel) const;
  /// Number of bits set over all lights and groups, traced or not.
  std::uint32_t lit_points(std::size_t pixel) const;

  const std::vector<ray_tracing::LightPointSet>& lights() const { return lights_; }
  const PixelSurfaces& surfaces() const { return surfaces_; }
  /// Groups of each light; 0 without lights.
  std::size_t groups() const { return groups_; }
  /// Of the bits.
  std::int64_t memory_bytes() const;
  /// Of lists, as long as they have been.
  std::int64_t list_bytes() const;

 private:
  void find_lights_below();
  void trace_unknown();

  PointVisibility& visibility_;
  const PixelSurfaces& surfaces_;
  const std::vector<ray_tracing::LightPointSet>& lights_;
  StageTimer& timer_;
  std::size_t groups_ = 0;
  std::uint64_t rays_ = 0;  ///< since `trace`
  struct GroupBits {
    std::uint16_t seen = 0;
    std::uint16_t facing = 0;
  };
  std::vector<GroupBits> bits_;  ///< [pixel][light][group]
  /// [pixel][light], a bit per group; all set where the light cannot shine on the pixel.
  std::vector<std::uint16_t> traced_;
  std::vector<std::uint8_t> may_be_lit_;  ///< [pixel]
  std::vector<GroupRays> unknown_;        ///< what is asked for; kept, as rounds are many
  std::vector<std::uint16_t> visible_;    ///< what comes back
};

/// Irradiance of a receiver by all points of lights as if nothing stood between, W/m2.
glm::vec3 open_irradiance(std::span<const ray_tracing::LightPointSet> lights,
                          const ray_tracing::Receiver& receiver);

}  // namespace renderers::area_shadows
