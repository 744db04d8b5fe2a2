#include "renderers/scene/scene_layers.h"

#include "perception/base/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace renderers::scene {
namespace {

constexpr int kSceneSchema = 1;

NamedSource* find_named(std::vector<NamedSource>& sources, const std::string& name) {
  const auto found = std::ranges::find(sources, name, &NamedSource::name);
  return found == sources.end() ? nullptr : &*found;
}

/// One layer's entries over those of the layers below.
void overlay(std::vector<NamedSource>& below, const std::vector<NamedSource>& layer) {
  for (const NamedSource& entry : layer) {
    if (NamedSource* replaced = find_named(below, entry.name)) {
      *replaced = entry;
    } else {
      below.push_back(entry);
    }
  }
}

class LayerMerger {
 public:
  SceneLayers layers;

  /// Notes the file of the root, so that a cycle back to it is seen.
  void open_root(const std::filesystem::path& path) {
    if (std::filesystem::is_regular_file(path)) open_.push_back(std::filesystem::canonical(path));
  }

  void add(const base::Node& node, const std::filesystem::path& folder) {
    base::MapReader reader(node, "scene file");
    check_schema(reader.require("schema"));
    if (const auto* include = reader.find("include")) add_includes(*include, folder);
    if (const auto* names = reader.find("remove")) remove(*names);
    const auto replace = [&](const char* key, SourceNode& target) {
      if (const auto* value = reader.find(key)) target = {value, folder};
    };
    replace("scene", layers.scene);
    replace("summary", layers.summary);
    replace("luminance_scale_cd_m2", layers.luminance_scale);
    replace("camera", layers.camera);
    replace("environment", layers.environment);
    if (const auto* materials = reader.find("materials")) add_materials(*materials, folder);
    if (const auto* objects = reader.find("objects")) {
      overlay(layers.objects, named_list(*objects, "object", folder));
    }
    if (const auto* lights = reader.find("lights")) {
      overlay(layers.lights, named_list(*lights, "light", folder));
    }
    reader.finish();
  }

 private:
  static void check_schema(const base::Node& node) {
    const auto schema = node.integer("schema");
    if (schema != kSceneSchema) {
      throw base::InputError(
          node.place(),
          fmt::format("schema {} is unknown; this program reads {}", schema, kSceneSchema));
    }
  }

  void add_includes(const base::Node& node, const std::filesystem::path& folder) {
    if (!node.is_list()) return add_include(node, folder);
    for (const base::Node& entry : node.list("include")) add_include(entry, folder);
  }

  void add_include(const base::Node& node, const std::filesystem::path& folder) {
    const std::string& name = node.text("include");
    const std::filesystem::path path = folder / name;
    if (!std::filesystem::is_regular_file(path)) {
      throw base::InputError(node.place(), fmt::format("included file {} not found (looked for {})",
                                                       name, path.string()));
    }
    const std::filesystem::path canonical = std::filesystem::canonical(path);
    if (std::ranges::find(open_, canonical) != open_.end()) {
      throw base::InputError(node.place(), fmt::format("{} includes itself", name));
    }
    open_.push_back(canonical);
    layers.held.push_back(base::read_document(path));
    add(layers.held.back(), path.parent_path());
    open_.pop_back();
  }

  void remove(const base::Node& node) {
    for (const base::Node& entry : node.list("remove")) {
      const std::string name = base::kebab_case(entry.text("a name to remove"));
      const auto has_name = [&](const NamedSource& source) { return source.name == name; };
      const std::vector<std::string> known = object_and_light_names();
      if (std::erase_if(layers.objects, has_name) + std::erase_if(layers.lights, has_name) == 0) {
        throw base::InputError(entry.place(),
                               base::unknown_name("included object or light", name, known));
      }
    }
  }

  std::vector<std::string> object_and_light_names() const {
    std::vector<std::string> names;
    for (const NamedSource& object : layers.objects) names.push_back(object.name);
    for (const NamedSource& light : layers.lights) names.push_back(light.name);
    return names;
  }

  void add_materials(const base::Node& node, const std::filesystem::path& folder) {
    if (!node.is_map()) {
      throw base::InputError(node.place(), "materials must be a map: {name: {albedo: ...}, ...}");
    }
    std::vector<NamedSource> materials;
    for (const auto& [key, value] : node.entries()) {
      add_unique(materials, {base::kebab_case(key), {&value, folder}}, "material",
                 node.key_place(key));
    }
    overlay(layers.materials, materials);
  }

  static std::vector<NamedSource> named_list(const base::Node& node, const char* kind,
                                             const std::filesystem::path& folder) {
    std::vector<NamedSource> result;
    for (const base::Node& entry : node.list(fmt::format("{}s", kind))) {
      const base::Node* name = entry.find("name");
      if (name == nullptr) {
        throw base::InputError(entry.place(),
                               fmt::format("this {} has no name; add name: ...", kind));
      }
      add_unique(result, {base::kebab_case(name->text("name")), {&entry, folder}}, kind,
                 name->place());
    }
    return result;
  }

  static void add_unique(std::vector<NamedSource>& sources, NamedSource entry, const char* kind,
                         const base::Place& place) {
    if (const NamedSource* first = find_named(sources, entry.name)) {
      throw base::InputError(place,
                             fmt::format("{} \"{}\" is already there, at {}", kind, entry.name,
                                         base::to_string(first->source.node->place())));
    }
    sources.push_back(std::move(entry));
  }

  std::vector<std::filesystem::path> open_;
};

}  // namespace

SceneLayers merge_layers(const base::Node& root, const std::filesystem::path& folder) {
  LayerMerger merger;
  merger.open_root(root.place().file);
  merger.add(root, folder);
  return std::move(merger.layers);
}

}  // namespace renderers::scene
