#pragma once

#include "renderers/contract/renderer.h"
#include "renderers/indirect_view/indirect_light.h"
#include "renderers/indirect_view/view_settings.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::indirect_view {

/// What a picture is made of.
struct View {
  const ray_tracing::RayScene& rays;
  const IndirectLight* light = nullptr;  ///< null: no surface reflects light
  ViewSettings settings;
  double start_s = 0.0;  ///< when `render` was called, of `steady_seconds`
};

/// Picture of a technique that knows the indirect light at surface points. Camera rays are spread
/// over the pixels; each one's direct light comes from the shared pass of `ray_tracing`, its
/// indirect light from albedo / pi times the technique's irradiance, and by one ray along the
/// glossy lobe of the first surface. Progressive in camera rays per pixel.
///
/// Stages: `visibility` (direct light), `gather` (indirect light), `readback`.
/// @return radiance; AOVs `direct` (part all), `indirect`, `albedo`, `normal`; counters
///   `camera_rays`, `gather_rays`, `direct_rays`, `rays`, all of this picture alone
Frame render_view(const View& view, const RenderJob& job, StageTimer& timer);

/// Seed of a job's random numbers: another for every frame.
std::uint64_t seed_of(const RenderJob& job);

}  // namespace renderers::indirect_view
