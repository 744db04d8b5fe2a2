#include "suites/run_description.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/child_process.h"
#include "perception/base/hash.h"
#include "perception/base/parallel.h"
#include "results/claims/claim_result.h"
#include "results/figures/figures.h"
#include "results/run_environment.h"
#include "results/run_values.h"
#include "suites/new_view.h"
#include "suites/scoring.h"
#include "suites/suite_methods.h"
#include "suites/worker_pool.h"

namespace suites {
namespace {

using Json = nlohmann::ordered_json;

Json size_to_json(base::SizePx size_px) { return Json{size_px.width, size_px.height}; }

/// The frames of a sequence; null for one frame.
Json frames_to_json(const FrameRange& frames) {
  return frames.is_sequence ? Json(frames.numbers()) : Json();
}

/// The scenes as they are at their first frames.
Json scenes_to_json(const Suite& suite, const std::vector<SceneStates>& states) {
  Json list = Json::array();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const SuiteScene& scene = suite.scenes[i];
    const renderers::scene::Scene& first = states[i].first();
    const perception::ViewingConditions viewing = viewing_of(suite, first);
    list.push_back(Json{{"id", scene.id},
                        {"base_id", scene.base_id},
                        {"sweep", sweep_to_json(scene.sweep)},
                        {"name", first.name},
                        {"file", scene.file.string()},
                        {"hash", first.hash.hex()},
                        {"size_px", size_to_json(scene.size_px)},
                        {"frame", scene.frames.first},
                        {"frames", frames_to_json(scene.frames)},
                        {"faces", first.face_count()},
                        {"exposure_ev", viewing.exposure_ev},
                        {"luminance_scale_cd_m2", viewing.luminance_scale_cd_m2},
                        {"viewing", describe(viewing)},
                        {"reference",
                         {{"renderer", scene.reference.renderer},
                          {"samples", scene.reference.samples},
                          {"seed", scene.reference.seed}}}});
  }
  return list;
}

/// What a method claims of each scene, at its first frame.
Json claims_to_json(const Suite& suite, const SuiteMethod& method,
                    const std::vector<SceneStates>& scenes) {
  Json list = Json::array();
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    Json entry{{"scene", suite.scenes[i].id}};
    entry.update(to_json(method.choice.info->claims(method.choice.parameters, scenes[i].first())));
    list.push_back(std::move(entry));
  }
  return list;
}

Json methods_to_json(const Suite& suite, const std::vector<SceneStates>& scenes) {
  Json list = Json::array();
  for (const SuiteMethod& method : suite.methods) {
    Json budgets = Json::array();
    for (const Budget& budget : budgets_in_force(method, suite.budgets)) {
      budgets.push_back(budget.name());
    }
    // Those of the first scene by themselves; `claims` has all of them.
    const renderers::Claims first =
        method.choice.info->claims(method.choice.parameters, scenes.front().first());
    Json entry{{"id", method.id},
               {"base_id", method.base_id},
               {"sweep", sweep_to_json(method.sweep)},
               {"renderer", method.choice.info->name},
               {"uses_seed", method.choice.info->uses_seed},
               {"preset", method.choice.preset},
               {"parameters", method.choice.parameters.to_json()},
               {"claims", claims_to_json(suite, method, scenes)},
               {"budgets", budgets}};
    entry.update(to_json(first));
    list.push_back(std::move(entry));
  }
  return list;
}

/// Samples before seconds before what has no amount; of a kind the smaller one first.
std::pair<int, double> rank_of(const Budget& budget) {
  if (budget.samples) return {0, static_cast<double>(*budget.samples)};
  if (budget.time_s) return {1, *budget.time_s};
  return {2, 0.0};
}

/// Names of every budget that a cell has, each method's own list taken into one.
Json budgets_to_json(const RunPlan& plan) {
  std::vector<std::pair<std::string, Budget>> budgets;
  std::set<std::string> known;
  for (const PlannedCell& cell : plan.cells) {
    std::string name = cell.budget.name();
    if (known.insert(name).second) budgets.emplace_back(std::move(name), cell.budget);
  }
  std::ranges::stable_sort(budgets, {}, [](const auto& entry) { return rank_of(entry.second); });
  Json names = Json::array();
  for (const auto& [name, budget] : budgets) names.push_back(name);
  return names;
}

Json cells_to_json(const RunPlan& plan, const std::string& filter) {
  Json list = Json::array();
  for (const PlannedCell& cell : plan.cells) {
    if (!matches_filter(cell, filter)) continue;
    list.push_back(Json{{"cell", cell.name},
                        {"scene", cell.scene->id},
                        {"method", cell.method->id},
                        {"budget", cell.budget.name()},
                        {"seed", cell.seed}});
  }
  return list;
}

Json timing_to_json(const MeasurePlan& plan, int jobs) {
  return Json{
      {"clock", "total_s = wall(prepare) + wall(render) - readback - checkpoint sink"},
      {"next_frame_clock", "next_frame_s = wall(update) + wall(render) - readback"},
      {"new_view",
       plan.has_new_view
           ? Json(fmt::format("new_view_s = wall(render) - readback, the camera turned by {} "
                              "degrees about its look_at point",
                              kNewViewAngle_deg))
           : Json()},
      {"order", plan.is_interleaved ? "interleaved" : "blocks"},
      {"seeds", plan.seeds},
      {"repetitions",
       {{"min", plan.min_repetitions},
        {"max", plan.max_repetitions},
        {"until_relative_interval", plan.until_relative_spread}}},
      {"warmups", plan.warmup},
      {"timeout_s", plan.timeout_s},
      {"memory_bytes", plan.memory_bytes},
      {"rules",
       {jobs == 1 ? std::string("timed repetitions never overlap")
                  : fmt::format("{} repetitions at once, each on cores of its own", jobs),
        "a cell whose prepare takes over 10 s is repeated min "
        "times",
        "a cell is not repeated after timeout, out_of_memory or unsupported",
        "a repetition that another device answers than the cell's first is unsupported",
        "scenes and methods may state seeds, repetitions, timeout and memory of their own: "
        "suite.resolved.yaml",
        fmt::format("one worker per scene and method; idle ones are closed, the longest idle "
                    "first, where together they hold more than {} bytes",
                    idle_memory_bytes())}}};
}

}  // namespace

