#include "suites/psychophysics/psychophysics_suite.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/names.h"
#include "results/row_selector.h"
#include "suites/psychophysics/readers.h"
#include "suites/safe_name.h"

namespace suites::psychophysics {
namespace {

using nlohmann::ordered_json;

constexpr const char* kKind = "psychophysics";

std::vector<SuiteExperiment> read_experiments(const base::Node& node) {
  std::vector<SuiteExperiment> experiments;
  std::set<std::string> ids;
  for (const base::Node& item : node.list("experiments")) {
    experiments.push_back(read_experiment(item));
    if (!ids.insert(experiments.back().facts.id).second) {
      throw base::InputError(item.find("id")->place(), fmt::format("experiment id \"{}\" is used "
                                                                   "twice",
                                                                   experiments.back().facts.id));
    }
  }
  if (experiments.empty()) throw base::InputError(node.place(), "experiments is empty");
  return experiments;
}

/// An anchor is a stimulus that a metric can look at, with a threshold of its own.
void check_anchor(const base::Node& entry, const MetricModel& model,
                  const std::vector<SuiteExperiment>& experiments) {
  if (model.anchor.empty()) return;
  std::vector<std::string> names;
  for (const SuiteExperiment& experiment : experiments) {
    for (const Trial& trial : experiment.trials) {
      if (trial.pairs.empty() || !trial.facts.over.empty()) continue;
      if (trial.facts.id == model.anchor) return;
      names.push_back(trial.facts.id);
    }
  }
  throw base::InputError(entry.find("at")->find("stimulus")->place(),
                         base::unknown_name("stimulus", model.anchor, names));
}

std::vector<SuiteModel> read_all_models(const base::Node& node,
                                        const std::vector<SuiteExperiment>& experiments) {
  std::vector<SuiteModel> models;
  std::set<std::string> ids;
  for (const base::Node& item : node.list("models")) {
    for (SuiteModel& model : read_models(item)) {
      if (!ids.insert(model.id).second) {
        throw base::InputError(item.find("id")->place(),
                               fmt::format("model id \"{}\" is used twice", model.id));
      }
      if (const auto* metric = std::get_if<MetricModel>(&model.question)) {
        check_anchor(item, *metric, experiments);
      }
      models.push_back(std::move(model));
    }
  }
  if (models.empty()) throw base::InputError(node.place(), "models is empty");
  return models;
}

/// A suite's model as an entry that reads the same again; a swept one as a matrix of one point.
struct EntryOf {
  const SuiteModel& model;

  ordered_json operator()(const CsfModel& csf) const {
    return {{"id", model.base_id}, {"csf", csf.csf}};
  }
  ordered_json operator()(const perception::PatternObserver& observer) const {
    return {{"id", model.base_id},
            {"pattern", observer.csf},
            {"pooling_exponent", observer.pooling_exponent},
            {"aperture_deg", observer.aperture_deg}};
  }
  ordered_json operator()(const TviModel& tvi) const {
    return {{"id", model.base_id}, {"tvi", perception::to_string(tvi.curve)}};
  }
  ordered_json operator()(const MetricModel& metric) const {
    const metrics::MetricChoice& choice = metric.readout.metric;
    std::string text = choice.info->name;
    ordered_json matrix;
    for (const auto& [name, value] : choice.parameters.entries()) {
      if (is_swept(name)) {
        matrix[name] = ordered_json::array({base::to_json(value)});
      } else {
        text += fmt::format(",{}={}", name, results::text_of(value));
      }
    }
    ordered_json entry{{"id", model.base_id}, {"metric", text}};
    if (!metric.readout.detail.empty()) entry["reads"] = metric.readout.detail;
    entry["at"] = metric.anchor.empty() ? ordered_json(metric.criterion)
                                        : ordered_json{{"stimulus", metric.anchor}};
    if (!matrix.is_null()) entry["matrix"] = std::move(matrix);
    return entry;
  }

 private:
  bool is_swept(const std::string& name) const {
    return std::find(model.sweep.begin(), model.sweep.end(), name) != model.sweep.end();
  }
};

std::string resolved_json(const PsychophysicsSuite& suite, const base::Node& experiments) {
  ordered_json models = ordered_json::array();
  for (const SuiteModel& model : suite.models) {
    models.push_back(std::visit(EntryOf{model}, model.question));
  }
  const ordered_json json{{"schema", 1},
                          {"suite", suite.name},
                          {"kind", kKind},
                          {"summary", suite.summary},
                          {"experiments", experiments.to_json()},
                          {"models", std::move(models)}};
  return json.dump(1) + "\n";
}

}  // namespace

bool is_psychophysics_suite(const std::filesystem::path& path) {
  const base::Node node = base::read_document(path);
  const base::Node* kind = node.is_map() ? node.find("kind") : nullptr;
  return kind != nullptr && kind->is_scalar() && kind->scalar_text("kind") == kKind;
}

PsychophysicsSuite parse_psychophysics_suite(const base::Node& node,
                                             const std::filesystem::path& file) {
  base::MapReader reader(node, "suite");
  const base::Node& schema = reader.require("schema");
  if (schema.integer("schema") != 1) {
    throw base::InputError(schema.place(),
                           fmt::format("schema is {}; accepted: 1", schema.scalar_text("schema")));
  }
  const base::Node& kind = reader.require("kind");
  if (kind.text("kind") != kKind) {
    throw base::InputError(
        kind.place(), fmt::format("kind is \"{}\"; accepted here: {}", kind.text("kind"), kKind));
  }
  PsychophysicsSuite suite;
  suite.file = file;
  suite.name = read_safe_name(reader.require("suite"), "suite");
  suite.summary = reader.text("summary", "");
  const base::Node& experiments = reader.require("experiments");
  suite.experiments = read_experiments(experiments);
  suite.models = read_all_models(reader.require("models"), suite.experiments);
  reader.finish();
  suite.resolved = resolved_json(suite, experiments);
  return suite;
}

PsychophysicsSuite read_psychophysics_suite(const std::filesystem::path& path) {
  return parse_psychophysics_suite(base::read_document(path), path);
}

}  // namespace suites::psychophysics
