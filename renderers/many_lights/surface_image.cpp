#include "renderers/many_lights/surface_image.h"

#include <cstddef>

namespace renderers::many_lights {

namespace {

std::vector<glm::vec4> texels_of(const opengl::Texture& texture) {
  const std::vector<float> values = texture.read();
  std::vector<glm::vec4> texels(values.size() / 4);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    texels[i] = {values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]};
  }
  return texels;
}

}  // namespace

SurfaceImage read_surfaces(const opengl::GeometryBuffer& buffer) {
  return {buffer.width_px(),
          buffer.height_px(),
          texels_of(buffer.position()),
          texels_of(buffer.geometric_normal()),
          texels_of(buffer.shading_normal()),
          texels_of(buffer.albedo())};
}

}  // namespace renderers::many_lights
