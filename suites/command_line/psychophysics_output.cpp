#include "suites/command_line/psychophysics_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/json_fields.h"
#include "results/psychophysics/model_summary.h"
#include "results/psychophysics/model_tables.h"
#include "results/tables.h"
#include "suites/command_line/console.h"

namespace suites::command_line {

using nlohmann::ordered_json;
using psychophysics::PlannedQuestion;
using psychophysics::PsychophysicsSuite;
using results::psychophysics::Experiment;
using results::psychophysics::Misfit;
using results::psychophysics::ModelSummary;
using results::psychophysics::PhenomenonVerdict;
using results::psychophysics::PsychophysicsRun;

namespace {

ordered_json number_or_null(const std::optional<double>& value) {
  return value ? results::finite_or_null(*value) : ordered_json();
}

ordered_json rms_or_null(const std::optional<Misfit>& misfit) {
  return misfit ? results::finite_or_null(misfit->rms_db) : ordered_json();
}

ordered_json verdict_json(const PhenomenonVerdict& verdict) {
  return {{"id", verdict.phenomenon->id},
          {"kind", to_string(verdict.phenomenon->kind)},
          {"observed", number_or_null(verdict.observed)},
          {"predicted", number_or_null(verdict.predicted)},
          {"is_shown", verdict.is_shown ? ordered_json(*verdict.is_shown) : ordered_json()}};
}

ordered_json model_json(const ModelSummary& summary) {
  ordered_json phenomena = ordered_json::array();
  for (const PhenomenonVerdict& verdict : summary.phenomena) {
    phenomena.push_back(verdict_json(verdict));
  }
  const std::optional<Misfit>& all = summary.all;
  return {
      {"model", summary.model->id},
      {"stimuli", summary.stimuli},
      {"thresholds", all ? all->count : 0},
      {"out_of_range", summary.unseen},
      {"unsupported", summary.unsupported},
      {"failed", summary.failed},
      {"missing", summary.missing},
      {"rms_db", rms_or_null(all)},
      {"gain_db", number_or_null(all ? all->gain_db : std::nullopt)},
      {"rms_after_gain_db", all ? results::finite_or_null(all->rms_after_gain_db) : ordered_json()},
      {"calibration_rms_db", rms_or_null(summary.calibration)},
      {"held_out_rms_db", rms_or_null(summary.held_out)},
      {"phenomena", std::move(phenomena)}};
}

}  // namespace

ordered_json check_json(const PsychophysicsSuite& suite,
                        const std::vector<PlannedQuestion>& questions) {
  ordered_json experiments = ordered_json::array();
  for (const auto& experiment : suite.experiments) experiments.push_back(to_json(experiment.facts));
  ordered_json models = ordered_json::array();
  for (const auto& model : suite.models) {
    models.push_back({{"id", model.id}, {"kind", kind_of(model)}, {"summary", summary_of(model)}});
  }
  ordered_json cells = ordered_json::array();
  for (const PlannedQuestion& question : questions) {
    cells.push_back({{"experiment", question.experiment->facts.id},
                     {"stimulus", question.trial->facts.id},
                     {"model", question.model->id}});
  }
  return {{"schema", results::kSchemaVersion},
          {"status", questions.empty() ? "nothing_measured" : "ok"},
          {"kind", "psychophysics"},
          {"suite", suite.name},
          {"summary", suite.summary},
          {"file", suite.file.string()},
          {"experiments", std::move(experiments)},
          {"models", std::move(models)},
          {"cells", std::move(cells)}};
}

std::string check_text(const PsychophysicsSuite& suite,
                       const std::vector<PlannedQuestion>& questions) {
  std::string text = fmt::format("suite {}: {}\n\n", suite.name, suite.summary);
  std::vector<std::vector<std::string>> rows{{"experiment", "stimuli", "phenomena", "source"}};
  for (const auto& experiment : suite.experiments) {
    rows.push_back({experiment.facts.id, std::to_string(experiment.facts.stimuli.size()),
                    std::to_string(experiment.facts.phenomena.size()), experiment.facts.source});
  }
  text += text_table(rows) + "\n";
  rows = {{"model", "kind", "what it is asked"}};
  for (const auto& model : suite.models) {
    rows.push_back({model.id, kind_of(model), summary_of(model)});
  }
  return text + text_table(rows) + fmt::format("\n{} cells\n", questions.size());
}

ordered_json summary_json(const PsychophysicsRun& run) {
  ordered_json experiments = ordered_json::array();
  for (const Experiment& experiment : run.experiments) {
    ordered_json models = ordered_json::array();
    for (const ModelSummary& summary : summarize(run, experiment)) {
      models.push_back(model_json(summary));
    }
    experiments.push_back({{"id", experiment.id}, {"models", std::move(models)}});
  }
  return experiments;
}

std::string summary_text(const PsychophysicsRun& run) {
  std::string text;
  for (const Experiment& experiment : run.experiments) {
    text += fmt::format("{}: {}\n", experiment.id, experiment.source);
    text += results::to_text(model_table(experiment, summarize(run, experiment))) + "\n";
  }
  const results::Table calibration = calibration_table(run);
  if (!calibration.rows.empty()) text += "calibration\n" + results::to_text(calibration) + "\n";
  return text;
}

}  // namespace suites::command_line
