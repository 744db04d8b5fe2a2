#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "perception/base/parameter_spec.h"
#include "perception/image_file.h"
#include "renderers/area_shadows/pixel_surfaces.h"
#include "renderers/area_shadows/point_visibility.h"
#include "renderers/contract/renderer.h"
#include "renderers/ray_tracing/light_points.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::area_shadows {

/// Who casts the shadow rays to points on lights.
enum class RayBackend {
  automatic,  ///< the device if it is hardware, else Embree
  embree,
  gpu  ///< compute shaders of the device, software or not
};

/// What a technique gets to find the irradiance of every pixel's surface.
struct ShadowJob {
  const ray_tracing::RayScene& rays;
  const PixelSurfaces& surfaces;
  const std::vector<ray_tracing::LightPointSet>& lights;  ///< area lights, then the environment
  PointVisibility& visibility;                            ///< between both
};

/// What a technique found.
struct ShadowResult {
  std::vector<glm::vec3> irradiance;         ///< one per pixel, W/m2; any value without a surface
  std::vector<perception::NamedImage> aovs;  ///< made in stage `readback`
  std::vector<std::pair<std::string, CounterValue>> counters;  ///< without those of all techniques
  double rays = 0.0;
};

/// Finds the irradiance of all pixels by area lights and environment.
using ShadowSolver = std::function<ShadowResult(const ShadowJob&, StageTimer&)>;

/// The points on the lights, and who looks at them.
struct ScreenShadowsSettings {
  int points = 64;              ///< per light, a power of two
  std::size_t group_size = 16;  ///< points of a packet of rays
  RayBackend backend = RayBackend::embree;
};

/// A renderer of direct light that looks at one surface per pixel: everything but the irradiance of
/// area lights and environment, which the solver brings. That is the emission which the camera
/// sees, point and spot lights (one shadow ray per pixel each), glossy lobes (all points at each
/// pixel) and the albedo.
std::unique_ptr<Renderer> make_screen_shadows_renderer(const ScreenShadowsSettings& settings,
                                                       ShadowSolver solver, const Devices& devices);

/// The parameter `backend` and its value. Camera rays and those to point lights are Embree's.
base::ParameterSpec backend_parameter();
RayBackend backend_of(const base::Parameters& parameters);

/// Entry of a renderer of this folder, without name, texts and parameters.
RendererInfo screen_shadows_info();

/// @throws base::InputError if the number is not a power of two
/// @param owner      e.g. "per-pixel-shadows"
/// @param parameter  its name
void check_power_of_two(const std::string& owner, const std::string& parameter, std::int64_t value);

}  // namespace renderers::area_shadows
