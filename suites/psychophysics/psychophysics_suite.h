#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "metrics/threshold_search.h"
#include "perception/base/document.h"
#include "perception/pattern_observer.h"
#include "perception/stimuli.h"
#include "perception/threshold_vs_intensity.h"
#include "results/psychophysics/experiment.h"

/// Suites of `kind: psychophysics`: stimuli x models against observed thresholds.
namespace suites::psychophysics {

/// A stimulus as models are asked about it.
struct Trial {
  results::psychophysics::ObservedStimulus facts;
  double pixels_per_degree = 0.0;
  /// The target, where it lies on a plain field: the question that a CSF answers.
  std::optional<perception::Stimulus> plain;
  double eccentricity_deg = 0.0;
  bool is_spot = false;  ///< a large spot on a field: the question that TVI answers
  /// Without and with the target of a contrast, one per sample of noise; none for a target that no
  /// metric can look at, since it is not where the eye looks.
  std::vector<std::function<perception::StimulusPair(double contrast)>> pairs;
  metrics::SearchRange range;
};

struct SuiteExperiment {
  results::psychophysics::Experiment facts;  ///< stimuli in the order of `trials`
  std::vector<Trial> trials;
};

/// 1 / CSF at the frequency of a Gabor patch.
struct CsfModel {
  std::string csf;
};

/// A metric, asked for the contrast at which its score reaches a criterion.
struct MetricModel {
  metrics::Readout readout;
  double criterion = 1.0;
  /// The criterion is what the metric makes of this stimulus at people's threshold, instead; "" for
  /// none.
  std::string anchor;
};

/// What a threshold-versus-intensity curve says of a spot.
struct TviModel {
  perception::ThresholdCurve curve = perception::ThresholdCurve::ward;
};

struct SuiteModel {
  std::string id;  ///< with sweep values: "rama[csf_gain=0.5]"
  std::variant<CsfModel, perception::PatternObserver, MetricModel, TviModel> question;
  std::string base_id;             ///< "rama"
  std::vector<std::string> sweep;  ///< names of the metric's parameters that a matrix sets
};
std::string kind_of(const SuiteModel& model);     ///< csf | pattern | metric | tvi
std::string summary_of(const SuiteModel& model);  ///< one line for a person

/// A suite file, read and checked.
struct PsychophysicsSuite {
  std::string name;
  std::string summary;
  std::filesystem::path file;
  std::vector<SuiteExperiment> experiments;
  std::vector<SuiteModel> models;
  std::string resolved;  ///< the suite again as JSON, each model of a sweep by itself
};

/// True if the file says `kind: psychophysics`. @throws base::InputError if it cannot be parsed
bool is_psychophysics_suite(const std::filesystem::path& path);

/// @throws base::InputError with file:line:column and the accepted names
PsychophysicsSuite read_psychophysics_suite(const std::filesystem::path& path);
PsychophysicsSuite parse_psychophysics_suite(const base::Node& node,
                                             const std::filesystem::path& file);

}  // namespace suites::psychophysics
