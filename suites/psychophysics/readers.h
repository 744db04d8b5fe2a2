#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "suites/psychophysics/psychophysics_suite.h"

/// The parts of a suite file, each a function from its node. All throw base::InputError with
/// file:line:column, the value found and what is accepted.
namespace suites::psychophysics {

/// What an experiment says of all its stimuli; a stimulus may say otherwise.
struct StimulusDefaults {
  std::optional<double> mean_cd_m2;
  std::optional<double> pixels_per_degree;
  std::optional<double> size_deg;
  std::string axis;               ///< none | frequency | pedestal | mask | field
  int noise_samples = 1;          ///< of stimuli in noise
  double log10_unit_cd_m2 = 0.0;  ///< of fields and steps given as logarithms
};

SuiteExperiment read_experiment(const base::Node& node);
Trial read_trial(const base::Node& node, const StimulusDefaults& defaults, std::size_t number);
results::psychophysics::Phenomenon read_phenomenon(
    const base::Node& node, const std::vector<results::psychophysics::ObservedStimulus>& stimuli);
/// The models of one entry: one, or one per point of its matrix.
std::vector<SuiteModel> read_models(const base::Node& node);

/// @throws base::InputError unless low <= value <= high
double bounded_number(const base::Node& node, std::string_view what, double low, double high);
/// The one key of the map that is among these. @throws base::InputError if there is none or another
std::string only_key(base::MapReader& reader, const std::vector<std::string>& keys);

}  // namespace suites::psychophysics
