#pragma once

#include <memory>
#include <vector>

#include "renderers/area_shadows/point_visibility.h"
#include "renderers/gpu_tracing/fan_tracer.h"
#include "renderers/gpu_tracing/gpu_bvh.h"

namespace renderers::area_shadows {

/// The scene on a device that traces rays in compute shaders, from picture to picture.
struct DeviceRays {
  explicit DeviceRays(const std::shared_ptr<opengl::Context>& context)
      : bvh(context), tracer(context) {}
  gpu_tracing::GpuBvh bvh;
  gpu_tracing::FanTracer tracer;
};

/// Rays in compute shaders; a group of points is a fan. Stages `upload`, `rays`, `download`.
class GpuVisibility final : public PointVisibility {
 public:
  /// Uploads the points of the lights. Device and surfaces must live as long as this.
  GpuVisibility(DeviceRays& gpu, const PixelSurfaces& surfaces,
                const std::vector<ray_tracing::LightPointSet>& lights, StageTimer& timer);
  void find(std::span<const GroupRays> rays, std::span<std::uint16_t> visible,
            StageTimer& timer) override;

 private:
  DeviceRays& gpu_;
  const PixelSurfaces& surfaces_;
  std::vector<std::uint32_t> first_fans_;  ///< per light: how many rows of targets are before it
};

}  // namespace renderers::area_shadows
