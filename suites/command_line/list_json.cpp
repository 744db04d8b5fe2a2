#include "suites/command_line/list_json.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "metrics/metric_list.h"
#include "perception/base/child_process.h"
#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "renderers/renderer_list.h"
#include "renderers/scene/scene_file.h"
#include "results/run_environment.h"
#include "suites/command_line/device_probe.h"
#include "suites/command_line/scene_facts.h"
#include "suites/name_filter.h"
#include "suites/psychophysics/psychophysics_suite.h"
#include "suites/suite_file.h"

namespace suites::command_line {

using nlohmann::ordered_json;

namespace {

ordered_json parameters_json(const std::vector<base::ParameterSpec>& specs) {
  ordered_json json = ordered_json::array();
  for (const base::ParameterSpec& spec : specs) json.push_back(base::to_json(spec));
  return json;
}

ordered_json renderer_json(const renderers::RendererInfo& info) {
  ordered_json claims = ordered_json::array();
  for (const renderers::Claims& possible : info.possible_claims) {
    claims.push_back({{"transport", renderers::to_string(possible.transport)},
                      {"part", renderers::to_string(possible.part)}});
  }
  ordered_json supports = ordered_json::array();
  for (const auto feature : info.supports) {
    supports.push_back(renderers::scene::to_string(feature));
  }
  ordered_json presets = ordered_json::object();
  for (const base::Preset& preset : info.presets) {
    ordered_json values = ordered_json::object();
    for (const auto& [name, value] : preset.values) values[name] = base::to_json(value);
    presets[preset.name] = std::move(values);
  }
  ordered_json progressive;
  if (info.progressive_unit) progressive["unit"] = *info.progressive_unit;
  return {{"name", info.name},
          {"summary", info.summary},
          {"source", info.source},
          {"claims", std::move(claims)},
          {"supports", std::move(supports)},
          {"progressive", std::move(progressive)},
          {"uses_seed", info.uses_seed},
          {"history", info.history},
          {"parameters", parameters_json(info.parameters)},
          {"presets", std::move(presets)}};
}

ordered_json metric_json(const metrics::MetricDescription& info) {
  return {{"name", info.name},
          {"summary", info.summary},
          {"unit", info.unit},
          {"source", info.source},
          {"better", info.better == metrics::Better::lower ? "lower" : "higher"},
          {"input", info.input},
          {"identical_value", info.identical_value},
          {"version", info.version},
          {"parameters", parameters_json(info.parameters)},
          {"shares_model_with", info.shares_model_with},
          {"map_unit", info.map_unit},
          {"map_scale",
           {{"low", info.map_scale.low},
            {"high", info.map_scale.high},
            {"logarithmic", info.map_scale.is_logarithmic},
            {"unit", info.map_scale.unit}}},
          {"scope", info.scope == metrics::MetricScope::image ? "image" : "sequence"}};
}

ordered_json scene_json(const renderers::scene::CatalogEntry& entry) {
  ordered_json json{{"name", entry.name},  {"path", entry.path.string()},
                    {"reason", nullptr},   {"summary", nullptr},
                    {"faces", nullptr},    {"lights", nullptr},
                    {"features", nullptr}, {"frames", nullptr},
                    {"warnings", nullptr}};
  try {
    const auto file = renderers::scene::read_scene_file(entry.path);
    const auto scene = file.at_frame(0);
    json["summary"] = file.summary();
    json["faces"] = scene.face_count();
    json["lights"] = light_count(scene);
    json["features"] = feature_names(scene);
    json["frames"] = file.frame_count();
    json["warnings"] = file.warnings();
  } catch (const base::InputError& error) {
    json["reason"] = error.what();
  }
  return json;
}

/// Profile names of a suite document, in file order.
std::vector<std::string> profiles_of(const std::filesystem::path& path) {
  std::vector<std::string> names;
  const base::Node document = base::read_document(path);
  if (const base::Node* profiles = document.find("profiles")) {
    for (const auto& entry : profiles->entries()) names.push_back(entry.first);
  }
  return names;
}

/// A suite of stimuli and models.
void describe_psychophysics(const std::filesystem::path& path, ordered_json& json) {
  const psychophysics::PsychophysicsSuite suite = psychophysics::read_psychophysics_suite(path);
  json["kind"] = "psychophysics";
  json["summary"] = suite.summary;
  json["experiments"] = ordered_json::array();
  for (const auto& experiment : suite.experiments) {
    json["experiments"].push_back(experiment.facts.id);
  }
  json["models"] = ordered_json::array();
  for (const auto& model : suite.models) json["models"].push_back(model.id);
}

ordered_json suite_json(const std::string& name) {
  const std::filesystem::path path = find_suite(name);
  ordered_json json{{"name", name},           {"path", path.string()}, {"kind", "images"},
                    {"reason", nullptr},      {"summary", nullptr},    {"scenes", nullptr},
                    {"methods", nullptr},     {"metrics", nullptr},    {"profiles", nullptr},
                    {"experiments", nullptr}, {"models", nullptr}};
  try {
    if (psychophysics::is_psychophysics_suite(path)) {
      describe_psychophysics(path, json);
      return json;
    }
    const Suite suite = read_suite(path, "");
    json["summary"] = suite.summary;
    json["scenes"] = ordered_json::array();
    for (const SuiteScene& scene : suite.scenes) json["scenes"].push_back(scene.id);
    json["methods"] = ordered_json::array();
    for (const SuiteMethod& method : suite.methods) json["methods"].push_back(method.id);
    json["metrics"] = ordered_json::array();
    for (const auto& metric : suite.metrics) json["metrics"].push_back(text_of(metric));
    json["profiles"] = profiles_of(path);
  } catch (const base::InputError& error) {
    json["reason"] = error.what();
  }
  return json;
}

}  // namespace

ordered_json renderers_json() {
  ordered_json entries = ordered_json::array();
  for (const auto& info : renderers::renderer_list()) entries.push_back(renderer_json(info));
  return entries;
}

ordered_json metrics_json() {
  ordered_json entries = ordered_json::array();
  for (const auto& info : metrics::metric_list()) entries.push_back(metric_json(info));
  for (const auto& info : metrics::sequence_metric_list()) entries.push_back(metric_json(info));
  return entries;
}

ordered_json scenes_json() {
  ordered_json entries = ordered_json::array();
  for (const auto& entry : renderers::scene::list_scene_files(scene_folder())) {
    entries.push_back(scene_json(entry));
  }
  return entries;
}

ordered_json suites_json() {
  ordered_json entries = ordered_json::array();
  for (const std::string& name : catalog_suite_names()) entries.push_back(suite_json(name));
  return entries;
}

ordered_json devices_json() {
  const ordered_json environment = results::run_environment();
  ordered_json cpu{{"name", environment.at("cpu")},
                   {"kind", "cpu"},
                   {"cores", base::core_count()},
                   {"gl_platform", nullptr},
                   {"libraries", ordered_json::object()}};
  const ordered_json& libraries = environment.at("libraries");
  if (libraries.contains("Embree")) cpu["libraries"]["Embree"] = libraries["Embree"];
  for (const char* key : {"renderer", "vendor", "version", "software", "limits", "reason"}) {
    cpu[key] = nullptr;
  }
  ordered_json entries = ordered_json::array({std::move(cpu)});
  for (const std::string& platform : renderers::device_platforms()) {
    entries.push_back(probed_device(platform, base::this_program(), kProbeTimeLimit));
  }
  return entries;
}

namespace {

ordered_json names_only(const std::vector<std::string>& names) {
  ordered_json entries = ordered_json::array();
  for (const std::string& name : names) entries.push_back({{"name", name}});
  return entries;
}

template <class List>
std::vector<std::string> names_in(const List& list) {
  std::vector<std::string> names;
  for (const auto& entry : list) names.push_back(entry.name);
  return names;
}

}  // namespace

ordered_json renderer_names() { return names_only(names_in(renderers::renderer_list())); }

ordered_json metric_names() {
  std::vector<std::string> names = names_in(metrics::metric_list());
  for (const std::string& name : names_in(metrics::sequence_metric_list())) names.push_back(name);
  return names_only(names);
}

ordered_json scene_names() {
  return names_only(names_in(renderers::scene::list_scene_files(scene_folder())));
}

ordered_json suite_names() { return names_only(catalog_suite_names()); }

ordered_json device_names() { return names_only(known_devices()); }

ordered_json with_names_matching(const ordered_json& entries, const std::string& filter) {
  const NameFilter wanted(filter);
  ordered_json kept = ordered_json::array();
  for (const ordered_json& entry : entries) {
    if (wanted.matches(entry.at("name").get<std::string>())) kept.push_back(entry);
  }
  return kept;
}

}  // namespace suites::command_line
