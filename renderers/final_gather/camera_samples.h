#pragma once

#include <cstdint>
#include <vector>

#include "renderers/contract/renderer.h"
#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::final_gather {

struct CameraSampleSettings {
  int camera_rays = 1;  ///< per pixel
  int border_rays = 4;  ///< per pixel at the borders of objects; not fewer than `camera_rays`
};

/// How many rays go through each pixel, and where: more where neighbouring pixels see different
/// objects, attitudes or depths ("adaptive oversampling at object borders", Table 2).
class CameraSamples {
 public:
  /// @param rays  must live as long as this
  CameraSamples(const ray_tracing::RayScene& rays, const RenderJob& job,
                const CameraSampleSettings& settings);

  int count(std::size_t pixel) const { return counts_[pixel]; }
  /// @param index  below `count`
  ray_tracing::Ray ray(std::size_t pixel, int index) const;
  /// A number for the ray, unlike that of any other ray of the picture.
  std::uint64_t number(std::size_t pixel, int index) const;
  std::size_t pixel_count() const { return counts_.size(); }
  /// Rays of the whole picture, those that look for borders included.
  std::uint64_t rays_traced() const;
  /// Rays that make the picture.
  std::uint64_t total() const;

 private:
  void find_borders(const ray_tracing::RayScene& rays, int border_rays);

  int width_px_;
  int height_px_;
  ray_tracing::CameraRays camera_;
  std::uint64_t seed_;
  std::vector<int> counts_;
  bool has_borders_ = false;
};

}  // namespace renderers::final_gather
