#pragma once

#include <span>

#include "renderers/opengl/shader_source.h"

namespace renderers::gpu_tracing {

/// The shaders of this kit; generated when the program is built.
std::span<const opengl::ShaderFile> shader_files();

}  // namespace renderers::gpu_tracing
