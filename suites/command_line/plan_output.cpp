#include "suites/command_line/plan_output.h"

#include <algorithm>
#include <ostream>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/units.h"
#include "results/result_store.h"
#include "results/run_record.h"
#include "suites/command_line/cost_output.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/scene_facts.h"
#include "suites/run_description.h"

namespace suites::command_line {

using nlohmann::ordered_json;

namespace {

/// The frames of a sequence; null for one frame.
ordered_json frames_json(const FrameRange& frames) {
  return frames.is_sequence ? ordered_json(frames.numbers()) : ordered_json(nullptr);
}

/// The scenes as they are at their first frames.
ordered_json scenes_json(const PlannedSuite& planned) {
  ordered_json scenes = ordered_json::array();
  for (std::size_t i = 0; i < planned.scenes.size(); ++i) {
    const SuiteScene& entry = planned.suite->scenes[i];
    const renderers::scene::Scene& scene = planned.scenes[i].first();
    scenes.push_back({{"id", entry.id},
                      {"file", entry.file.string()},
                      {"scene_hash", scene.hash.hex()},
                      {"size_px", {entry.size_px.width, entry.size_px.height}},
                      {"frame", entry.frames.first},
                      {"faces", scene.face_count()},
                      {"lights", light_count(scene)},
                      {"features", feature_names(scene)},
                      {"luminance_scale_cd_m2", scene.luminance_scale_cd_m2},
                      {"frames", frames_json(entry.frames)},
                      {"base_id", entry.base_id},
                      {"sweep", sweep_to_json(entry.sweep)},
                      {"warnings", planned.scenes[i].warnings}});
  }
  return scenes;
}

/// What a method claims of a scene, at its first frame.
renderers::Claims claims_of(const SuiteMethod& method, const SceneStates& scene) {
  return method.choice.info->claims(method.choice.parameters, scene.first());
}

ordered_json methods_json(const PlannedSuite& planned) {
  ordered_json methods = ordered_json::array();
  for (const SuiteMethod& method : planned.suite->methods) {
    ordered_json claims = ordered_json::array();
    for (std::size_t i = 0; i < planned.scenes.size(); ++i) {
      ordered_json entry{{"scene", planned.suite->scenes[i].id}};
      entry.update(to_json(claims_of(method, planned.scenes[i])));
      claims.push_back(std::move(entry));
    }
    ordered_json json{{"id", method.id},
                      {"renderer", method.choice.info->name},
                      {"preset", method.choice.preset},
                      {"parameters", method.choice.parameters.to_json()}};
    json.update(to_json(claims_of(method, planned.scenes.front())));
    json["claims"] = std::move(claims);
    methods.push_back(std::move(json));
  }
  return methods;
}

ordered_json measure_json(const MeasurePlan& measure) {
  return {{"seeds", measure.seeds},
          {"repetitions", {measure.min_repetitions, measure.max_repetitions}},
          {"warmup", measure.warmup},
          {"interleaved", measure.is_interleaved},
          {"timeout_s", measure.timeout_s},
          {"memory_bytes", measure.memory_bytes},
          {"new_view", measure.has_new_view}};
}

ordered_json cells_json(const RunPlan& plan) {
  ordered_json cells = ordered_json::array();
  for (const PlannedCell& cell : plan.cells) {
    ordered_json json{
        {"cell", cell.name},
        {"scene", cell.scene->id},
        {"method", cell.method->id},
        {"budget", cell.budget.name()},
        {"seed", cell.seed},
        {"unsupported", cell.unsupported ? ordered_json(*cell.unsupported) : ordered_json(nullptr)},
        {"frames", frames_json(cell.scene->frames)},
        {"repetitions", {cell.measure.min_repetitions, cell.measure.max_repetitions}}};
    json.update(to_json(cell.frames.front().claims));
    cells.push_back(std::move(json));
  }
  return cells;
}

ordered_json references_json(const PlannedSuite& planned, const ReferenceStore& store) {
  ordered_json references = ordered_json::array();
  for (const PlannedReference& reference : planned.plan.references) {
    const ReferenceKey key = reference_key(reference);
    references.push_back({{"scene", reference.scene->id},
                          {"transport", renderers::to_string(reference.claims.transport)},
                          {"geometry_clamp", to_json(reference.claims)["geometry_clamp"]},
                          {"size_px", {key.size_px.width, key.size_px.height}},
                          {"renderer", key.spec.renderer},
                          {"samples", key.spec.samples},
                          {"hash", key.hash()},
                          {"stored", store.contains(key)},
                          {"frame", reference.frame}});
  }
  return references;
}

/// "3", "0 to 59", "0 to 58 by 2".
std::string frames_text(const FrameRange& frames) {
  if (!frames.is_sequence) return std::to_string(frames.first);
  const std::string step = frames.step == 1 ? "" : fmt::format(" by {}", frames.step);
  return fmt::format("{} to {}{}", frames.first, frames.numbers().back(), step);
}

std::string scenes_text(const PlannedSuite& planned) {
  std::vector<std::vector<std::string>> rows{
      {"scene", "faces", "lights", "size", "frames", "features"}};
  for (std::size_t i = 0; i < planned.scenes.size(); ++i) {
    const SuiteScene& entry = planned.suite->scenes[i];
    const renderers::scene::Scene& scene = planned.scenes[i].first();
    rows.push_back(
        {entry.id, std::to_string(scene.face_count()), std::to_string(light_count(scene)),
         fmt::format("{}x{}", entry.size_px.width, entry.size_px.height), frames_text(entry.frames),
         fmt::format("{}", fmt::join(feature_names(scene), " "))});
  }
  return text_table(rows);
}

/// "max_depth=8 part=all"; without the samples of a progressive renderer, which its budgets set.
std::string parameters_text(const SuiteMethod& method) {
  std::vector<std::string> settings;
  for (const auto& [name, value] : method.choice.parameters.entries()) {
    if (name == "samples" && method.choice.info->progressive_unit) continue;
    settings.push_back(base::Parameters({{name, value}}).to_text());
  }
  return fmt::format("{}", fmt::join(settings, " "));
}

/// "one_bounce", "diffuse indirect", with the clamp where there is one.
std::string claims_text(const renderers::Claims& claims) {
  std::string text = to_string(claims.transport);
  if (claims.part == renderers::Part::indirect) text += " indirect";
  if (claims.geometry_clamp) {
    text += fmt::format(" clamp {}", base::format_significant(*claims.geometry_clamp, 3));
  }
  return text;
}

/// The claims of several scenes or frames: one text if they agree, else the first and the last of
/// those that differ.
std::string claims_text(const std::vector<renderers::Claims>& claims) {
  std::vector<std::string> texts;
  for (const renderers::Claims& one : claims) {
    const std::string text = claims_text(one);
    if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(text);
  }
  return texts.size() == 1 ? texts.front() : texts.front() + " ... " + texts.back();
}

std::string methods_text(const PlannedSuite& planned) {
  std::vector<std::vector<std::string>> rows{
      {"method", "renderer", "preset", "claims", "parameters"}};
  for (const SuiteMethod& method : planned.suite->methods) {
    std::vector<renderers::Claims> claims;
    for (const SceneStates& scene : planned.scenes) claims.push_back(claims_of(method, scene));
    rows.push_back({method.id, method.choice.info->name, method.choice.preset, claims_text(claims),
                    parameters_text(method)});
  }
  return text_table(rows);
}

std::string references_text(const PlannedSuite& planned, const ReferenceStore& store) {
  std::vector<std::vector<std::string>> rows{
      {"reference", "claims", "frame", "size", "samples", "renderer", "state"}};
  for (const PlannedReference& reference : planned.plan.references) {
    const ReferenceKey key = reference_key(reference);
    rows.push_back({reference.scene->id, claims_text(reference.claims),
                    std::to_string(reference.frame),
                    fmt::format("{}x{}", key.size_px.width, key.size_px.height),
                    std::to_string(key.spec.samples), key.spec.renderer,
                    store.contains(key) ? "stored" : "to be rendered"});
  }
  return text_table(rows);
}

std::vector<renderers::Claims> claims_of(const PlannedCell& cell) {
  std::vector<renderers::Claims> claims;
  for (const PlannedFrame& frame : cell.frames) claims.push_back(frame.claims);
  return claims;
}

/// "3", "3 to 9".
std::string repetitions_text(const MeasurePlan& measure) {
  if (measure.min_repetitions == measure.max_repetitions) {
    return std::to_string(measure.min_repetitions);
  }
  return fmt::format("{} to {}", measure.min_repetitions, measure.max_repetitions);
}

std::string cells_text(const RunPlan& plan) {
  std::vector<std::vector<std::string>> rows{
      {"cell", "scene", "method", "budget", "seed", "repetitions", "claims", ""}};
  for (const PlannedCell& cell : plan.cells) {
    rows.push_back({cell.name, cell.scene->id, cell.method->id, cell.budget.name(),
                    std::to_string(cell.seed), repetitions_text(cell.measure),
                    claims_text(claims_of(cell)),
                    cell.unsupported ? "unsupported: " + *cell.unsupported : ""});
  }
  return text_table(rows);
}

/// What reading the scenes warned of, once each: scenes of a sweep read the same file.
void print_warnings(const PlannedSuite& planned, Console& console) {
  std::set<std::string> told;
  for (std::size_t i = 0; i < planned.scenes.size(); ++i) {
    for (const std::string& warning : planned.scenes[i].warnings) {
      if (!told.insert(warning).second) continue;
      print_note(console, fmt::format("scene {}: {}", planned.suite->scenes[i].id, warning));
    }
  }
}

}  // namespace

ordered_json plan_json(const PlannedSuite& planned, const std::filesystem::path& results_root) {
  const Suite& suite = *planned.suite;
  const ReferenceStore store(results_root);
  ordered_json metrics = ordered_json::array();
  for (const auto& metric : suite.metrics) metrics.push_back(text_of(metric));
  return {{"schema", results::kSchemaVersion},
          {"status", planned.plan.cells.empty() ? "nothing_measured" : "ok"},
          {"suite", suite.name},
          {"summary", suite.summary},
          {"file", suite.file.string()},
          {"profile", suite.profile},
          {"viewing", perception::to_json(suite.viewing)},
          {"scenes", scenes_json(planned)},
          {"methods", methods_json(planned)},
          {"metrics", std::move(metrics)},
          {"measure", measure_json(suite.measure)},
          {"cells", cells_json(planned.plan)},
          {"references", references_json(planned, store)}};
}

std::string plan_text(const PlannedSuite& planned, const std::filesystem::path& results_root) {
  const Suite& suite = *planned.suite;
  const ReferenceStore store(results_root);
  const auto unsupported = std::count_if(planned.plan.cells.begin(), planned.plan.cells.end(),
                                         [](const auto& cell) { return cell.unsupported; });
  std::vector<std::string> metrics;
  for (const auto& metric : suite.metrics) metrics.push_back(text_of(metric));
  std::string text = fmt::format("suite {}{}\n", suite.name,
                                 suite.profile.empty() ? "" : ", profile " + suite.profile);
  if (!suite.summary.empty()) text += suite.summary + "\n";
  text += fmt::format("viewing: {}\nmetrics: {}\n", perception::describe(suite.viewing),
                      fmt::join(metrics, ", "));
  text += fmt::format("seeds {}, repetitions {} to {}\n\n", suite.measure.seeds,
                      suite.measure.min_repetitions, suite.measure.max_repetitions);
  text += scenes_text(planned) + "\n" + methods_text(planned) + "\n";
  text += references_text(planned, store) + "\n" + cells_text(planned.plan);
  text += fmt::format("\n{} cells, {} of them unsupported, {} references\n",
                      planned.plan.cells.size(), unsupported, planned.plan.references.size());
  return text;
}

int print_plan(const PlannedSuite& planned, const SuiteSelection& selection,
               const std::string& results_option, bool as_json, Console& console) {
  const std::filesystem::path root = results::results_root(results_option);
  const ProfileCosts costs = profile_costs(selection, planned, root);
  if (as_json) {
    ordered_json json = plan_json(planned, root);
    json["costs"] = costs_json(costs);
    print_json(console, json);
  } else {
    console.out << plan_text(planned, root) << "\n" << costs_text(costs);
    print_warnings(planned, console);
  }
  if (!planned.plan.cells.empty()) return kAsExpected;
  print_note(console, "nothing to measure: no cell is left");
  return kNothingMeasured;
}

}  // namespace suites::command_line
