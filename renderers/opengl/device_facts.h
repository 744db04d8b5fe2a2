#pragma once

#include <string>

#include "renderers/opengl/context.h"

namespace renderers::opengl {

/// @throws UnsupportedError if the current context is older than OpenGL 4.5
void require_version(const Functions& gl);
/// Of the current context.
Limits limits_of(const Functions& gl);
DeviceFacts facts_of(const Functions& gl, const std::string& platform, const Limits& limits);

}  // namespace renderers::opengl
