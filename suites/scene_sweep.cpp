#include "suites/scene_sweep.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/names.h"
#include "results/row_selector.h"
#include "suites/safe_name.h"

namespace suites {
namespace {

/// One key of `matrix` or `zip`.
struct Axis {
  std::string name;                    ///< snake_case
  const base::Node* labels = nullptr;  ///< {label: overlay}; null for an axis of single values
  std::string path;                    ///< of single values: where they go
  base::Place path_place;
  base::Node values;  ///< the list of labels or values that parameter_grid combines
};

bool is_point_list(const std::string& key) { return key == "include" || key == "exclude"; }

base::Node label_node(const std::string& label, const base::Place& place) {
  const base::Node node = base::Node::from_text(label, place);
  read_safe_name(node, "label");
  return node;
}

void check_path(const base::Node& node, const std::string& path) {
  const bool has_gap = path.empty() || path.front() == '.' || path.back() == '.' ||
                       path.find("..") != std::string::npos;
  if (!has_gap) return;
  throw base::InputError(
      node.place(),
      fmt::format("path \"{}\" has an empty part; accepted: keys and numbers of list entries with "
                  "a dot between them, e.g. lights.key.position.1",
                  path));
}

/// {path: ..., values: [...]}
Axis read_value_axis(const std::string& name, const base::Node& node) {
  base::MapReader reader(node, fmt::format("axis \"{}\"", name));
  const base::Node& path = reader.require("path");
  Axis axis;
  axis.name = base::snake_case(name);
  axis.path = path.text("path");
  axis.path_place = path.place();
  axis.values = reader.require("values");
  reader.finish();
  check_path(path, axis.path);
  std::vector<std::string> texts;
  for (const base::Node& value : axis.values.list("values")) {
    const std::string text = value.scalar_text("a value");
    if (!value.is_number()) read_safe_name(value, "value");
    if (std::find(texts.begin(), texts.end(), text) != texts.end()) {
      throw base::InputError(value.place(), fmt::format("{} holds {} twice", name, text));
    }
    texts.push_back(text);
  }
  return axis;
}

Axis read_axis(const std::string& name, const base::Node& node) {
  base::MapReader reader(
      node,
      fmt::format("axis \"{}\", {{label: {{what it sets}}, ...}} or {{path, values}},", name));
  if (node.find("path") != nullptr) return read_value_axis(name, node);
  Axis axis;
  axis.name = base::snake_case(name);
  axis.labels = &node;
  axis.values = base::Node::make_list(node.place());
  for (const auto& [label, overlay] : node.entries()) {
    const base::MapReader what_it_sets(overlay, fmt::format("{} of axis \"{}\"", label, name));
    axis.values.append(label_node(label, node.key_place(label)));
  }
  return axis;
}

/// The axes of `matrix` or `zip`, and the map of lists that parameter_grid reads.
class GridSource {
 public:
  /// @param node  null: the key is absent
  GridSource(const base::Node* node, const char* what, std::vector<Axis>& axes) {
    if (node == nullptr) return;
    if (!node->is_map()) {
      throw base::InputError(node->place(), fmt::format("{} must be a map of axes; found {}", what,
                                                        base::Node::kind_name(node->kind())));
    }
    lists_ = base::Node::make_map(node->place());
    for (const auto& [key, value] : node->entries()) {
      if (is_point_list(key)) continue;
      axes.push_back(read_axis(key, value));
      lists_.set(key, axes.back().values, node->key_place(key));
    }
  }
  const base::Node* lists() const { return lists_.is_map() ? &lists_ : nullptr; }

