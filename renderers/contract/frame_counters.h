#pragma once

#include <string_view>

#include "renderers/contract/renderer.h"

namespace renderers {

/// Adds to a counter that a frame has and that is one number.
/// @param name  of the counter; must be there
void add_to_counter(std::string_view name, double value, Frame& frame);

}  // namespace renderers
