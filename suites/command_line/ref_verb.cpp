#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "renderers/scene/scene_file.h"
#include "results/result_store.h"
#include "results/run_record.h"
#include "suites/command_line/ad_hoc_suite.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/interrupt.h"
#include "suites/command_line/known_words.h"
#include "suites/command_line/progress_display.h"
#include "suites/command_line/suite_selection.h"
#include "suites/command_line/verbs.h"
#include "suites/suite_runner.h"

namespace suites::command_line {

using nlohmann::ordered_json;

namespace {

constexpr const char* kDefaultSize = "256x256";

/// References to work on, with the scenes that their keys point into.
struct KeyedReferences {
  PlannedSuite planned;                                ///< of a suite
  std::vector<renderers::scene::Scene> option_scenes;  ///< of --scene
  std::vector<ReferenceKey> keys;
  std::vector<std::string> names;
};

void add_suite_keys(const RefArguments& arguments, KeyedReferences& references) {
  references.planned = plan_suite(select_suite(arguments.selection), arguments.selection.filter);
  for (const PlannedReference& reference : references.planned.plan.references) {
    references.keys.push_back(reference_key(reference));
    std::string name = reference.scene->id + " " + to_string(reference.claims.transport);
    if (reference.scene->frames.is_sequence) name += fmt::format(" frame {}", reference.frame);
    references.names.push_back(std::move(name));
  }
}

void add_scene_keys(const RefArguments& arguments, KeyedReferences& references) {
  const std::string& size = arguments.selection.size;
  const base::SizePx size_px = base::parse_size_px(size.empty() ? kDefaultSize : size, {"--size"});
  const std::string transport = arguments.transport.empty() ? "full" : arguments.transport;
  const renderers::Claims claims{renderers::transport_from_text(transport), renderers::Part::all,
                                 arguments.geometry_clamp};
  for (const std::string& name : arguments.selection.scenes) {
    const auto file = renderers::scene::read_scene_file(find_scene_option(name));
    references.option_scenes.push_back(file.at_frame(arguments.frame));
  }
  for (const auto& scene : references.option_scenes) {
    references.keys.push_back({&scene, size_px, claims, ReferenceSpec{}});
    references.names.push_back(scene.name + " " + renderers::to_string(claims.transport));
  }
}

void find_keys(const RefArguments& arguments, KeyedReferences& references) {
  const bool has_suite = !arguments.selection.suite.empty();
  if (has_suite == !arguments.selection.scenes.empty()) {
    throw base::InputError({"discern ref " + arguments.action},
                           "which references? accepted: a suite, or at least one --scene");
  }
  const bool has_scene_options = !arguments.selection.size.empty() || arguments.geometry_clamp ||
                                 !arguments.transport.empty() || arguments.frame != 0;
  if (has_suite && has_scene_options) {
    throw base::InputError({"discern ref " + arguments.action},
                           "--size, --transport, --geometry-clamp and --frame belong to --scene; "
                           "the suite states its own");
  }
  if (!has_suite && !(arguments.selection.profile + arguments.selection.filter).empty()) {
    throw base::InputError({"discern ref " + arguments.action},
                           "--profile and --filter belong to a suite");
  }
  if (has_suite) {
    add_suite_keys(arguments, references);
  } else {
    add_scene_keys(arguments, references);
  }
}

ordered_json reference_json(const std::string& name, const Reference& reference) {
  ordered_json json{{"name", name},
                    {"hash", reference.hash},
                    {"folder", reference.folder.string()},
                    {"samples", reference.samples},
                    {"size_px", {reference.all.width_px, reference.all.height_px}}};
  if (reference.info != nullptr) json["info"] = *reference.info;
  return json;
}

renderers::Devices devices_of(const RefArguments& arguments) {
  return {arguments.threads, arguments.device, nullptr};
}

/// Builds or extends one reference.
Reference make_reference(const RefArguments& arguments, ReferenceStore& store, ReferenceKey key,
                         const std::function<bool(double)>& progress) {
  if (arguments.action == "extend") {
    return store.extend(key, arguments.samples.value(), devices_of(arguments), progress);
  }
  if (arguments.samples) key.spec.samples = *arguments.samples;
  return store.get(key, devices_of(arguments), progress);
}

ordered_json make_references(const RefArguments& arguments, const KeyedReferences& references,
                             ReferenceStore& store, Console& console) {
  handle_interrupts(OnInterrupt::stop_soon);
  ProgressDisplay display(console);
  const double start_s = renderers::steady_seconds();
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < references.keys.size(); ++i) {
    const auto progress = [&](double fraction) {
      const double elapsed_s = renderers::steady_seconds() - start_s;
      const double done = static_cast<double>(i) + fraction;
      const double total = static_cast<double>(references.keys.size());
      const double remaining_s = done > 0.0 ? elapsed_s * (total - done) / done : -1.0;
      display.show(
          {"reference " + references.names[i], i, references.keys.size(), elapsed_s, remaining_s});
      return !interrupt_requested.load();
    };
    const Reference made = make_reference(arguments, store, references.keys[i], progress);
    list.push_back(reference_json(references.names[i], made));
  }
  return list;
}

ordered_json verify_references(const RefArguments& arguments, const KeyedReferences& references,
                               ReferenceStore& store) {
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < references.keys.size(); ++i) {
    if (store.samples_of(references.keys[i]) == 0) {
      throw base::InputError(
          {"discern ref verify"},
          fmt::format("reference \"{}\" is not stored; discern ref build makes it",
                      references.names[i]));
    }
    ordered_json json{{"name", references.names[i]}, {"hash", references.keys[i].hash()}};
    json.update(store.verify(references.keys[i], devices_of(arguments)));
    list.push_back(std::move(json));
  }
  return list;
}