 private:
  base::Node lists_;
};

const Axis* find_axis(const std::vector<Axis>& axes, const std::string& name) {
  const auto found = std::find_if(axes.begin(), axes.end(), [&](const Axis& axis) {
    return base::is_same_name(axis.name, name);
  });
  return found == axes.end() ? nullptr : &*found;
}

/// A map of `include` or `exclude`, its labels as text and known.
base::Node checked_point(const base::Node& item, const std::vector<Axis>& axes) {
  base::Node point = base::Node::make_map(item.place());
  for (const auto& [key, value] : item.entries()) {
    const Axis* axis = find_axis(axes, key);
    if (axis == nullptr) {
      std::vector<std::string> known;
      for (const Axis& one : axes) known.push_back(one.name);
      throw base::InputError(item.key_place(key), base::unknown_name("axis", key, known));
    }
    const std::string text = value.scalar_text(key);
    if (axis->labels == nullptr) {
      point.set(axis->name, value, item.key_place(key));
      continue;
    }
    if (axis->labels->find(text) == nullptr) {
      std::vector<std::string> known;
      for (const auto& [label, overlay] : axis->labels->entries()) known.push_back(label);
      throw base::InputError(value.place(),
                             base::unknown_name("label of " + axis->name, text, known));
    }
    point.set(axis->name, base::Node::from_text(text, value.place()), item.key_place(key));
  }
  return point.entries().empty() ? item : point;
}

base::Node checked_points(const base::Node& list, const char* what, const std::vector<Axis>& axes) {
  base::Node points = base::Node::make_list(list.place());
  for (const base::Node& item : list.list(what)) points.append(checked_point(item, axes));
  return points;
}

/// {lights: {key: {position: {1: value}}}} of "lights.key.position.1".
base::Node nested(std::string_view path, const base::Place& place, const base::Node& value) {
  const std::size_t dot = path.find('.');
  base::Node map = base::Node::make_map(value.place());
  const bool is_last = dot == std::string_view::npos;
  map.set(std::string(path.substr(0, dot)),
          is_last ? value : nested(path.substr(dot + 1), place, value), place);
  return map;
}

base::ParameterValue sweep_value(const base::Node& node) {
  switch (node.kind()) {
    case base::Node::Kind::boolean:
      return node.boolean("value");
    case base::Node::Kind::integer:
      return node.integer("value");
    case base::Node::Kind::real:
      return node.number("value");
    default:
      return node.scalar_text("value");
  }
}

SuiteScene scene_at(const SuiteScene& entry, const std::vector<Axis>& axes,
                    const GridPoint& point) {
  SuiteScene scene = entry;
  std::string values;
  for (const auto& [name, value] : point) {
    const Axis& axis = *find_axis(axes, name);
    if (axis.labels != nullptr) {
      scene.sweep_settings.push_back({*axis.labels->find(value.scalar_text("label")), ""});
    } else {
      scene.sweep_settings.push_back({nested(axis.path, axis.path_place, value), axis.path});
    }
    scene.sweep.emplace_back(axis.name, sweep_value(value));
    values += fmt::format("{}{}={}", values.empty() ? "" : ",", axis.name,
                          results::text_of(scene.sweep.back().second));
  }
  if (!values.empty()) scene.id += fmt::format("[{}]", values);
  return scene;
}

}  // namespace

std::vector<base::Node> SuiteScene::overlays() const {
  std::vector<base::Node> overlays;
  if (set) overlays.push_back(*set);
  for (const SceneSetting& setting : sweep_settings) overlays.push_back(setting.overlay);
  return overlays;
}

std::vector<SuiteScene> swept_scenes(const SuiteScene& entry, const GridKeys& keys) {
  std::vector<Axis> axes;
  const GridSource matrix(keys.matrix, "matrix", axes);
  const GridSource zip(keys.zip, "zip", axes);
  GridKeys lists{matrix.lists(), zip.lists(), nullptr, nullptr};
  base::Node include;
  base::Node exclude;
  const GridKeys found = with_points_inside(keys);
  if (found.include != nullptr) {
    include = checked_points(*found.include, "include", axes);
    lists.include = &include;
  }
  if (found.exclude != nullptr) {
    exclude = checked_points(*found.exclude, "exclude", axes);
    lists.exclude = &exclude;
  }
  std::vector<SuiteScene> scenes;
  for (const GridPoint& point : parameter_grid(lists)) {
    scenes.push_back(scene_at(entry, axes, point));
  }
  return scenes;
}

}  // namespace suites
