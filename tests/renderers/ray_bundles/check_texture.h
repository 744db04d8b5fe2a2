#pragma once

#include <algorithm>

#include <glm/vec3.hpp>

#include "perception/image.h"
#include "renderers/scene/scene.h"

namespace renderers::test {

/// Two by two texels: the first and the last of one colour, the others of another.
inline scene::Texture check_texture(const glm::vec3& even, const glm::vec3& odd) {
  scene::Texture checks;
  checks.image = perception::make_rgb_image(2, 2, perception::Encoding::scene_linear);
  auto texel = checks.image.pixels.begin();
  for (const glm::vec3* colour : {&even, &odd, &odd, &even}) {
    texel = std::copy_n(&colour->x, 3, texel);
  }
  return checks;
}

}  // namespace renderers::test
