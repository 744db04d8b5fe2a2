#include "renderers/scene/scene_overlay.h"

#include "perception/base/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <vector>

namespace renderers::scene {
namespace {

std::optional<std::size_t> index_of(const std::string& key) {
  std::size_t index = 0;
  const char* end = key.data() + key.size();
  const auto result = std::from_chars(key.data(), end, index);
  if (result.ec != std::errc{} || result.ptr != end) return std::nullopt;
  return index;
}

base::Node patched(const base::Node* below, const base::Node& above, const std::string& what);

/// A list with the entries replaced that the map names by number.
base::Node with_entries_set(const base::Node& below, const base::Node& above,
                            const std::string& what) {
  std::vector<base::Node> entries = below.list(what);
  for (const auto& [key, value] : above.entries()) {
    const std::optional<std::size_t> index = index_of(key);
    if (!index || *index >= entries.size()) {
      throw base::InputError(above.key_place(key),
                             fmt::format("{} is a list of {}; accepted: a list, or entries by "
                                         "number from 0; found entry \"{}\"",
                                         what, entries.size(), key));
    }
    if (value.is_null()) {
      throw base::InputError(
          value.place(),
          fmt::format("entry {} of {} cannot be taken away; write the list", key, what));
    }
    entries[*index] = patched(&entries[*index], value, fmt::format("{}.{}", what, key));
  }
  base::Node merged = base::Node::make_list(above.place());
  for (base::Node& entry : entries) merged.append(std::move(entry));
  return merged;
}

/// "name, type, position"
std::string keys_text(const base::Node& map) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : map.entries()) keys.push_back(key);
  return keys.empty() ? "nothing" : fmt::format("{}", fmt::join(keys, ", "));
}

/// A map with the keys of another laid over it.
base::Node with_keys_set(const base::Node& below, const base::Node& above,
                         const std::string& what) {
  base::Node merged = base::Node::make_map(above.place());
  for (const auto& [key, value] : below.entries()) {
    const base::Node* change = above.find(key);
    if (change == nullptr) {
      merged.set(key, value, below.key_place(key));
    } else if (!change->is_null()) {
      merged.set(key, patched(&value, *change, key), above.key_place(key));
    }
  }
  for (const auto& [key, value] : above.entries()) {
    if (below.find(key) != nullptr) continue;
    if (value.is_null()) {
      throw base::InputError(
          above.key_place(key),
          fmt::format("{} has no {} to take away; it has {}", what, key, keys_text(below)));
    }
    if (index_of(key)) {
      throw base::InputError(
          above.key_place(key),
          fmt::format("{} is no list in the scene; it has no entry {}", what, key));
    }
    merged.set(key, patched(nullptr, value, key), above.key_place(key));
  }
  return merged;
}

/// @param below  null: absent
/// @param above  not null
base::Node patched(const base::Node* below, const base::Node& above, const std::string& what) {
  if (!above.is_map()) return above;
  if (below != nullptr && below->is_list()) return with_entries_set(*below, above, what);
  const bool is_map = below != nullptr && below->is_map();
  return with_keys_set(is_map ? *below : base::Node::make_map(above.place()), above, what);
}

class Overlayer {
 public:
  Overlayer(SceneLayers& layers, const std::filesystem::path& folder)
      : layers_(layers), folder_(folder) {}

  void lay_value(base::MapReader& reader, const char* key, SourceNode& target) {
    const base::Node* above = reader.find(key);
    if (above == nullptr) return;
    if (!above->is_null()) {
      change(target, *above, key);
    } else if (target.node == nullptr) {
      throw base::InputError(above->place(), fmt::format("scene has no {} to take away", key));
    } else {
      target = {};
    }
  }

  /// @param kind  "light", ... the key is its plural
  void lay_named(base::MapReader& reader, const std::string& kind,
                 std::vector<NamedSource>& sources) {
    const base::Node* above = reader.find(kind + "s");
    if (above == nullptr) return;
    if (!above->is_map()) {
      throw base::InputError(
          above->place(),
          fmt::format("{0}s must be a map of the scene's {0}s to what changes, {{name: {{...}}}}, "
                      "not {1}",
                      kind, base::Node::kind_name(above->kind())));
    }
    for (const auto& [key, value] : above->entries()) {
      const auto found = find(sources, kind, key, above->key_place(key));
      if (value.is_null()) {
        sources.erase(found);
        continue;
      }
      const std::string what = fmt::format("{} \"{}\"", kind, found->name);
      const base::MapReader changes(value, what);
      if (kind != "material" && value.find("name") != nullptr) {
        throw base::InputError(value.key_place("name"), "the name of " + what + " cannot change");
      }
      change(found->source, value, what);
    }
  }

 private:
  static std::vector<NamedSource>::iterator find(std::vector<NamedSource>& sources,
                                                 const std::string& kind, const std::string& name,
                                                 const base::Place& place) {
    const auto found = std::ranges::find(sources, base::kebab_case(name), &NamedSource::name);
    if (found != sources.end()) return found;
    std::vector<std::string> known;
    for (const NamedSource& source : sources) known.push_back(source.name);
    throw base::InputError(place, base::unknown_name(kind, name, known));
  }

  void change(SourceNode& target, const base::Node& above, const std::string& what) {
    layers_.held.push_back(patched(target.node, above, what));
    if (target.node == nullptr) target.folder = folder_;
    target.node = &layers_.held.back();
  }

  SceneLayers& layers_;
  const std::filesystem::path& folder_;
};

}  // namespace

void lay_over(SceneLayers& layers, const base::Node& overlay, const std::filesystem::path& folder) {
  base::MapReader reader(overlay, "what a scene is set to");
  Overlayer overlayer(layers, folder);
  overlayer.lay_value(reader, "camera", layers.camera);
  overlayer.lay_value(reader, "environment", layers.environment);
  overlayer.lay_value(reader, "luminance_scale_cd_m2", layers.luminance_scale);
  overlayer.lay_named(reader, "material", layers.materials);
  overlayer.lay_named(reader, "object", layers.objects);
  overlayer.lay_named(reader, "light", layers.lights);
  reader.finish();
}

}  // namespace renderers::scene
