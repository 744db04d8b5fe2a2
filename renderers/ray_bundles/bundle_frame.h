#pragma once

#include <cstddef>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_bundles/direction_set.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/scene/scene.h"

namespace renderers::ray_bundles {

/// A sphere around the scene.
struct BoundingSphere {
  glm::vec3 center{0.0F};
  float radius_m = 1.0F;
};

/// Around the corners of a box, with a little room. @param box  not empty
BoundingSphere sphere_around(const scene::Box& box);

/// A point as a bundle sees it.
struct BundlePoint {
  glm::vec2 place_px{
      0.0F};             ///< pixel (x, y) covers [x, x + 1) x [y, y + 1); its line is its centre
  float depth_m = 0.0F;  ///< along the direction, from the plane of the rays' origins
};

/// A raster of parallel lines that covers the scene's box.
///
/// Pixels are squares of side 2 R / n (`pixel_m`) for n lines across the sphere of radius R; those
/// that cannot meet the box are left out. Source: Hermes et al. 2010, Sec. 3 and Fig. 4.
struct BundleFrame {
  /// @param lines_across  n, >= 1
  BundleFrame(const scene::Box& box, const BundleDirection& bundle, int lines_across);

  glm::vec3 axis_x{1.0F, 0.0F, 0.0F};
  glm::vec3 axis_y{0.0F, 1.0F, 0.0F};
  glm::vec3 direction{0.0F, 0.0F, 1.0F};
  glm::vec3 corner{0.0F};  ///< of pixel (0, 0) in the plane of the origins
  float pixel_m = 1.0F;
  float sphere_radius_m = 1.0F;
  int width_px = 0;
  int height_px = 0;

  std::size_t line_count() const {
    return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  }
  float line_m() const { return 2.0F * sphere_radius_m; }
  /// Area of a pixel, perpendicular to the direction, m2.
  float pixel_area_m2() const { return pixel_m * pixel_m; }
  ray_tracing::Ray line(int x, int y) const;
  /// A point on the line of a pixel. @param depth_m  from the plane of the rays' origins
  glm::vec3 point(int x, int y, float depth_m) const {
    return line(x, y).origin + depth_m * direction;
  }
  BundlePoint project(const glm::vec3& point) const;
};

}  // namespace renderers::ray_bundles
