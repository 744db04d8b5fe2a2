#pragma once

#include <cstdint>
#include <vector>

#include "perception/image.h"
#include "renderers/contract/renderer.h"
#include "renderers/element_hierarchy/radiosity_solver.h"
#include "renderers/element_hierarchy/shown_light.h"

namespace renderers::radiosity {

struct PictureSettings {
  int camera_rays = 16;
  bool with_direct = true;  ///< emission, environment, point lights and the solution's direct light
  std::uint64_t seed = 1;
};

struct RadiosityPicture {
  perception::Image direct;
  perception::Image indirect;
  std::uint64_t rays = 0;
};

/// Looks at the scene through every pixel, rays spread over it: the solution's irradiance there
/// times the surface's own albedo, and what no link carries.
/// @param shown  null: light reaches no surface
RadiosityPicture show_solution(const ray_tracing::RayScene& rays,
                               const element_hierarchy::ShownLight* shown, const RenderJob& job,
                               const PictureSettings& settings);

/// Of the surfaces at the pixels' centres: `albedo`, `normal` (towards the camera), `patches` (a
/// colour per leaf), `patch_links` (links of the leaf and its ancestors).
/// @param solution  may be null
std::vector<perception::NamedImage> show_patches(const ray_tracing::RayScene& rays,
                                                 const element_hierarchy::Solution* solution,
                                                 const RenderJob& job);

}  // namespace renderers::radiosity
