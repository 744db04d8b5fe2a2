#pragma once

#include "renderers/area_shadows/light_depth_map.h"
#include "renderers/contract/renderer.h"

/// Percentage-closer soft shadows: the share of a light that is visible, guessed from what its
/// centre sees.
///
/// Source: Fernando 2005, "Percentage-Closer Soft Shadows", SIGGRAPH 2005 Sketches,
/// doi:10.1145/1187112.1187153 (recalled).
namespace renderers::area_shadows {

struct PcssSettings {
  int map_px = 1024;
  int search_side = 6;      ///< blocker search by its square of samples
  int filter_side = 8;      ///< filter by its square of samples
  float near_share = 0.2F;  ///< nearest blocker looked for, share of the receiver's height
  float bias = 0.003F;      ///< share of the height by which a blocker is nearer
  bool has_receiver_plane =
      true;  ///< compare with the receiver's tangent plane; or with its height
};

/// The visible share of a light at a place, in [0, 1].
///
/// Blocker search: mean height h of what is nearer to the light than the receiver, at height z,
/// within the square that blockers from `near_share` z on can shade it from. Penumbra estimate:
/// w (z - h) / h for a light of width w. Filter: the share of samples within a square of that
/// width about the receiver, parallel to the light, that nothing nearer hides from its centre.
///
/// Differs from the paper: squares lie at the receiver's height instead of in the map's plane, so
/// that any projection of the map will do; with `has_receiver_plane` what lies behind the tangent
/// plane hides nothing, which keeps surfaces at a slant from shading themselves; ours.
/// @param place   receiver, in the light's coordinates; 1 behind the light
/// @param normal  of its surface, in the light's axes
float visible_share(const LightDepthMap& map, float light_width_m, const glm::vec3& place,
                    const glm::vec3& normal, const PcssSettings& settings);

RendererInfo pcss_shadows_info();

}  // namespace renderers::area_shadows
