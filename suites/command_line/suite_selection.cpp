#include "suites/command_line/suite_selection.h"

#include <algorithm>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "suites/command_line/ad_hoc_suite.h"
#include "suites/run_description.h"

namespace suites::command_line {

namespace {

/// Options that only an ad-hoc suite has, as far as they were given.
std::string ad_hoc_options(const SuiteSelection& selection) {
  std::string given;
  const auto add = [&given](bool is_given, const char* option) {
    if (is_given) given += (given.empty() ? "" : ", ") + std::string(option);
  };
  add(!selection.scenes.empty(), "--scene");
  add(!selection.methods.empty(), "--method");
  add(!selection.metrics.empty(), "--metric");
  add(!selection.samples.empty(), "--samples");
  add(!selection.times.empty(), "--time");
  add(!selection.size.empty(), "--size");
  add(selection.reference_samples.has_value(), "--reference-samples");
  return given;
}

void keep_matching_cells(RunPlan& plan, const std::string& filter) {
  std::erase_if(plan.cells,
                [&filter](const PlannedCell& cell) { return !matches_filter(cell, filter); });
  // A reference stays if a remaining cell is scored against it.
  std::vector<PlannedReference> needed;
  for (std::size_t i = 0; i < plan.references.size(); ++i) {
    const bool is_needed =
        std::any_of(plan.cells.begin(), plan.cells.end(), [&](const PlannedCell& cell) {
          return std::any_of(cell.frames.begin(), cell.frames.end(), [&](const auto& frame) {
            return own_reference(plan, cell, frame) == i || full_reference(plan, cell, frame) == i;
          });
        });
    if (is_needed) needed.push_back(plan.references[i]);
  }
  plan.references = std::move(needed);
}

/// What the command line states holds for all cells, whatever their scene and method say.
void measure_as_asked(const SuiteSelection& selection, Suite& suite) {
  MeasureChange asked;
  if (selection.seeds) asked.seeds = static_cast<int>(*selection.seeds);
  if (selection.repetitions) {
    const auto count = static_cast<int>(*selection.repetitions);
    asked.repetitions = RepetitionRange{count, count, std::nullopt};
  }
  suite.measure = with_change(suite.measure, asked);
  const auto take_back = [&](MeasureChange& own) {
    if (asked.seeds) own.seeds.reset();
    if (asked.repetitions) own.repetitions.reset();
  };
  for (SuiteScene& scene : suite.scenes) take_back(scene.measure);
  for (SuiteMethod& method : suite.methods) take_back(method.measure);
}

}  // namespace

Suite select_suite(const SuiteSelection& selection) {
  if (!selection.suite.empty() && !ad_hoc_options(selection).empty()) {
    throw base::InputError(fmt::format("{} cannot be given together with suite \"{}\"",
                                       ad_hoc_options(selection), selection.suite));
  }
  if (selection.suite.empty() && !selection.profile.empty()) {
    throw base::InputError({"--profile"}, "profiles belong to suites; no suite is given");
  }
  Suite suite = selection.suite.empty()
                    ? make_ad_hoc_suite(selection)
                    : read_suite(find_suite(selection.suite), selection.profile);
  measure_as_asked(selection, suite);
  return suite;
}

PlannedSuite plan_suite(Suite suite, const std::string& filter) {
  std::vector<SceneStates> scenes = load_scenes(suite);
  return plan_suite(std::move(suite), std::move(scenes), filter);
}

PlannedSuite plan_suite(Suite suite, std::vector<SceneStates> scenes, const std::string& filter) {
  PlannedSuite planned;
  planned.suite = std::make_unique<const Suite>(std::move(suite));
  planned.scenes = std::move(scenes);
  planned.plan = make_plan(*planned.suite, planned.scenes);
  check_named_quantities(*planned.suite, planned.scenes, planned.plan);
  if (!filter.empty()) keep_matching_cells(planned.plan, filter);
  return planned;
}

}  // namespace suites::command_line
