#include "suites/suite_profiles.h"

#include <algorithm>
#include <initializer_list>

#include <fmt/format.h>

#include "perception/base/names.h"
#include "suites/safe_name.h"

namespace suites {
namespace {

/// Deep merge: maps key by key, everything else replaced.
base::Node overlaid(const base::Node& below, const base::Node& above) {
  if (!below.is_map() || !above.is_map()) return above;
  base::Node merged = below;
  for (const auto& [key, value] : above.entries()) {
    const base::Node* own = below.find(key);
    merged.set(key, own == nullptr ? value : overlaid(*own, value), above.key_place(key));
  }
  return merged;
}

void check_keys(const base::Node& node, const std::string& what,
                std::initializer_list<const char*> keys) {
  base::MapReader reader(node, what);
  for (const char* key : keys) reader.find(key);
  reader.finish();
}

std::string id_of(const base::Node& item) {
  const base::Node* id = item.is_map() ? item.find("id") : nullptr;
  return id != nullptr && id->is_scalar() ? id->scalar_text("id") : std::string();
}

/// The items of a list with the profile's maps laid over those of the same id.
base::Node overlaid_items(const base::Node& items, const base::Node& by_id, const std::string& kind,
                          std::initializer_list<const char*> keys) {
  std::vector<std::string> ids;
  for (const base::Node& item : items.list(kind + "s")) ids.push_back(id_of(item));
  base::MapReader entries(by_id, fmt::format("{}s of a profile", kind));
  for (const auto& [id, values] : by_id.entries()) {
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) {
      throw base::InputError(by_id.key_place(id), base::unknown_name(kind, id, ids));
    }
    check_keys(values, fmt::format("{} \"{}\" of a profile", kind, id), keys);
  }
  base::Node merged = base::Node::make_list(items.place());
  for (const base::Node& item : items.list(kind + "s")) {
    base::Node copy = item;
    for (const auto& [id, values] : by_id.entries()) {
      if (id == id_of(item)) copy = overlaid(copy, values);
    }
    merged.append(std::move(copy));
  }
  return merged;
}

/// A map without the keys of another one.
base::Node without_keys(const base::Node& map, const base::Node& keys) {
  base::Node kept = base::Node::make_map(map.place());
  for (const auto& [key, value] : map.entries()) {
    if (keys.find(key) == nullptr) kept.set(key, value, map.key_place(key));
  }
  return kept;
}

/// The items of a list, their own `measure` without what a profile states for all.
base::Node without_measure(const base::Node& items, const base::Node& stated) {
  base::Node list = base::Node::make_list(items.place());
  for (const base::Node& item : items.list("items")) {
    base::Node copy = item;
    const base::Node* own = item.is_map() ? item.find("measure") : nullptr;
    if (own != nullptr && own->is_map()) {
      copy.set("measure", without_keys(*own, stated), item.key_place("measure"));
    }
    list.append(std::move(copy));
  }
  return list;
}

/// The suite's document before a profile that states how to measure is laid over it.
base::Node without_own_measure(const base::Node& suite, const base::Node* stated) {
  base::Node cleared = suite;
  if (stated == nullptr || !stated->is_map()) return cleared;
  for (const char* key : {"scenes", "methods"}) {
    const base::Node* items = suite.find(key);
    if (items == nullptr || !items->is_list()) continue;
    cleared.set(key, without_measure(*items, *stated), suite.key_place(key));
  }
  return cleared;
}

}  // namespace

std::vector<std::string> profile_names(const base::Node& suite) {
  std::vector<std::string> names;
  const base::Node* profiles = suite.find("profiles");
  if (profiles == nullptr) return names;
  base::MapReader reader(*profiles, "profiles");
  for (const auto& [name, values] : profiles->entries()) {
    require_safe_name(name, "profile", profiles->key_place(name));
    names.push_back(name);
  }
  return names;
}

base::Node with_profile(const base::Node& suite, const std::string& profile) {
  const std::vector<std::string> known = profile_names(suite);
  if (std::find(known.begin(), known.end(), profile) == known.end()) {
    const base::Place place{suite.place().file, 0, 0};
    if (known.empty()) {
      throw base::InputError(
          place, fmt::format("unknown profile \"{}\"; this suite has no profiles", profile));
    }
    throw base::InputError(place, base::unknown_name("profile", profile, known));
  }
  const base::Node& values = *suite.find("profiles")->find(profile);
  if (values.is_null()) return suite;
  check_keys(values, fmt::format("profile \"{}\"", profile),
             {"scenes", "methods", "budgets", "measure"});
  const base::Node below = without_own_measure(suite, values.find("measure"));
  base::Node merged = below;
  for (const auto& [key, value] : values.entries()) {
    const base::Node* own = below.find(key);
    const base::Place place = values.key_place(key);
    if (own == nullptr) {
      merged.set(key, value, place);
    } else if (base::is_same_name(key, "scenes")) {
      merged.set(key,
                 overlaid_items(*own, value, "scene",
                                {"size", "frame", "frames", "reference", "set", "matrix", "zip",
                                 "include", "exclude", "measure"}),
                 place);
    } else if (base::is_same_name(key, "methods")) {
      merged.set(key,
                 overlaid_items(*own, value, "method",
                                {"preset", "parameters", "scenes", "matrix", "zip", "include",
                                 "exclude", "search", "budgets", "measure"}),
                 place);
    } else {
      merged.set(key, overlaid(*own, value), place);
    }
  }
  return merged;
}

}  // namespace suites
