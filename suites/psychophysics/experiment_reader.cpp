#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "suites/psychophysics/readers.h"
#include "suites/safe_name.h"

namespace suites::psychophysics {
namespace {

using results::psychophysics::ExperimentAxis;
using results::psychophysics::Half;
using results::psychophysics::ObservedStimulus;

struct NamedAxis {
  const char* name;
  ExperimentAxis axis;
};

const std::vector<NamedAxis>& known_axes() {
  static const std::vector<NamedAxis> kAxes{{"none", {"", ""}},
                                            {"frequency", {"spatial frequency", "cpd"}},
                                            {"pedestal", {"pedestal contrast", "%"}},
                                            {"mask", {"mask contrast", "%"}},
                                            {"field", {"luminance of the field", "cd/m2"}}};
  return kAxes;
}

ExperimentAxis read_axis(base::MapReader& reader, std::string& name) {
  name = reader.text("axis", "none");
  std::vector<std::string> names;
  for (const NamedAxis& known : known_axes()) {
    if (name == known.name) return known.axis;
    names.emplace_back(known.name);
  }
  throw base::InputError(reader.find("axis")->place(), base::unknown_name("axis", name, names));
}

StimulusDefaults read_defaults(base::MapReader& reader) {
  StimulusDefaults defaults;
  constexpr double kTiny = 1e-9;
  const auto read = [&](const char* key, double most) -> std::optional<double> {
    const base::Node* node = reader.find(key);
    return node == nullptr ? std::nullopt : std::optional(bounded_number(*node, key, kTiny, most));
  };
  defaults.mean_cd_m2 = read("mean_cd_m2", 1e9);
  defaults.pixels_per_degree = read("ppd", 10000.0);
  defaults.size_deg = read("size_deg", 180.0);
  defaults.log10_unit_cd_m2 = reader.number("log10_unit_cd_m2", 0.0);
  if (const base::Node* samples = reader.find("noise_samples")) {
    defaults.noise_samples =
        static_cast<int>(bounded_number(*samples, "noise_samples", 1.0, 1000.0));
  }
  return defaults;
}

/// An elevation is over a threshold of the same experiment.
void check_bases(const base::Node& list, const std::vector<ObservedStimulus>& stimuli) {
  for (std::size_t i = 0; i < stimuli.size(); ++i) {
    if (stimuli[i].over.empty()) continue;
    const bool is_known = std::any_of(stimuli.begin(), stimuli.end(), [&](const auto& other) {
      return other.id == stimuli[i].over && other.over.empty();
    });
    if (is_known) continue;
    std::vector<std::string> names;
    for (const ObservedStimulus& other : stimuli) {
      if (other.over.empty()) names.push_back(other.id);
    }
    throw base::InputError(
        list.list("stimuli")[i].find("observed")->find("over")->place(),
        base::unknown_name("stimulus with a threshold of its own", stimuli[i].over, names));
  }
}

void check_halves(const base::Node& list, const std::vector<ObservedStimulus>& stimuli) {
  const bool has_halves = std::any_of(stimuli.begin(), stimuli.end(),
                                      [](const auto& one) { return one.half != Half::none; });
  for (std::size_t i = 0; has_halves && i < stimuli.size(); ++i) {
    if (stimuli[i].half != Half::none) continue;
    throw base::InputError(list.list("stimuli")[i].place(),
                           fmt::format("stimulus \"{}\" belongs to no half, others do; accepted: "
                                       "half: calibration, half: held_out",
                                       stimuli[i].id));
  }
}

}  // namespace

SuiteExperiment read_experiment(const base::Node& node) {
  base::MapReader reader(node, "experiment");
  SuiteExperiment experiment;
  experiment.facts.id = read_safe_name(reader.require("id"), "id");
  experiment.facts.summary = reader.text("summary", "");
  experiment.facts.source = reader.required_text("source");
  StimulusDefaults defaults = read_defaults(reader);
  experiment.facts.axis = read_axis(reader, defaults.axis);
  const base::Node& stimuli = reader.require("stimuli");
  std::set<std::string> ids;
  for (const base::Node& item : stimuli.list("stimuli")) {
    Trial trial = read_trial(item, defaults, experiment.trials.size() + 1);
    if (!ids.insert(trial.facts.id).second) {
      throw base::InputError(item.place(),
                             fmt::format("stimulus id \"{}\" is used twice", trial.facts.id));
    }
    experiment.facts.stimuli.push_back(trial.facts);
    experiment.trials.push_back(std::move(trial));
  }
  if (experiment.trials.empty()) throw base::InputError(stimuli.place(), "stimuli is empty");
  check_bases(stimuli, experiment.facts.stimuli);
  check_halves(stimuli, experiment.facts.stimuli);
  if (const base::Node* phenomena = reader.find("phenomena")) {
    for (const base::Node& item : phenomena->list("phenomena")) {
      experiment.facts.phenomena.push_back(read_phenomenon(item, experiment.facts.stimuli));
    }
  }
  reader.finish();
  return experiment;
}

double bounded_number(const base::Node& node, std::string_view what, double low, double high) {
  const double value = node.number(what);
  if (value >= low && value <= high) return value;
  throw base::InputError(node.place(),
                         fmt::format("{} is {:g}; accepted: {:g} to {:g}", what, value, low, high));
}

std::string only_key(base::MapReader& reader, const std::vector<std::string>& keys) {
  std::string found;
  for (const std::string& key : keys) {
    if (reader.find(key) == nullptr) continue;
    if (!found.empty()) {
      throw base::InputError(
          reader.node().key_place(key),
          fmt::format("{} has {} and {}; one of them is accepted", reader.what(), found, key));
    }
    found = key;
  }
  if (!found.empty()) return found;
  std::string list;
  for (const std::string& key : keys) list += (list.empty() ? "" : ", ") + key;
  throw base::InputError(reader.node().place(),
                         fmt::format("{} needs one of: {}", reader.what(), list));
}

}  // namespace suites::psychophysics
