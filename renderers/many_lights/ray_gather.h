#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "renderers/many_lights/gather.h"
#include "renderers/many_lights/gather_settings.h"
#include "renderers/many_lights/surface_image.h"
#include "renderers/many_lights/virtual_light.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/scene/scene.h"

namespace renderers::many_lights {

/// How far the ends of shadow rays keep from the surfaces they connect, in diagonals of the scene's
/// bounding box. Positions come from a rasteriser, whose errors have no known bound; the margin
/// must exceed them. Measured: receivers 1e-5 diagonals off their surface need 1e-5 (with 3e-6 a
/// quarter of the rays meets it); in a room with blocks the received energy moves by -0.003 %,
/// -0.04 %, -0.4 % at 1e-4, 1e-3, 1e-2.
inline constexpr float kDefaultEpsilon = 1e-4F;

/// What is gathered where, and what stands between.
struct RayGatherInput {
  const scene::Scene& scene;  ///< materials of the receivers
  const SurfaceImage& surfaces;
  std::span<const VirtualLight> lights;
  const ray_tracing::RayScene* rays = nullptr;  ///< of the same scene; null: nothing blocks
  float epsilon = kDefaultEpsilon;              ///< see `kDefaultEpsilon`
  /// Group of each light, or -1; empty: every light for itself. Lights of a group share a
  /// visibility: the mean of those of its lights that would light the receiver if nothing stood
  /// between, all of them, whatever run the receiver reads.
  std::span<const std::int32_t> groups{};
};

/// Row-major, top row first, one vec4 per pixel; w: 1 on a surface, else 0 and black.
struct GatheredLight {
  std::vector<glm::vec4> irradiance;  ///< rgb, W/m2
  /// rgb, W/(m2 sr): what the lobes reflect to the camera; empty without `with_glossy`.
  std::vector<glm::vec4> glossy;
  std::uint64_t rays = 0;
  std::uint64_t occluded = 0;  ///< of the rays
};

/// Light of the virtual lights at every pixel with a surface, as defined in virtual_light.h, with
/// one shadow ray per connection that would carry light (in packets of kPacketRays).
///
/// A shadow ray's ends are moved off their surfaces along the geometric normals by
/// d = epsilon x diagonal, then shortened by d along the ray: blockers nearer than 2 d to an end
/// may be missed.
///
/// The result does not depend on the number of threads.
GatheredLight gather_by_rays(const RayGatherInput& input, const GatherSettings& settings);

/// Puts gathered light where the device's passes find that of a gather. `glossy` is left alone if
/// there is none.
void write_light(const std::shared_ptr<opengl::Context>& context,
                 const opengl::GeometryBuffer& surfaces, const GatheredLight& light,
                 GatherTargets& targets);

}  // namespace renderers::many_lights
