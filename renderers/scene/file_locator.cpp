#include "renderers/scene/file_locator.h"

#include "perception/base/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace renderers::scene {
namespace {

/// File names that stand for the same kind of thing.
const std::vector<std::vector<std::string>> kKinds{
    {".obj", ".ply", ".3ds", ".gltf", ".glb"},
    {".png", ".jpg", ".jpeg", ".exr", ".hdr", ".pfm"},
};

/// How many names of an installed package an error lists.
constexpr std::size_t kMaxListed = 8;

/// True if the path ends with the suffix at a folder boundary: "/a/b.obj" with "b.obj".
bool ends_with_path(std::string_view path, std::string_view suffix) {
  if (!path.ends_with(suffix)) return false;
  return path.size() == suffix.size() || path[path.size() - suffix.size() - 1] == '/';
}

/// The paths of an installed package. @return nothing if it is not installed
std::optional<std::vector<std::string>> paths_of_package(const std::string& package,
                                                         const std::filesystem::path& lists) {
  std::optional<std::vector<std::string>> paths;
  // Packages for several architectures at once carry the architecture in their list's name.
  for (const char* architecture : {"", ":amd64", ":arm64"}) {
    std::ifstream list(lists / fmt::format("{}{}.list", package, architecture));
    if (!list) continue;
    if (!paths) paths.emplace();
    for (std::string line; std::getline(list, line);) paths->push_back(line);
  }
  return paths;
}

/// The extensions of the kind of file that `file` is, its own at least.
std::vector<std::string> extensions_like(const std::string& file) {
  const std::string extension = base::kebab_case(std::filesystem::path(file).extension().string());
  for (const auto& kind : kKinds) {
    if (std::ranges::find(kind, extension) != kind.end()) return kind;
  }
  return {extension};
}

/// What a package has of the kind of `file`: "a.obj, b.obj and 3 more".
std::string names_like(const std::string& file, const std::vector<std::string>& paths) {
  const auto extensions = extensions_like(file);
  std::vector<std::string> names;
  for (const std::filesystem::path path : paths) {
    const std::string extension = base::kebab_case(path.extension().string());
    if (std::ranges::find(extensions, extension) == extensions.end()) continue;
    if (std::filesystem::is_regular_file(path)) names.push_back(path.filename().string());
  }
  if (names.empty()) return fmt::format("no {}", fmt::join(extensions, ", "));
  std::ranges::sort(names);
  const std::size_t listed = std::min(names.size(), kMaxListed);
  const std::string text =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<long>(listed), ", "));
  return listed == names.size() ? text : fmt::format("{} and {} more", text, names.size() - listed);
}

/// Finds a package's file by the end of its path. @throws base::InputError at the place
std::filesystem::path find_in_package(const std::string& file, const std::string& package,
                                      const std::filesystem::path& lists,
                                      const base::Place& place) {
  const auto paths = paths_of_package(package, lists);
  if (!paths) {
    throw base::InputError(
        place,
        fmt::format("{}: not found; it is in the Debian package {} (sudo apt-get install {})", file,
                    package, package));
  }
  std::string gone;
  for (const std::string& path : *paths) {
    if (!ends_with_path(path, file)) continue;
    if (std::filesystem::is_regular_file(path)) return path;
    if (!std::filesystem::exists(path)) gone = path;
  }
  if (!gone.empty()) {
    throw base::InputError(
        place, fmt::format("{}: the installed Debian package {} lists {}, which is not there (sudo "
                           "apt-get install --reinstall {})",
                           file, package, gone, package));
  }
  throw base::InputError(
      place,
      fmt::format("\"{}\": not among the files of the installed Debian package {}; it has: {}",
                  file, package, names_like(file, *paths)));
}

}  // namespace

std::filesystem::path read_file_reference(base::MapReader& reader,
                                          const std::filesystem::path& folder,
                                          const std::filesystem::path& package_lists) {
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
  return find_in_package(file, package, package_lists, file_node.place());
}

}  // namespace renderers::scene
