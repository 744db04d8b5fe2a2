#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/ray_tracing/light_points.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/soft_shadows/light_depth_map.h"

/// Percentage-closer soft shadows: the share of a light that is visible, guessed from what its
/// centre sees.
///
/// Source: Fernando 2005, "Percentage-Closer Soft Shadows", SIGGRAPH 2005 Sketches,
/// doi:10.1145/1187112.1187153 (recalled).
namespace renderers::soft_shadows {

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

/// One light with its map.
struct MappedLight {
  const ray_tracing::LightPointSet* points = nullptr;
  FlatLight flat;
  LightDepthMap map;

  /// @param position  of a receiver, world space  @param normal  of its surface there
  float visible_share(const glm::vec3& position, const glm::vec3& normal,
                      const PcssSettings& settings) const;
};

/// Maps of all lights, of `PcssSettings::map_px`. @param lights  must live as long as these
/// @throws base::InputError if the maps would take more than 4 GiB
/// @throws UnsupportedError if a light is not flat
std::vector<MappedLight> map_lights(const ray_tracing::RayScene& rays,
                                    std::span<const ray_tracing::LightPointSet> lights, int map_px);

}  // namespace renderers::soft_shadows
