#include "perception/base/names.h"
#include "renderers/scene/scene_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace renderers::scene {

std::vector<CatalogEntry> list_scene_files(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) {
    throw base::InputError(fmt::format("{}: no folder of scenes there", folder.string()));
  }
  std::vector<CatalogEntry> entries;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().extension() != ".yaml") continue;
    entries.push_back({entry.path().stem().string(), entry.path()});
  }
  std::ranges::sort(entries, {}, &CatalogEntry::name);
  return entries;
}

std::filesystem::path find_scene_file(std::string_view path_or_name,
                                      const std::filesystem::path& catalog_folder,
                                      const std::filesystem::path& relative_to,
                                      const base::Place& place) {
  const bool is_path = path_or_name.find('/') != std::string_view::npos ||
                       path_or_name.ends_with(".yaml") || path_or_name.ends_with(".json");
  if (is_path) {
    const std::filesystem::path path = relative_to / path_or_name;
    if (std::filesystem::is_regular_file(path)) return path.lexically_normal();
    throw base::InputError(place, fmt::format("scene file {} not found (looked for {})",
                                              path_or_name, path.lexically_normal().string()));
  }
  std::vector<std::string> known;
  for (const CatalogEntry& entry : list_scene_files(catalog_folder)) {
    if (base::is_same_name(entry.name, path_or_name)) return entry.path;
    known.push_back(entry.name);
  }
  throw base::InputError(place, base::unknown_name("scene", path_or_name, known));
}

}  // namespace renderers::scene
