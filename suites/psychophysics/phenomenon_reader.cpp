#include <algorithm>

#include <fmt/format.h>

#include "suites/psychophysics/readers.h"
#include "suites/safe_name.h"

namespace suites::psychophysics {
namespace {

using results::psychophysics::ObservedStimulus;
using results::psychophysics::Phenomenon;
using results::psychophysics::PhenomenonKind;

/// `stimuli: [ids]`, `series: name`, or all.
std::vector<std::string> read_stimuli(base::MapReader& reader,
                                      const std::vector<ObservedStimulus>& known) {
  std::vector<std::string> ids;
  const base::Node* list = reader.find("stimuli");
  const base::Node* series = reader.find("series");
  if (list != nullptr) {
    std::vector<std::string> names;
    for (const ObservedStimulus& stimulus : known) names.push_back(stimulus.id);
    for (const base::Node& item : list->list("stimuli")) {
      const std::string id = item.scalar_text("stimulus");
      if (std::find(names.begin(), names.end(), id) == names.end()) {
        throw base::InputError(item.place(), base::unknown_name("stimulus", id, names));
      }
      ids.push_back(id);
    }
    return ids;
  }
  for (const ObservedStimulus& stimulus : known) {
    if (series == nullptr || stimulus.series == series->text("series")) ids.push_back(stimulus.id);
  }
  if (ids.empty()) {
    throw base::InputError(series->place(), fmt::format("no stimulus is of the series \"{}\"",
                                                        series->text("series")));
  }
  return ids;
}

void read_slope(const base::Node& node, const std::vector<ObservedStimulus>& known,
                Phenomenon& phenomenon) {
  base::MapReader reader(node, "slope");
  const std::vector<double> bounds = base::number_list(reader.require("between"), "between", 2);
  phenomenon.low = bounds[0];
  phenomenon.high = bounds[1];
  if (const base::Node* of = reader.find("of")) {
    const std::vector<std::string> accepted{"contrast", "step"};
    if (std::find(accepted.begin(), accepted.end(), of->text("of")) == accepted.end()) {
      throw base::InputError(of->place(), base::unknown_name("quantity", of->text("of"), accepted));
    }
    phenomenon.is_of_step = of->text("of") == "step";
  }
  reader.finish();
  for (const std::string& id : phenomenon.stimuli) {
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const auto& stimulus) { return stimulus.id == id; });
    if (found->x > 0.0) continue;
    throw base::InputError(
        node.place(), fmt::format("a slope is over log10 of the axis, and stimulus \"{}\" lies "
                                  "at {} there; accepted: above 0",
                                  id, found->x));
  }
}

void read_test(base::MapReader& reader, const std::vector<ObservedStimulus>& known,
               Phenomenon& phenomenon) {
  const std::string kind = only_key(reader, {"slope", "lower", "ranking", "within"});
  const base::Node& node = reader.require(kind);
  if (kind == "slope") {
    read_slope(node, known, phenomenon);
    return;
  }
  base::MapReader test(node, kind);
  if (kind == "lower") {
    phenomenon.kind = PhenomenonKind::lower;
    phenomenon.low = test.number("by_db", 0.0);
    if (phenomenon.stimuli.size() != 2) {
      throw base::InputError(node.place(), "lower compares two stimuli: stimuli: [lower, higher]");
    }
  } else if (kind == "ranking") {
    phenomenon.kind = PhenomenonKind::ranking;
    phenomenon.low = bounded_number(test.require("at_least"), "at_least", -1.0, 1.0);
  } else {
    phenomenon.kind = PhenomenonKind::within;
    phenomenon.factor = bounded_number(test.require("factor"), "factor", 1.0, 1e6);
    phenomenon.low = 1.0;
    if (const base::Node* share = test.find("at_least")) {
      phenomenon.low = bounded_number(*share, "at_least", 0.0, 1.0);
    }
  }
  test.finish();
}

}  // namespace

Phenomenon read_phenomenon(const base::Node& node, const std::vector<ObservedStimulus>& stimuli) {
  base::MapReader reader(node, "phenomenon");
  Phenomenon phenomenon;
  phenomenon.id = read_safe_name(reader.require("id"), "id");
  phenomenon.says = reader.required_text("says");
  phenomenon.stimuli = read_stimuli(reader, stimuli);
  read_test(reader, stimuli, phenomenon);
  reader.finish();
  return phenomenon;
}

}  // namespace suites::psychophysics
