#pragma once

#include "perception/base/document.h"
#include "renderers/scene/scene.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace renderers::scene {

/// A scene file, read and checked: meshes and textures are loaded, animation is kept as keys.
class SceneFile {
 public:
  SceneFile();
  ~SceneFile();
  SceneFile(SceneFile&&) noexcept;
  SceneFile& operator=(SceneFile&&) noexcept;

  const std::string& name() const;
  const std::string& summary() const;
  int frame_count() const;  ///< 1 for a static scene; up to the last key of anything
  /// The scene at a frame, a function of the frame alone. Between keys rotations and a spot's
  /// direction turn at constant speed, all else is linear; frames beyond the last key hold its
  /// state. Meshes that do not change are shared by all frames.
  /// @throws base::InputError for a negative frame, a bend that turns its mesh inside out there
  Scene at_frame(int frame) const;
  std::vector<std::string> warnings() const;  ///< e.g. zero-area triangles that were dropped

  struct Content;

 private:
  friend SceneFile parse_scene(const base::Node&, const std::filesystem::path& folder,
                               std::span<const base::Node> overlays);
  std::unique_ptr<Content> content_;
};

/// Reads a scene file (format: suites/scenes/README.md).
/// @param overlays  laid over the file one after the other, see lay_over in scene_overlay.h
/// @throws base::InputError with file:line:column: unknown key, missing mesh (names the Debian
///   package), truncated mesh, missing camera, unknown material, ...
SceneFile read_scene_file(const std::filesystem::path& path,
                          std::span<const base::Node> overlays = {});

/// Same from a parsed document; relative paths start at `folder`.
SceneFile parse_scene(const base::Node& node, const std::filesystem::path& folder,
                      std::span<const base::Node> overlays = {});

/// Catalogue: the *.yaml files of a folder, sorted by name.
struct CatalogEntry {
  std::string name;
  std::filesystem::path path;
};
std::vector<CatalogEntry> list_scene_files(const std::filesystem::path& folder);

/// A scene by path (if it has a slash or ends with .yaml or .json) or by catalogue name.
/// @throws base::InputError with the nearest known name
std::filesystem::path find_scene_file(std::string_view path_or_name,
                                      const std::filesystem::path& catalog_folder,
                                      const std::filesystem::path& relative_to,
                                      const base::Place& place);

}  // namespace renderers::scene
