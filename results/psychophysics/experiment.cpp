#include "results/psychophysics/experiment.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "results/json_fields.h"

namespace results::psychophysics {

using nlohmann::ordered_json;

namespace {

constexpr std::array<const char*, 3> kHalfNames{"", "calibration", "held_out"};
constexpr std::array<const char*, 4> kKindNames{"slope", "lower", "ranking", "within"};

/// The enumerator of a name. @throws base::InputError listing the names
template <class Enum, std::size_t Count>
Enum enumerator_of(const std::array<const char*, Count>& names, const JsonFields& fields,
                   const char* key) {
  const std::string text = fields.text(key);
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) {
    throw base::InputError(
        base::unknown_name(fmt::format("{} of {}", key, fields.what()), text,
                           std::vector<std::string>(names.begin(), names.end())));
  }
  return static_cast<Enum>(found - names.begin());
}

ordered_json to_json(const ObservedStimulus& stimulus) {
  return {{"id", stimulus.id},
          {"description", stimulus.description},
          {"series", stimulus.series},
          {"x", finite_or_null(stimulus.x)},
          {"mean_cd_m2", finite_or_null(stimulus.mean_cd_m2)},
          {"observed_db", finite_or_null(stimulus.observed_db)},
          {"sd_db", stimulus.sd_db ? finite_or_null(*stimulus.sd_db) : ordered_json()},
          {"over", stimulus.over},
          {"half", to_string(stimulus.half)},
          {"picture", stimulus.picture}};
}

ObservedStimulus stimulus_from_json(const ordered_json& json) {
  const JsonFields fields(json, "stimulus");
  return {fields.text("id"),
          fields.text("description"),
          fields.text("series"),
          fields.number("x"),
          fields.number("mean_cd_m2"),
          fields.number("observed_db"),
          fields.optional_number("sd_db"),
          fields.text("over"),
          enumerator_of<Half>(kHalfNames, fields, "half"),
          fields.text("picture")};
}

ordered_json to_json(const Phenomenon& phenomenon) {
  return {{"kind", to_string(phenomenon.kind)},
          {"id", phenomenon.id},
          {"says", phenomenon.says},
          {"stimuli", phenomenon.stimuli},
          {"is_of_step", phenomenon.is_of_step},
          {"low", finite_or_null(phenomenon.low)},
          {"high", finite_or_null(phenomenon.high)},
          {"factor", finite_or_null(phenomenon.factor)}};
}

Phenomenon phenomenon_from_json(const ordered_json& json) {
  const JsonFields fields(json, "phenomenon");
  Phenomenon phenomenon;
  phenomenon.kind = enumerator_of<PhenomenonKind>(kKindNames, fields, "kind");
  phenomenon.id = fields.text("id");
  phenomenon.says = fields.text("says");
  for (const ordered_json& id : fields.list("stimuli")) {
    if (!id.is_string()) fields.fail("stimuli", "a list of texts", id);
    phenomenon.stimuli.push_back(id.get<std::string>());
  }
  phenomenon.is_of_step = fields.flag("is_of_step");
  phenomenon.low = fields.number("low");
  phenomenon.high = fields.number("high");
  phenomenon.factor = fields.number("factor");
  return phenomenon;
}

}  // namespace

std::string to_string(Half half) { return kHalfNames[static_cast<std::size_t>(half)]; }

std::string to_string(PhenomenonKind kind) { return kKindNames[static_cast<std::size_t>(kind)]; }

const ObservedStimulus* Experiment::find(const std::string& stimulus) const {
  const auto found = std::find_if(stimuli.begin(), stimuli.end(),
                                  [&](const auto& candidate) { return candidate.id == stimulus; });
  return found == stimuli.end() ? nullptr : &*found;
}

ordered_json to_json(const Experiment& experiment) {
  ordered_json stimuli = ordered_json::array();
  for (const ObservedStimulus& stimulus : experiment.stimuli) stimuli.push_back(to_json(stimulus));
  ordered_json phenomena = ordered_json::array();
  for (const Phenomenon& phenomenon : experiment.phenomena) {
    phenomena.push_back(to_json(phenomenon));
  }
  return {{"id", experiment.id},
          {"summary", experiment.summary},
          {"source", experiment.source},
          {"axis", {{"title", experiment.axis.title}, {"unit", experiment.axis.unit}}},
          {"stimuli", std::move(stimuli)},
          {"phenomena", std::move(phenomena)}};
}

Experiment experiment_from_json(const ordered_json& json) {
  const JsonFields fields(json, "experiment");
  Experiment experiment;
  experiment.id = fields.text("id");
  experiment.summary = fields.text("summary");
  experiment.source = fields.text("source");
  const JsonFields axis(fields.object("axis"), "axis");
  experiment.axis = {axis.text("title"), axis.text("unit")};
  for (const ordered_json& stimulus : fields.list("stimuli")) {
    experiment.stimuli.push_back(stimulus_from_json(stimulus));
  }
  for (const ordered_json& phenomenon : fields.list("phenomena")) {
    experiment.phenomena.push_back(phenomenon_from_json(phenomenon));
  }
  return experiment;
}

}  // namespace results::psychophysics
