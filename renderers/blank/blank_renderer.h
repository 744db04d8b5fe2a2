#pragma once

#include "renderers/contract/renderer.h"

namespace renderers::blank {

/// The renderer `blank`: a constant image in no time, to measure the harness; its parameter
/// `behaviour` makes it fail in the ways a renderer can, to test the harness. Counters, where they
/// apply: `time_budget_s` is the job's, `checkpoint_s` the seconds spent in the sink.
RendererInfo renderer_info();

}  // namespace renderers::blank
