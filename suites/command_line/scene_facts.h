#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "renderers/scene/scene.h"

namespace suites::command_line {

/// Point and spot lights, emissive objects, and the environment map.
std::size_t light_count(const renderers::scene::Scene& scene);

/// "point-light", "texture", ...
std::vector<std::string> feature_names(const renderers::scene::Scene& scene);

}  // namespace suites::command_line
