#pragma once

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "perception/image.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::ray_tracing {

/// Where a pixel's camera rays go.
enum class PixelRays {
  fixed,  ///< all through the pixel's centre plus `DirectLightSettings::offset_px`
  spread  ///< well distributed over the pixel, as a box filter of one pixel asks for
};

/// From which surfaces reflected rays look for area lights and environment, besides the samples on
/// the lights. Where none leave, light sampling stands alone.
///
/// Measured, noise x time of `glossy` over that of `always`, one sample per pixel: 0.6 in the
/// Cornell box and in `common-box`, 0.8 in `textured-room`, 1.8 in `common-atrium`, and no bound
/// for a surface next to a lamp.
enum class ReflectedRays { always, glossy };

struct DirectLightSettings {
  PixelRays pixel_rays = PixelRays::fixed;
  glm::vec2 offset_px{0.0F};  ///< to the right and down, from the pixel's centre; `fixed` only
  int camera_rays = 1;        ///< per pixel and pass, >= 1
  /// Samples of area lights and environment per camera ray, >= 1: each one point or direction on
  /// the lights and, by `reflected_rays`, one reflected ray.
  int light_samples = 1;
  ReflectedRays reflected_rays = ReflectedRays::always;
};

/// One picture, or one pass of a progressive one.
struct DirectLightJob {
  int width_px = 0;
  int height_px = 0;
  scene::Camera camera;
  std::uint64_t seed = 1;
  /// Passes of one seed continue the same sequences of samples: their mean is better than that of
  /// as many seeds.
  std::uint32_t pass = 0;
};

struct DirectLightCounts {
  std::uint64_t camera = 0;
  std::uint64_t shadow = 0;
  std::uint64_t reflected = 0;
  std::uint64_t rays() const { return camera + shadow + reflected; }
};

struct DirectLight {
  perception::Image radiance;  ///< `lit` + `seen`; R, G, B, scene_linear
  perception::Image seen;      ///< emission and environment that the camera sees
  DirectLightCounts counts;
};

/// The direct light of a picture: emission and environment seen by the camera, and the light that
/// meets one surface, by its whole BRDF. For techniques that make indirect light alone.
///
/// Every point and spot light gets one shadow ray per camera ray. Area lights and environment are
/// sampled by power and by the BRDF, combined by the power heuristic, as in the path tracer.
/// Converges to what `path` gives with transport=direct when the rays are spread over the pixels.
///
/// The image is a function of (scene, settings, job), whatever the number of threads.
///
/// Sources: Shirley, Wang, Zimmerman 1996, "Monte Carlo Techniques for Direct Lighting
/// Calculations", doi:10.1145/226150.226151; Veach and Guibas 1995, "Optimally Combining Sampling
/// Techniques for Monte Carlo Rendering", doi:10.1145/218380.218498.
class DirectLightPass {
 public:
  /// @param rays  must live as long as this, with its scene
  /// @throws base::InputError if a count of the settings is below 1
  DirectLightPass(const RayScene& rays, const DirectLightSettings& settings);

  DirectLight render(const DirectLightJob& job) const;

 private:
  struct Pixel;
  struct Estimate;

  Estimate estimate_pixel(const CameraRays& camera, const Pixel& pixel,
                          DirectLightCounts& counts) const;
  glm::vec3 light_of_areas(const SurfacePoint& point, const SurfaceBrdf& brdf, const Pixel& pixel,
                           std::uint32_t first_index, DirectLightCounts& counts) const;
  bool has_reflected_rays(const SurfaceBrdf& brdf) const;
  glm::vec3 sample_light(const SurfacePoint& point, const SurfaceBrdf& brdf, const glm::vec3& u,
                         DirectLightCounts& counts) const;
  glm::vec3 follow_reflection(const SurfacePoint& point, const SurfaceBrdf& brdf,
                              const glm::vec3& u, DirectLightCounts& counts) const;

  const RayScene& rays_;
  DirectLightSettings settings_;
  LightSampler areas_;  ///< area lights and environment
};

}  // namespace renderers::ray_tracing
