#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace renderers::scene {

/// What a mesh file says it holds.
struct MeshFileCounts {
  std::size_t triangles = 0;        ///< after cutting every face into a fan
  std::size_t unused_vertices = 0;  ///< vertices that no face names
};

/// Refuses mesh files that importers would load in part: cut short, or with values out of range.
///
/// OBJ: every line is looked at (coordinates finite, face indices in range);
/// PLY: the data against the header's counts; 3DS: every chunk's length against its parent's, face
/// indices; GLB: the header's and chunks' lengths against the file's; glTF and GLB: face indices.
/// @param warnings  gets a line that names the glTF extensions passed over
/// @return the counts where they can be told (OBJ, PLY)
/// @throws base::InputError naming the file and what is missing
std::optional<MeshFileCounts> check_mesh_file(const std::filesystem::path& path,
                                              std::vector<std::string>& warnings);

}  // namespace renderers::scene
