#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/names.h"
#include "perception/contrast_sensitivity.h"
#include "results/row_selector.h"
#include "suites/parameter_grid.h"
#include "suites/psychophysics/readers.h"
#include "suites/safe_name.h"

namespace suites::psychophysics {
namespace {

std::string read_csf(const base::Node& node) {
  const std::string name = node.text("csf");
  perception::check(perception::PatternObserver{name}, node.place());
  return perception::find_csf(name).name;
}

perception::PatternObserver read_observer(base::MapReader& reader) {
  const base::Node& node = reader.require("pattern");
  perception::PatternObserver observer;
  observer.csf = read_csf(node);
  observer.pooling_exponent = reader.number("pooling_exponent", observer.pooling_exponent);
  observer.aperture_deg = reader.number("aperture_deg", observer.aperture_deg);
  perception::check(observer, node.place());
  return observer;
}

perception::ThresholdCurve read_curve(const base::Node& node) {
  try {
    return perception::threshold_curve_from_text(node.text("tvi"));
  } catch (const base::InputError& error) {
    throw base::InputError(node.place(), error.what());
  }
}

/// `at: 1`, or `at: {stimulus: id}`.
void read_criterion(base::MapReader& reader, MetricModel& model) {
  const base::Node* at = reader.find("at");
  if (at == nullptr) return;
  if (!at->is_map()) {
    model.criterion = bounded_number(*at, "at", 1e-300, 1e300);
    return;
  }
  base::MapReader anchor(*at, "at");
  model.anchor = anchor.required_text("stimulus");
  anchor.finish();
}

bool is_set_by(const GridPoint& point, const std::string& parameter) {
  return std::any_of(point.begin(), point.end(),
                     [&](const auto& entry) { return base::is_same_name(entry.first, parameter); });
}

/// One metric per point of the matrix.
std::vector<SuiteModel> read_metrics(base::MapReader& reader, const std::string& id) {
  const base::Node& node = reader.require("metric");
  MetricModel base_model;
  base_model.readout.detail = reader.text("reads", "");
  read_criterion(reader, base_model);
  const GridKeys keys{reader.find("matrix"), reader.find("zip"), reader.find("include"),
                      reader.find("exclude")};
  std::vector<SuiteModel> models;
  for (const GridPoint& point : parameter_grid(keys)) {
    std::string text = node.text("metric");
    for (const auto& [name, value] : point) text += "," + name + "=" + value.scalar_text(name);
    MetricModel question = base_model;
    question.readout.metric = metrics::parse_metric_choice(text, node.place());
    SuiteModel model{id, {}, id, {}};
    for (const auto& [name, value] : question.readout.metric.parameters.entries()) {
      if (!is_set_by(point, name)) continue;
      model.id +=
          fmt::format("{}{}={}", model.sweep.empty() ? "[" : ",", name, results::text_of(value));
      model.sweep.push_back(name);
    }
    if (!model.sweep.empty()) model.id += "]";
    model.question = std::move(question);
    models.push_back(std::move(model));
  }
  return models;
}

struct KindOf {
  const char* operator()(const CsfModel&) const { return "csf"; }
  const char* operator()(const perception::PatternObserver&) const { return "pattern"; }
  const char* operator()(const MetricModel&) const { return "metric"; }
  const char* operator()(const TviModel&) const { return "tvi"; }
};

struct SummaryOf {
  std::string operator()(const CsfModel& model) const {
    const bool is_relative =
        perception::find_csf(model.csf).normalization == perception::CsfNormalization::relative;
    return fmt::format("1 / {} at the patch's frequency, area and luminance{}", model.csf,
                       is_relative ? "; its scale means nothing, judge it after gain" : "");
  }
  std::string operator()(const perception::PatternObserver& model) const {
    return fmt::format(
        "{} as a filter, Minkowski sum of exponent {:g} under a Gaussian of {:g} deg", model.csf,
        model.pooling_exponent, model.aperture_deg);
  }
  std::string operator()(const MetricModel& model) const {
    const std::string reads = model.readout.detail.empty() ? "value" : model.readout.detail;
    return model.anchor.empty()
               ? fmt::format("{}: {} reaches {:g}", model.readout.metric.text, reads,
                             model.criterion)
               : fmt::format("{}: {} reaches what it is at people's threshold of {}",
                             model.readout.metric.text, reads, model.anchor);
  }
  std::string operator()(const TviModel& model) const {
    return "threshold of a large spot, " + perception::to_string(model.curve);
  }
};

}  // namespace

std::string kind_of(const SuiteModel& model) { return std::visit(KindOf{}, model.question); }

std::string summary_of(const SuiteModel& model) { return std::visit(SummaryOf{}, model.question); }

std::vector<SuiteModel> read_models(const base::Node& node) {
  base::MapReader reader(node, "model");
  const std::string id = read_safe_name(reader.require("id"), "id");
  const std::string kind = only_key(reader, {"csf", "pattern", "metric", "tvi"});
  std::vector<SuiteModel> models;
  if (kind == "csf") models.push_back({id, CsfModel{read_csf(reader.require("csf"))}, id, {}});
  if (kind == "pattern") models.push_back({id, read_observer(reader), id, {}});
  if (kind == "tvi") models.push_back({id, TviModel{read_curve(reader.require("tvi"))}, id, {}});
  if (kind == "metric") models = read_metrics(reader, id);
  reader.finish();
  return models;
}

}  // namespace suites::psychophysics
