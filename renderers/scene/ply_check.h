#pragma once

#include "renderers/scene/mesh_file_check.h"

#include <string>
#include <string_view>

namespace renderers::scene {

/// Compares the data of a PLY file with the counts of its header (format: G. Turk, "The PLY Polygon
/// File Format", 1994).
/// @param file  for messages
/// @throws base::InputError for a header that cannot be read, data that end early, no face
MeshFileCounts check_ply(std::string_view data, const std::string& file);

}  // namespace renderers::scene
