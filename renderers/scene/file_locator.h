#pragma once

#include "perception/base/document.h"

#include <filesystem>

namespace renderers::scene {

/// Reads the keys `file` and `package` of a map and finds the file.
///
/// Without `package` the path is taken relative to the scene file's folder. With it, it is looked
/// up by the end of its path among the files of that Debian package.
/// @throws base::InputError naming the Debian package and the command that installs it
std::filesystem::path read_file_reference(base::MapReader& reader,
                                          const std::filesystem::path& folder);

}  // namespace renderers::scene
