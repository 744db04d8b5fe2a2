#include "suites/parameter_grid.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/names.h"

namespace suites {
namespace {

/// Most points of one grid: more is a slip of the pen, not an experiment.
constexpr std::size_t kMaxPoints = 10000;

bool is_same_value(const base::Node& a, const base::Node& b) { return a.to_json() == b.to_json(); }

const base::Node* value_of(const GridPoint& point, const std::string& name) {
  const auto found = std::find_if(point.begin(), point.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  return found == point.end() ? nullptr : &found->second;
}

void set_value(GridPoint& point, const std::string& name, const base::Node& value) {
  const auto found = std::find_if(point.begin(), point.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  if (found == point.end()) {
    point.emplace_back(name, value);
  } else {
    found->second = value;
  }
}

GridPoint read_point(const base::Node& node, const char* what) {
  if (!node.is_map() || node.entries().empty()) {
    throw base::InputError(node.place(), fmt::format("an entry of {} must be a map of parameter "
                                                     "names to values, e.g. {{vals: 30}}; found {}",
                                                     what, base::Node::kind_name(node.kind())));
  }
  GridPoint point;
  for (const auto& [key, value] : node.entries()) {
    point.emplace_back(base::snake_case(key), value);
  }
  return point;
}

std::vector<GridPoint> read_points(const base::Node* node, const char* what) {
  std::vector<GridPoint> points;
  if (node == nullptr) return points;
  for (const base::Node& item : node->list(what)) points.push_back(read_point(item, what));
  return points;
}

const std::vector<base::Node>& axis_values(const std::string& name, const base::Node& node) {
  const std::vector<base::Node>& values = node.list(name);
  if (values.empty()) {
    throw base::InputError(node.place(), fmt::format("{} has no values", name));
  }
  return values;
}

/// Every combination of the axes; keys `include` and `exclude` are left to the caller.
std::vector<GridPoint> combinations(const base::Node& matrix) {
  std::vector<GridPoint> points{GridPoint{}};
  for (const auto& [key, node] : matrix.entries()) {
    if (key == "include" || key == "exclude") continue;
    std::vector<GridPoint> longer;
    const auto& values = axis_values(key, node);
    if (points.size() * values.size() > kMaxPoints) {
      throw base::InputError(matrix.place(),
                             fmt::format("matrix has more than {} combinations", kMaxPoints));
    }
    for (const GridPoint& point : points) {
      for (const base::Node& value : values) {
        longer.push_back(point);
        longer.back().emplace_back(base::snake_case(key), value);
      }
    }
    points = std::move(longer);
  }
  return points;
}

std::vector<GridPoint> zipped(const base::Node& zip) {
  std::vector<GridPoint> points;
  for (const auto& [key, node] : zip.entries()) {
    const auto& values = axis_values(key, node);
    if (points.empty()) points.resize(values.size());
    if (values.size() != points.size()) {
      throw base::InputError(node.place(),
                             fmt::format("zip needs lists of one length; {} has {}, the lists "
                                         "before it have {}",
                                         key, values.size(), points.size()));
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      points[i].emplace_back(base::snake_case(key), values[i]);
    }
  }
  if (points.empty()) throw base::InputError(zip.place(), "zip has no lists");
  return points;
}

std::vector<GridPoint> crossed(const std::vector<GridPoint>& outer,
                               const std::vector<GridPoint>& inner) {
  std::vector<GridPoint> points;
  for (const GridPoint& a : outer) {
    for (const GridPoint& b : inner) {
      points.push_back(a);
      for (const auto& [name, value] : b) {
        if (value_of(a, name) != nullptr) {
          throw base::InputError(value.place(), fmt::format("{} is in matrix and in zip", name));
        }
        points.back().emplace_back(name, value);
      }
    }
  }
  return points;
}

bool holds_all(const GridPoint& point, const GridPoint& values) {
  return std::all_of(values.begin(), values.end(), [&](const auto& entry) {
    const base::Node* own = value_of(point, entry.first);
    return own != nullptr && is_same_value(*own, entry.second);
  });
}

bool contradicts(const GridPoint& original, const GridPoint& values) {
  return std::any_of(values.begin(), values.end(), [&](const auto& entry) {
    const base::Node* own = value_of(original, entry.first);
    return own != nullptr && !is_same_value(*own, entry.second);
  });
}

void remove_excluded(std::vector<GridPoint>& points, const base::Node* exclude) {
  for (const GridPoint& values : read_points(exclude, "exclude")) {
    const auto removed =
        std::erase_if(points, [&](const GridPoint& point) { return holds_all(point, values); });
    if (removed == 0) {
      throw base::InputError(values.front().second.place(),
                             "this entry of exclude matches no combination of matrix and zip");
    }
  }
}

/// GitHub's rule: a map is added where it does not overwrite a value of the matrix; values that an
/// earlier include added may be overwritten.
void add_included(std::vector<GridPoint>& points, const base::Node* include) {
  const std::vector<GridPoint> originals = points;
  const bool is_grid = !(originals.size() == 1 && originals.front().empty());
  if (include != nullptr && !is_grid) points.clear();
  for (const GridPoint& values : read_points(include, "include")) {
    bool is_added = false;
    for (std::size_t i = 0; is_grid && i < originals.size(); ++i) {
      if (contradicts(originals[i], values)) continue;
      for (const auto& [name, value] : values) set_value(points[i], name, value);
      is_added = true;
    }
    if (!is_added) points.push_back(values);
  }
}

const base::Node* beside_or_inside(const base::Node* beside, const base::Node* matrix,
                                   const char* key) {
  const base::Node* inside = matrix == nullptr ? nullptr : matrix->find(key);
  if (beside != nullptr && inside != nullptr) {
    throw base::InputError(inside->place(),
                           fmt::format("{} stands beside matrix and inside it; keep one", key));
  }
  return beside != nullptr ? beside : inside;
}

}  // namespace

GridKeys with_points_inside(GridKeys keys) {
  keys.include = beside_or_inside(keys.include, keys.matrix, "include");
  keys.exclude = beside_or_inside(keys.exclude, keys.matrix, "exclude");
  return keys;
}

std::vector<GridPoint> parameter_grid(const GridKeys& keys) {
  const auto require_map = [](const base::Node* node, const char* what) {
    if (node == nullptr || node->is_map()) return;
    throw base::InputError(
        node->place(), fmt::format("{} must be a map of parameter names to lists; found {}", what,
                                   base::Node::kind_name(node->kind())));
  };
  require_map(keys.matrix, "matrix");
  require_map(keys.zip, "zip");
  const auto [matrix, zip, include, exclude] = with_points_inside(keys);

  std::vector<GridPoint> points{GridPoint{}};
  if (matrix != nullptr) points = combinations(*matrix);
  if (zip != nullptr) points = crossed(points, zipped(*zip));
  remove_excluded(points, exclude);
  if (points.empty() && include == nullptr) {
    throw base::InputError(exclude->place(), "exclude removes every combination");
  }
  add_included(points, include);
  return points;
}

}  // namespace suites
