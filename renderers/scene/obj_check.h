#pragma once

#include "renderers/scene/mesh_file_check.h"

#include <string>
#include <string_view>

namespace renderers::scene {

/// Looks at every line of a Wavefront OBJ text.
/// @param file  for messages
/// @throws base::InputError with file:line: a coordinate that is missing or not finite, a face with
///   fewer than three corners or a vertex that does not exist, no face at all
MeshFileCounts check_obj(std::string_view data, const std::string& file);

}  // namespace renderers::scene
