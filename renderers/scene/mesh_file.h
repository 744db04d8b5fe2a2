#pragma once

#include "perception/base/document.h"
#include "renderers/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace renderers::scene {

/// What to do with a mesh file's normals.
enum class MeshNormals {
  file,    ///< those of the file; flat triangles if it has none
  smooth,  ///< one per position, from its faces
  flat     ///< none
};

struct MeshFileOptions {
  MeshNormals normals = MeshNormals::file;
  std::string up = "y";  ///< the file's axis that becomes +y: y, z or -z
  float fit_height_m =
      0.0F;              ///< > 0: scaled to this height, centred on the y axis, standing on y = 0
  int subdivide_to = 0;  ///< > 0: longest edges are halved until there are as many faces
};

/// Reads {normals: file | smooth | flat, up: y | z | -z, fit_height, subdivide_to} of a `mesh:`
/// map.
MeshFileOptions read_mesh_file_options(base::MapReader& reader);

/// All triangles of an OBJ, PLY, 3DS, glTF or GLB file as one mesh, placed by the file's own node
/// transforms. Materials, lights, cameras and animation of the file are not used.
/// @param warnings  gets a line for each thing left out: zero-area triangles, points, lines
/// @throws base::InputError naming the file: unreadable, truncated, not finite, no triangles, more
///   triangles than `subdivide_to`
Mesh read_mesh_file(const std::filesystem::path& path, const MeshFileOptions& options,
                    std::vector<std::string>& warnings);

}  // namespace renderers::scene
