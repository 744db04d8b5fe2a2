#include "renderers/scene/file_locator.h"

#include "perception/base/names.h"

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <string_view>

namespace renderers::scene {
namespace {

/// Where dpkg keeps the list of files of every installed package.
constexpr std::string_view kPackageLists = "/var/lib/dpkg/info";

/// True if the path ends with the suffix at a folder boundary: "/a/b.obj" with "b.obj".
bool ends_with_path(std::string_view path, std::string_view suffix) {
  if (!path.ends_with(suffix)) return false;
  return path.size() == suffix.size() || path[path.size() - suffix.size() - 1] == '/';
}

std::filesystem::path find_in_package(const std::string& file, const std::string& package) {
  // Packages for several architectures at once carry the architecture in their list's name.
  for (const char* architecture : {"", ":amd64", ":arm64"}) {
    std::ifstream list(fmt::format("{}/{}{}.list", kPackageLists, package, architecture));
    for (std::string line; std::getline(list, line);) {
      if (ends_with_path(line, file) && std::filesystem::is_regular_file(line)) return line;
    }
  }
  return {};
}

}  // namespace

std::filesystem::path read_file_reference(base::MapReader& reader,
                                          const std::filesystem::path& folder) {
  const base::Node& file_node = reader.require("file");
  const std::string file = file_node.text("file");
  if (file.empty()) throw base::InputError(file_node.place(), "file is empty");
  const base::Node* package_node = reader.find("package");
  if (package_node == nullptr) {
    const std::filesystem::path path = folder / file;
    if (std::filesystem::is_regular_file(path)) return path;
    throw base::InputError(file_node.place(),
                           fmt::format("{}: not found (looked for {})", file, path.string()));
  }
  const std::string package = package_node->text("package");
  if (!base::is_path_safe(package)) {
    throw base::InputError(package_node->place(),
                           fmt::format("\"{}\" is no name of a Debian package", package));
  }
  const std::filesystem::path found = find_in_package(file, package);
  if (!found.empty()) return found;
  throw base::InputError(
      file_node.place(),
      fmt::format("{}: not found; it is in the Debian package {} (sudo apt-get install {})", file,
                  package, package));
}

}  // namespace renderers::scene
