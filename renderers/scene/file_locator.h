#pragma once

#include "perception/base/document.h"

#include <filesystem>
#include <string_view>

namespace renderers::scene {

/// Where dpkg keeps the list of files of every installed package.
inline constexpr std::string_view kPackageLists = "/var/lib/dpkg/info";

/// Reads the keys `file` and `package` of a map and finds the file.
///
/// Without `package` the path is taken relative to the scene file's folder. With it, it is looked
/// up by the end of its path among the files of that Debian package.
/// @param package_lists  folder of the lists <package>.list
/// @throws base::InputError naming the Debian package: the command that installs it, or what an
///   installed one has instead
std::filesystem::path read_file_reference(
    base::MapReader& reader, const std::filesystem::path& folder,
    const std::filesystem::path& package_lists = kPackageLists);

}  // namespace renderers::scene
