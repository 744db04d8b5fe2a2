#pragma once

#include <span>

#include "renderers/opengl/shader_source.h"

namespace renderers::shadow_maps {

/// The shaders of this kit; generated when the program is built.
std::span<const opengl::ShaderFile> shader_files();

}  // namespace renderers::shadow_maps