/// A stored reference in one row, with whatever of these facts its record holds.
std::vector<std::string> row_of(const ordered_json& json, const std::vector<std::string>& keys) {
  std::vector<std::string> row;
  for (const std::string& key : keys) {
    const auto found = json.find(key);
    if (found == json.end() || found->is_null()) {
      row.emplace_back("-");
    } else if (found->is_array() && found->size() == 2) {
      row.push_back(fmt::format("{}x{}", (*found)[0].dump(), (*found)[1].dump()));
    } else {
      row.push_back(found->is_string() ? found->get<std::string>() : found->dump());
    }
  }
  return row;
}

void print_references(const std::string& action, const ordered_json& list, Console& console) {
  std::vector<std::string> keys{"name", "size_px", "samples", "folder"};
  if (action == "verify")
    keys = {"name", "ok", "pixels", "outside_3_sigma", "max_outside", "mean_z"};
  if (action == "info")
    keys = {"scene", "transport", "size_px", "samples", "is_readable", "folder"};
  std::vector<std::vector<std::string>> rows{keys};
  for (const ordered_json& json : list) rows.push_back(row_of(json, keys));
  console.out << text_table(rows) << fmt::format("{} references\n", list.size());
}

bool all_agree(const ordered_json& verified) {
  for (const ordered_json& json : verified) {
    if (!json.at("ok").get<bool>()) return false;
  }
  return true;
}

}  // namespace

int run_ref(const RefArguments& arguments, Console& console) {
  require_known(arguments.action, {"build", "extend", "verify", "info"}, "discern ref", "action");
  if (arguments.action == "extend" && !arguments.samples) {
    throw base::InputError({"discern ref extend"}, "--samples is required: how many to add");
  }
  const base::ThreadLimit limit(arguments.threads);
  ReferenceStore store(results::results_root(arguments.results));
  ordered_json list = ordered_json::array();
  int code = kAsExpected;
  if (arguments.action == "info") {
    for (ordered_json& json : store.list()) list.push_back(std::move(json));
  } else {
    KeyedReferences references;
    find_keys(arguments, references);
    if (arguments.action == "verify") {
      list = verify_references(arguments, references, store);
      if (!all_agree(list)) code = kGateFailed;
    } else {
      list = make_references(arguments, references, store, console);
    }
  }
  if (arguments.json) {
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", code == kAsExpected ? "ok" : "failed"},
                         {"action", arguments.action},
                         {"references", std::move(list)}});
  } else {
    print_references(arguments.action, list, console);
  }
  return code;
}

}  // namespace suites::command_line
