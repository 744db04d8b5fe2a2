#include "suites/command_line/cost_output.h"

#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "results/run_environment.h"
#include "suites/command_line/console.h"
#include "suites/suite_profiles.h"

namespace suites::command_line {

using nlohmann::ordered_json;

namespace {

/// Scenes as they are loaded, by what makes them: profiles mostly share them.
class LoadedScenes {
 public:
  explicit LoadedScenes(const PlannedSuite& planned) {
    for (std::size_t i = 0; i < planned.scenes.size(); ++i) {
      states_.emplace(key_of(planned.suite->scenes[i]), planned.scenes[i]);
    }
  }

  std::vector<SceneStates> states_of(const Suite& suite) {
    std::vector<SceneStates> states;
    for (const SuiteScene& scene : suite.scenes) {
      const std::string key = key_of(scene);
      if (!states_.contains(key)) {
        Suite alone = suite;
        alone.scenes = {scene};
        states_.emplace(key, load_scenes(alone).front());
      }
      states.push_back(states_.at(key));
    }
    return states;
  }

 private:
  static std::string key_of(const SuiteScene& scene) {
    std::string key = scene.file.string();
    for (const base::Node& overlay : scene.overlays()) key += "\n" + overlay.to_json().dump();
    return key + fmt::format("\n{}", scene.frames.numbers());
  }

  std::map<std::string, SceneStates> states_;
};

CostEstimate estimate_of(const PlannedSuite& planned, const CostRecords& records,
                         const ReferenceStore& store) {
  std::vector<std::int64_t> stored_samples;
  for (const PlannedReference& reference : planned.plan.references) {
    stored_samples.push_back(store.samples_of(reference_key(reference)));
  }
  return estimate_cost(planned.plan, records, stored_samples);
}

std::vector<std::string> profiles_of(const SuiteSelection& selection) {
  if (selection.suite.empty()) return {};
  return profile_names(base::read_document(find_suite(selection.suite)));
}

/// "5", "5 to 30"
std::string range_text(std::size_t least, std::size_t most) {
  return least == most ? std::to_string(least) : fmt::format("{} to {}", least, most);
}

std::string time_text(const CostEstimate& estimate) {
  const bool is_whole = estimate.unmeasured_cells + estimate.unmeasured_references == 0;
  if (!is_whole && estimate.total.most_s == 0.0) return "not measured yet";
  const std::string least = cost_text(estimate.total.least_s);
  const std::string most = cost_text(estimate.total.most_s);
  const std::string text = least == most ? least : least + " to " + most;
  return is_whole ? text : text + " and more";
}

/// "same scene 4, time budget 2; not measured yet: 3 cells, 1 reference"
std::string basis_text(const CostEstimate& estimate) {
  std::vector<std::string> sources;
  const auto add = [&sources](const char* name, std::size_t cells) {
    if (cells > 0) sources.push_back(fmt::format("{} {}", name, cells));
  };
  add("same scene", estimate.from_same_scene);
  add("same renderer", estimate.from_same_renderer);
  add("time budget", estimate.from_time_budget);
  std::vector<std::string> missing;
  const auto add_missing = [&missing](std::size_t count, const char* what) {
    if (count > 0) missing.push_back(fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"));
  };
  add_missing(estimate.unmeasured_cells, "cell");
  add_missing(estimate.unmeasured_references, "reference");
  std::string text = fmt::format("{}", fmt::join(sources, ", "));
  if (missing.empty()) return text;
  return fmt::format("{}{}not measured yet: {}", text, text.empty() ? "" : "; ",
                     fmt::join(missing, ", "));
}

}  // namespace

ProfileCosts profile_costs(const SuiteSelection& selection, const PlannedSuite& planned,
                           const std::filesystem::path& results_root) {
  ProfileCosts costs;
  costs.machine = results::machine_name();
  costs.measured = load_costs(results_root, costs.machine);
  const CostRecords& records = costs.measured.records;
  const ReferenceStore store(results_root);
  const auto add = [&](const PlannedSuite& plan) {
    costs.rows.push_back({plan.suite->profile, estimate_of(plan, records, store)});
  };
  if (selection.profile.empty()) add(planned);
  LoadedScenes loaded(planned);
  for (const std::string& profile : profiles_of(selection)) {
    SuiteSelection of_profile = selection;
    of_profile.profile = profile;
    Suite suite = select_suite(of_profile);
    std::vector<SceneStates> scenes = loaded.states_of(suite);
    add(plan_suite(std::move(suite), std::move(scenes), selection.filter));
  }
  return costs;
}

ordered_json costs_json(const ProfileCosts& costs) {
  ordered_json profiles = ordered_json::array();
  for (const auto& [profile, estimate] : costs.rows) {
    profiles.push_back(
        {{"profile", profile},
         {"cells", estimate.cells},
         {"repetitions", {estimate.least_repetitions, estimate.most_repetitions}},
         {"references", estimate.references},
         {"seconds", {estimate.total.least_s, estimate.total.most_s}},
         {"references_seconds", estimate.references_s},
         {"from",
          {{"same_scene", estimate.from_same_scene},
           {"same_renderer", estimate.from_same_renderer},
           {"time_budget", estimate.from_time_budget}}},
         {"unmeasured",
          {{"cells", estimate.unmeasured_cells}, {"references", estimate.unmeasured_references}}}});
  }
  return {{"machine", costs.machine},
          {"runs", costs.measured.runs},
          {"references", costs.measured.records.references.size()},
          {"unreadable", costs.measured.unreadable},
          {"left_out", ordered_json::array({"scores"})},
          {"profiles", std::move(profiles)}};
}

std::string costs_text(const ProfileCosts& costs) {
  std::vector<std::vector<std::string>> rows{
      {"profile", "cells", "repetitions", "references", "estimated time", "cells estimated from"}};
  for (const auto& [profile, estimate] : costs.rows) {
    rows.push_back({profile.empty() ? "(none)" : profile, std::to_string(estimate.cells),
                    range_text(estimate.least_repetitions, estimate.most_repetitions),
                    std::to_string(estimate.references), time_text(estimate),
                    basis_text(estimate)});
  }
  std::string text = text_table(rows);
  text += fmt::format(
      "estimated from {} run{} and {} reference{} of {}; references: those still to be rendered; "
      "scores are left out: their cost is not measured\n",
      costs.measured.runs, costs.measured.runs == 1 ? "" : "s",
      costs.measured.records.references.size(),
      costs.measured.records.references.size() == 1 ? "" : "s", costs.machine);
  if (costs.measured.unreadable > 0) {
    text += fmt::format("{} runs or references could not be read\n", costs.measured.unreadable);
  }
  return text;
}

}  // namespace suites::command_line
