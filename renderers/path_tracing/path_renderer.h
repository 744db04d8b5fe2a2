#pragma once

#include "renderers/contract/renderer.h"

namespace renderers::path_tracing {

/// The renderer `path`: unbiased path tracing, the program's reference.
RendererInfo renderer_info();

}  // namespace renderers::path_tracing
