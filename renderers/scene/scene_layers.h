#pragma once

#include "perception/base/document.h"

#include <deque>
#include <filesystem>
#include <string>
#include <vector>

namespace renderers::scene {

/// A value of a scene file and the folder its relative paths start at.
struct SourceNode {
  const base::Node* node = nullptr;  ///< null: absent
  std::filesystem::path folder;
};

struct NamedSource {
  std::string name;  ///< kebab-case
  SourceNode source;
};

/// A scene file after its includes: later layers replace earlier ones by name.
struct SceneLayers {
  SourceNode scene;
  SourceNode summary;
  SourceNode luminance_scale;
  SourceNode camera;
  SourceNode environment;
  std::vector<NamedSource> materials;
  std::vector<NamedSource> objects;
  std::vector<NamedSource> lights;
  std::deque<base::Node> held;  ///< keeps the nodes of included files and of overlays alive
};

/// Merges a scene document with the files it includes.
///
/// `include` names one file or a list; they are merged first, in order. `remove` then takes objects
/// and lights of the included files away by name. Keys, materials, objects and lights of this
/// document replace included ones of the same name as a whole; new ones follow them.
/// @param root  must outlive the result
/// @throws base::InputError for unknown keys, another schema, an include cycle, duplicate names
SceneLayers merge_layers(const base::Node& root, const std::filesystem::path& folder);

}  // namespace renderers::scene
