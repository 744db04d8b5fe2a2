#include "suites/suite_metrics.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "perception/base/names.h"
#include "suites/safe_name.h"
#include "suites/suite_file.h"

namespace suites {
namespace {

constexpr std::int64_t kMostDistance_px = 1000;

/// A list of ids. @return empty if the key is absent
std::vector<std::string> read_ids(base::MapReader& reader, const char* key) {
  std::vector<std::string> ids;
  const base::Node* node = reader.find(key);
  if (node == nullptr) return ids;
  for (const base::Node& id : node->list(key)) ids.push_back(id.text(key));
  if (ids.empty()) throw base::InputError(node->place(), fmt::format("{} is empty", key));
  return ids;
}

int read_distance(const base::Node& node, const char* key) {
  const std::int64_t distance_px = node.integer(key);
  if (distance_px >= 0 && distance_px <= kMostDistance_px) return static_cast<int>(distance_px);
  throw base::InputError(
      node.place(), fmt::format("{} is {}; accepted: 0 to {}", key, distance_px, kMostDistance_px));
}

/// {edges_of: AOV, within_px: N} or {interior_of: AOV, beyond_px: N}.
MaskSpec read_edge_mask(const base::Node& node) {
  base::MapReader reader(node, "mask");
  MaskSpec mask;
  const base::Node* edges = reader.find("edges_of");
  const base::Node* interior = reader.find("interior_of");
  if ((edges == nullptr) == (interior == nullptr)) {
    throw base::InputError(node.place(),
                           "mask needs one of {edges_of: AOV, within_px: N} and {interior_of: AOV, "
                           "beyond_px: N}, or is the name of an AOV or a file");
  }
  mask.kind = edges != nullptr ? MaskSpec::Kind::edges : MaskSpec::Kind::interior;
  mask.aov = edges != nullptr ? edges->text("edges_of") : interior->text("interior_of");
  const char* key = edges != nullptr ? "within_px" : "beyond_px";
  mask.distance_px = read_distance(reader.require(key), key);
  reader.finish();
  return mask;
}

/// A name with a dot in it is that of a file.
MaskSpec read_mask(const base::Node& node, const std::filesystem::path& folder) {
  if (node.is_map()) return read_edge_mask(node);
  MaskSpec mask;
  mask.kind = MaskSpec::Kind::above_half;
  const std::string& name = node.text("mask");
  if (name.find('.') == std::string::npos) {
    mask.aov = name;
    return mask;
  }
  mask.file = std::filesystem::absolute(folder / name).lexically_normal();
  if (std::filesystem::exists(mask.file)) return mask;
  throw base::InputError(node.place(),
                         fmt::format("mask {} does not exist; accepted: the name of an AOV of the "
                                     "reference, or an image beside this file",
                                     mask.file.string()));
}

std::vector<std::string> read_against(base::MapReader& reader, bool needs_aovs) {
  const base::Node* node = reader.find("against");
  // Only own pictures keep their AOVs.
  if (node == nullptr && needs_aovs) return {"own"};
  if (node == nullptr) return {"own", "full"};
  const std::vector<std::string> known{"own", "full"};
  std::vector<std::string> sides;
  const std::vector<base::Node> items =
      node->is_list() ? node->list("against") : std::vector<base::Node>{*node};
  for (const base::Node& item : items) {
    sides.push_back(item.text("against"));
    if (std::find(known.begin(), known.end(), sides.back()) != known.end()) continue;
    throw base::InputError(item.place(), base::unknown_name("against", sides.back(), known));
  }
  if (sides.empty()) throw base::InputError(node->place(), "against is empty");
  return sides;
}

/// Of which frames of a sequence maps are kept.
bool read_keeps_all_maps(base::MapReader& reader) {
  const base::Node* node = reader.find("maps");
  if (node == nullptr) return false;
  const std::vector<std::string> known{"first_frame", "all_frames"};
  const std::string& name = node->text("maps");
  if (std::find(known.begin(), known.end(), name) != known.end()) return name == known.back();
  throw base::InputError(node->place(), base::unknown_name("maps", name, known));
}

double read_scale(base::MapReader& reader, const std::string& image) {
  const base::Node* node = reader.find("scale");
  if (node == nullptr) return 1.0;
  const double scale = node->number("scale");
  if (scale > 0.0 && !image.empty()) return scale;
  throw base::InputError(
      node->place(),
      fmt::format("scale is {}; accepted: above 0, with an `image` that it is of", scale));
}

/// The metric with its parameters, as a text gives it.
std::string metric_text(const base::Node& metric, const base::Node* parameters) {
  std::string text = metric.text("metric");
  if (parameters == nullptr) return text;
  const base::MapReader map(*parameters, "parameters");
  for (const auto& [key, value] : parameters->entries()) {
    text += fmt::format(",{}={}", key, value.scalar_text(key));
  }
  return text;
}

void check_id(const std::string& id, const base::Place& place) {
  if (metrics::find_description(id) == nullptr) return;
  throw base::InputError(
      place, fmt::format("id \"{}\" is the name of a metric; accepted: another name", id));
}

/// The frames of a sequence share one mask; that of an AOV would change with them.
void check_mask(const SuiteMetric& metric, const base::Place& place) {
  if (std::holds_alternative<metrics::MetricChoice>(metric.choice) || metric.mask.aov.empty()) {
    return;
  }
  throw base::InputError(place,
                         fmt::format("metric \"{}\" scores sequences and cannot have the "
                                     "mask {}; accepted: a file",
                                     description_of(metric.choice).name, metric.mask.text()));
}

SuiteMetric read_entry(const base::Node& node, const std::filesystem::path& folder) {
  base::MapReader reader(node, "metric");
  SuiteMetric metric;
  const base::Node& id = reader.require("id");
  metric.id = read_safe_name(id, "id");
  check_id(metric.id, id.place());
  const base::Node& name = reader.require("metric");
  metric.choice =
      metrics::parse_any_metric_choice(metric_text(name, reader.find("parameters")), name.place());
  std::visit([&](auto& one) { one.text = metric.id + ":" + one.text; }, metric.choice);
  metric.image = reader.text("image", "");
  metric.scale = read_scale(reader, metric.image);
  if (const base::Node* mask = reader.find("mask")) {
    metric.mask = read_mask(*mask, folder);
    check_mask(metric, mask->place());
  }
  metric.against = read_against(reader, metric.needs_aovs());
  metric.keeps_all_maps = read_keeps_all_maps(reader);
  metric.scenes = read_ids(reader, "scenes");
  metric.methods = read_ids(reader, "methods");
  reader.finish();
  return metric;
}

bool is_among(const std::vector<std::string>& ids, const std::string& id,
              const std::string& base_id) {
  return ids.empty() || std::any_of(ids.begin(), ids.end(), [&](const std::string& one) {
           return one == id || one == base_id;
         });
}

/// @param all  scenes or methods of a suite
template <class Item>
void check_ids(const char* kind, const std::vector<std::string>& ids, const std::vector<Item>& all,
               const base::Place& place) {
  std::set<std::string> known;
  for (const Item& item : all) {
    known.insert(item.id);
    known.insert(item.base_id);
  }
  for (const std::string& id : ids) {
    if (known.contains(id)) continue;
    throw base::InputError(
        place, base::unknown_name(kind, id, std::vector<std::string>(known.begin(), known.end())));
  }
}

std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

std::string to_yaml(const MaskSpec& mask) {
  if (mask.kind == MaskSpec::Kind::edges) {
    return fmt::format("{{edges_of: {}, within_px: {}}}", quoted(mask.aov), mask.distance_px);
  }
  if (mask.kind == MaskSpec::Kind::interior) {
    return fmt::format("{{interior_of: {}, beyond_px: {}}}", quoted(mask.aov), mask.distance_px);
  }
  return quoted(mask.aov.empty() ? mask.file.string() : mask.aov);
}

/// The choice without the id.
std::string plain_text(const SuiteMetric& metric) {
  const std::string& text = text_of(metric);
  return metric.id.empty() ? text : text.substr(metric.id.size() + 1);
}

}  // namespace

std::string MaskSpec::text() const {
  switch (kind) {
    case Kind::edges:
      return fmt::format("edges of {}, {} px", aov, distance_px);
    case Kind::interior:
      return fmt::format("interior of {}, {} px", aov, distance_px);
    case Kind::above_half:
      return aov.empty() ? file.string() : aov;
    case Kind::none:
      break;
  }
  return "";
}

std::string SuiteMetric::image_text() const {
  return scale == 1.0 ? image : fmt::format("{} * {}", image, scale);
}

std::vector<SuiteMetric> read_metrics(const base::Node& node, const std::filesystem::path& folder) {
  std::vector<SuiteMetric> metrics;
  std::set<std::string> names;
  for (const base::Node& item : node.list("metrics")) {
    metrics.push_back(item.is_map() ? read_entry(item, folder)
                                    : SuiteMetric(metrics::parse_any_metric_choice(
                                          item.text("metric"), item.place())));
    const SuiteMetric& last = metrics.back();
    const std::string& name = last.id.empty() ? text_of(last) : last.id;
    if (!names.insert(base::kebab_case(name)).second) {
      throw base::InputError(item.place(), fmt::format("metric \"{}\" is listed twice", name));
    }
  }
  return metrics;
}

void check_metric_places(const SuiteMetric& metric, const std::vector<SuiteScene>& scenes,
                         const std::vector<SuiteMethod>& methods, const base::Place& place) {
  check_ids("scene", metric.scenes, scenes, place);
  check_ids("method", metric.methods, methods, place);
}

bool is_wanted(const SuiteMetric& metric, const SuiteScene& scene, const SuiteMethod& method) {
  return is_among(metric.scenes, scene.id, scene.base_id) &&
         is_among(metric.methods, method.id, method.base_id);
}

std::string to_yaml(const SuiteMetric& metric) {
  if (metric.id.empty()) return quoted(text_of(metric));
  std::string text =
      fmt::format("{{id: {}, metric: {}", quoted(metric.id), quoted(plain_text(metric)));
  if (!metric.image.empty()) text += fmt::format(", image: {}", quoted(metric.image));
  if (metric.scale != 1.0) text += fmt::format(", scale: {}", metric.scale);
  if (metric.mask.kind != MaskSpec::Kind::none) {
    text += fmt::format(", mask: {}", to_yaml(metric.mask));
  }
  text += fmt::format(", against: [{}]", fmt::join(metric.against, ", "));
  if (metric.keeps_all_maps) text += ", maps: all_frames";
  const auto add_ids = [&](const char* key, const std::vector<std::string>& ids) {
    if (!ids.empty()) text += fmt::format(", {}: {}", key, nlohmann::json(ids).dump());
  };
  add_ids("scenes", metric.scenes);
  add_ids("methods", metric.methods);
  return text + "}";
}

nlohmann::ordered_json to_json(const SuiteMetric& metric) {
  if (metric.id.empty()) return text_of(metric);
  return {{"id", text_of(metric)},        {"metric", plain_text(metric)},
          {"image", metric.image_text()}, {"mask", metric.mask.text()},
          {"against", metric.against},    {"scenes", metric.scenes},
          {"methods", metric.methods}};
}

}  // namespace suites
