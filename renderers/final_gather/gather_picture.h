#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "perception/image.h"
#include "renderers/element_hierarchy/camera_surface.h"
#include "renderers/element_hierarchy/radiosity_solver.h"
#include "renderers/final_gather/camera_samples.h"
#include "renderers/final_gather/link_gather.h"

namespace renderers::final_gather {

/// Irradiance from the environment at a point, by samples on it that all points share.
class EnvironmentGather {
 public:
  /// @param rays  must live as long as this  @param samples  >= 1
  EnvironmentGather(const ray_tracing::RayScene& rays, int samples,
                    const TransferSettings& settings);

  /// W/m2. @param cast  counts the rays
  glm::vec3 at(const Receiver& receiver, std::uint64_t& cast) const;

 private:
  const ray_tracing::RayScene& rays_;
  int samples_;
  TransferSettings settings_;
  std::unique_ptr<ray_tracing::EnvironmentSampler> sampler_;  ///< null: black
};

/// The light of elements at a point. @param leaf  of the receiver
using PointGather = std::function<GatheredLight(const Receiver& receiver, std::uint32_t leaf)>;

/// A picture and maps of what it cost, per pixel the mean over its camera rays.
struct GatherPicture {
  perception::Image radiance;
  perception::Image irradiance;  ///< W/m2, of elements and environment: without the texture
  perception::Image visibility_samples;
  perception::Image form_factor_samples;
  perception::Image resampled;  ///< share of the senders that were evaluated at the pixel
  /// Of them, those whose form factor was (red), whose visibility (green), and both (blue).
  perception::Image classes;
  perception::Image camera_rays;
  double visibility_rays = 0.0;  ///< of all camera rays together
  double form_factor_evaluations = 0.0;
  std::uint64_t other_rays = 0;  ///< camera, point lights, environment, lobes
};

/// Everything a picture is made of.
struct GatherScene {
  const ray_tracing::RayScene& rays;
  const element_hierarchy::Solution* solution = nullptr;  ///< null: light reaches no surface
  const element_hierarchy::CameraSurface& surface;
  const EnvironmentGather& environment;
};

/// Follows the camera rays to the first surface: emission, point lights and lobe there, and albedo
/// / pi times the gathered irradiance.
GatherPicture gather_picture(const GatherScene& scene, const CameraSamples& samples,
                             const RenderJob& job, const PointGather& gather);

}  // namespace renderers::final_gather
