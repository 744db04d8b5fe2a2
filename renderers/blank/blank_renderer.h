#pragma once

#include "renderers/contract/renderer.h"

namespace renderers::blank {

/// The renderer `blank`: a constant image in no time, to measure the harness; its parameter
/// `behaviour` makes it fail in the ways a renderer can, to test the harness.
RendererInfo renderer_info();

}  // namespace renderers::blank
