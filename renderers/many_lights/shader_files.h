#pragma once

#include <span>

#include "renderers/opengl/shader_source.h"

namespace renderers::many_lights {

/// The shaders of this kit and those they include; generated when the program is built.
std::span<const opengl::ShaderFile> shader_files();

}  // namespace renderers::many_lights
