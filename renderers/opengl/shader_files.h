#pragma once

#include <span>

#include "renderers/opengl/shader_source.h"

namespace renderers::opengl {

/// The shaders of this kit; generated when the program is built.
std::span<const ShaderFile> shader_files();

}  // namespace renderers::opengl
