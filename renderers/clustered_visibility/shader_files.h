#pragma once

#include <span>

#include "renderers/opengl/shader_source.h"

namespace renderers::clustered_visibility {

/// The shaders of this technique and those they include; generated when the program is built.
std::span<const opengl::ShaderFile> shader_files();

}  // namespace renderers::clustered_visibility