std::string to_string(RunState state) {
  switch (state) {
    case RunState::running:
      return "running";
    case RunState::complete:
      return "complete";
    case RunState::interrupted:
      return "interrupted";
  }
  return "";
}

nlohmann::ordered_json run_identity(const RunOptions& options) {
  const std::filesystem::path executable =
      options.worker_executable.empty() ? base::this_program() : options.worker_executable;
  return Json{{"build", base::hash_of(base::read_text_file(executable)).hex()},
              {"machine", results::machine_name()},
              {"threads", options.threads > 0 ? options.threads : base::core_count()},
              {"jobs", options.jobs},
              {"platform", options.platform}};
}

nlohmann::ordered_json sweep_to_json(const results::ParameterValues& sweep) {
  Json json = Json::object();
  for (const auto& [name, value] : sweep) json[name] = base::to_json(value);
  return json;
}

nlohmann::ordered_json to_json(const renderers::Claims& claims) {
  return Json{{"transport", to_string(claims.transport)},
              {"part", to_string(claims.part)},
              {"geometry_clamp", claims.geometry_clamp ? Json(*claims.geometry_clamp) : Json()}};
}

nlohmann::ordered_json reference_entry(const PlannedReference& planned, const ReferenceKey& key,
                                       const Reference& reference) {
  return Json{{"scene", planned.scene->id},
              {"frame", planned.frame},
              {"transport", to_string(planned.claims.transport)},
              {"geometry_clamp",
               planned.claims.geometry_clamp ? Json(*planned.claims.geometry_clamp) : Json()},
              {"hash", reference.hash},
              {"samples", reference.samples},
              {"samples_asked", key.spec.samples},
              {"pixel_hash", reference.info->value("pixel_hash", "")},
              {"seconds", reference.info->value("seconds", 0.0)}};
}

nlohmann::ordered_json failed_reference_entry(const PlannedReference& planned,
                                              const std::string& reason) {
  return Json{{"scene", planned.scene->id},
              {"frame", planned.frame},
              {"transport", to_string(planned.claims.transport)},
              {"geometry_clamp",
               planned.claims.geometry_clamp ? Json(*planned.claims.geometry_clamp) : Json()},
              {"reason", reason}};
}

namespace {

Json metrics_to_json(const Suite& suite) {
  Json metrics = Json::array();
  for (const SuiteMetric& metric : suite.metrics) metrics.push_back(to_json(metric));
  return metrics;
}

Json figures_to_json(const Suite& suite) {
  Json figures = Json::array();
  for (const auto& figure : suite.figures) figures.push_back(results::figures::to_json(figure));
  return figures;
}

}  // namespace

results::Run planned_run(const Suite& suite, const std::vector<SceneStates>& scenes,
                         const RunPlan& plan) {
  results::Run run;
  run.info = std::make_shared<const Json>(Json{{"suite", suite.name},
                                               {"profile", suite.profile},
                                               {"scenes", scenes_to_json(suite, scenes)},
                                               {"methods", methods_to_json(suite, scenes)},
                                               {"budgets", budgets_to_json(plan)},
                                               {"metrics", metrics_to_json(suite)},
                                               {"planned_cells", cells_to_json(plan, "")}});
  return run;
}

void check_named_quantities(const Suite& suite, const std::vector<SceneStates>& scenes,
                            const RunPlan& plan) {
  if (suite.claims.empty() && suite.figures.empty() && suite.gates.empty()) return;
  const results::Run planned = planned_run(suite, scenes, plan);
  const results::RunValues values(planned);
  results::claims::check_claims(suite.claims, values);
  results::figures::check_figures(suite.figures, values);
  for (const results::gates::Gate& gate : suite.gates) {
    values.check_quantity(gate.quantity, gate.place);
  }
}

nlohmann::ordered_json describe_run(const Suite& suite, const std::vector<SceneStates>& scenes,
                                    const RunPlan& plan, const RunOptions& options,
                                    const std::string& run) {
  return Json{{"schema", results::kSchemaVersion},
              {"run", run},
              {"suite", suite.name},
              {"summary", suite.summary},
              {"suite_file", suite.file.string()},
              {"profile", suite.profile},
              {"command", options.command},
              {"filter", options.filter},
              {"state", to_string(RunState::running)},
              {"identity", run_identity(options)},
              {"environment", results::run_environment()},
              {"viewing", perception::to_json(suite.viewing)},
              {"viewing_text", describe(suite.viewing)},
              {"scenes", scenes_to_json(suite, scenes)},
              {"methods", methods_to_json(suite, scenes)},
              {"budgets", budgets_to_json(plan)},
              {"metrics", metrics_to_json(suite)},
              {"claims", results::claims::to_json(suite.claims)},
              {"gates", results::gates::to_json(suite.gates)},
              {"figures", figures_to_json(suite)},
              {"timing", timing_to_json(suite.measure, options.jobs)},
              {"planned_cells", cells_to_json(plan, options.filter)},
              {"references", Json::array()}};
}

}  // namespace suites
