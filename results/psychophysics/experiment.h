#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

/// Suites of `kind: psychophysics`: what people saw, and what models say they see.
///
/// Thresholds are in dB, 20 log10(contrast); contrast is (L - L0) / L0 at the pattern's peak, of an
/// edge in noise the root mean square of the edge.
namespace results::psychophysics {

/// Whether a model's constants may be chosen by a stimulus.
enum class Half { none, calibration, held_out };
std::string to_string(Half half);  ///< "", "calibration", "held_out"

/// A stimulus and the threshold that people had for it.
struct ObservedStimulus {
  std::string id;
  std::string description;
  std::string series;  ///< stimuli of one series are joined by a line; "" for one series of all
  double x = 0.0;      ///< place on the experiment's axis; without an axis its number, from 1
  double mean_cd_m2 = 0.0;
  double observed_db = 0.0;     ///< threshold, or elevation over that of `over`
  std::optional<double> sd_db;  ///< standard deviation over observers
  std::string over;             ///< id of the stimulus that the elevation is over; "" for none
  Half half = Half::none;
  std::string picture;  ///< path relative to the run folder; "" if there is none
};

enum class PhenomenonKind {
  slope,    ///< least-squares slope of log10 threshold over log10 x lies between two bounds
  lower,    ///< the first stimulus has a lower threshold than the second
  ranking,  ///< Spearman's correlation of predicted and observed thresholds has a least value
  within    ///< a share of the stimuli, at least `low`, is off by at most `factor`
};
std::string to_string(PhenomenonKind kind);

/// Something that people show, and that a model shows or does not.
struct Phenomenon {
  PhenomenonKind kind = PhenomenonKind::slope;
  std::string id;
  std::string says;                  ///< one sentence
  std::vector<std::string> stimuli;  ///< ids
  bool is_of_step = false;           ///< slope: of the step contrast x mean, cd/m2
  double low = 0.0;                  ///< of a slope; least correlation; least share
  double high = 0.0;                 ///< of a slope
  double factor = 1.0;               ///< of `within`
};

/// What the stimuli are laid out over.
struct ExperimentAxis {
  std::string title;  ///< "spatial frequency"; "" for none
  std::string unit;
};

struct Experiment {
  std::string id;
  std::string summary;
  std::string source;
  ExperimentAxis axis;
  std::vector<ObservedStimulus> stimuli;
  std::vector<Phenomenon> phenomena;

  /// Null if the experiment has none of that id.
  const ObservedStimulus* find(const std::string& stimulus) const;
};

nlohmann::ordered_json to_json(const Experiment& experiment);
/// @throws base::InputError naming the missing or mistyped field
Experiment experiment_from_json(const nlohmann::ordered_json& json);

}  // namespace results::psychophysics
