#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace renderers::scene {

/// Checks a glTF 2.0 file (JSON): the indices of every primitive are below its POSITION accessor's
/// count and lie inside their buffer, be it a file or a base64 data URI.
/// @param path  for messages, and where relative URIs start
/// @param warnings  gets a line that names the extensions which the file uses; none is supported
/// @throws base::InputError naming the file, mesh, primitive and face, or the extensions that the
///   file requires
void check_gltf(std::string_view data, const std::filesystem::path& path,
                std::vector<std::string>& warnings);

/// The same for a GLB file, after its header's and chunks' lengths against the file's.
void check_glb(std::string_view data, const std::filesystem::path& path,
               std::vector<std::string>& warnings);

}  // namespace renderers::scene
