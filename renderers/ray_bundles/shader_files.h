#pragma once

#include <span>

#include "renderers/opengl/shader_source.h"

namespace renderers::ray_bundles {

/// The shaders of this folder and those they include; generated when the program is built.
std::span<const opengl::ShaderFile> shader_files();

}  // namespace renderers::ray_bundles
