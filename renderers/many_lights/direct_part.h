#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

#include "perception/image.h"
#include "renderers/contract/renderer.h"
#include "renderers/many_lights/picture_settings.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::many_lights {

/// One of the sets whose direct light is added up.
struct DirectPart {
  glm::vec2 offset_px{0.0F};  ///< of the set's point of the pixels, for one camera ray a pixel
  std::uint64_t seed = 1;
  std::uint32_t set = 0;  ///< sets of one seed continue the same sequences of samples
};

/// Adds direct light and emission by rays, the shared pass of ray_tracing/direct_light_pass.h.
/// @param sum  made black and as large as the picture if it is empty
/// @return rays
std::uint64_t add_direct_light(const ray_tracing::RayScene& rays, const RenderJob& job,
                               const PictureSettings& settings, const DirectPart& part,
                               perception::Image& sum);

}  // namespace renderers::many_lights
