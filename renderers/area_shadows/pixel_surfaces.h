#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "perception/image.h"
#include "renderers/contract/renderer.h"
#include "renderers/ray_tracing/light_points.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::area_shadows {

/// What the camera sees through a pixel's centre.
struct PixelSurface {
  ray_tracing::Receiver receiver;
  glm::vec3 albedo{0.0F};  ///< of the Lambert lobe
  float depth_m = 0.0F;    ///< distance from the camera
  int material = -1;       ///< index into Scene::materials; -1: no surface
  bool is_glossy = false;

  bool is_surface() const { return material >= 0; }
};

/// The geometry buffer: one surface per pixel, row-major, top-left first.
struct PixelSurfaces {
  int width_px = 0;
  int height_px = 0;
  glm::vec3 camera{0.0F};  ///< its position, m
  glm::mat3 to_eye{1.0F};  ///< rotation from world to the camera's axes: right, up, back
  std::vector<PixelSurface> pixels;
  perception::Image seen;  ///< emission and environment that the camera sees; R, G, B

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
           static_cast<std::size_t>(x);
  }
  const PixelSurface& at(int x, int y) const { return pixels[index(x, y)]; }
};

/// One camera ray per pixel. The result does not depend on the number of threads.
PixelSurfaces find_pixel_surfaces(const ray_tracing::RayScene& rays, const RenderJob& job);

/// How far two surfaces may differ and still be called the same.
struct SurfaceTolerance {
  float plane = 0.005F;  ///< distance from the plane between both, by the first one's depth
  float normal = 0.1F;   ///< 1 - cosine between the normals
};

/// Whether light found at one surface tells about the other: normals agree, and neither stands off
/// the plane of the mean normal through the other. Points of one sphere or plane always fit.
bool is_same_surface(const PixelSurface& a, const PixelSurface& b,
                     const SurfaceTolerance& tolerance);

}  // namespace renderers::area_shadows
