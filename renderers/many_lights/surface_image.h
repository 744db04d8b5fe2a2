#pragma once

#include <vector>

#include <glm/vec4.hpp>

#include "renderers/opengl/geometry_buffer.h"

namespace renderers::many_lights {

/// A geometry buffer's texels on the CPU, row-major, top row first; channels as in
/// opengl::GeometryBuffer.
struct SurfaceImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<glm::vec4> position;
  std::vector<glm::vec4> geometric_normal;
  std::vector<glm::vec4> shading_normal;
  std::vector<glm::vec4> albedo;
};

SurfaceImage read_surfaces(const opengl::GeometryBuffer& buffer);

}  // namespace renderers::many_lights
