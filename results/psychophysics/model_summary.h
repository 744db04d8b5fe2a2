#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "results/psychophysics/psychophysics_run.h"

namespace results::psychophysics {

/// A model's threshold for a stimulus next to that of people, both as an elevation where people's
/// is one.
struct Comparison {
  const ObservedStimulus* stimulus = nullptr;
  const PredictionRecord* record = nullptr;  ///< null: not yet
  std::optional<double> predicted_db;        ///< absent: no threshold, or none to be over

  /// predicted - observed, dB; > 0: people see more than the model. Needs a prediction.
  double residual_db() const { return *predicted_db - stimulus->observed_db; }
};

/// One per stimulus of the experiment, in its order.
std::vector<Comparison> comparisons(const PsychophysicsRun& run, const Experiment& experiment,
                                    const VisionModel& model);

/// How far a model is from people over some stimuli.
struct Misfit {
  std::size_t count = 0;
  double rms_db = 0.0;  ///< root mean square of the residuals
  /// Mean residual of the stimuli that are no elevations: what one factor would mend.
  std::optional<double> gain_db;
  double rms_after_gain_db = 0.0;  ///< with that mean taken out
};

/// Over the comparisons that have a prediction, of one half if it is named; nothing if there are
/// none.
std::optional<Misfit> misfit(const std::vector<Comparison>& compared, Half half = Half::none);

/// What a phenomenon amounts to in the data and in the model.
struct PhenomenonVerdict {
  const Phenomenon* phenomenon = nullptr;
  std::optional<double> observed;   ///< slope; distance in dB; 1 (ranking, within)
  std::optional<double> predicted;  ///< slope; distance in dB; correlation; share
  std::optional<bool> is_shown;     ///< absent: the model has no thresholds to tell
};

/// One model on one experiment.
struct ModelSummary {
  const VisionModel* model = nullptr;
  std::size_t stimuli = 0;
  std::size_t unseen = 0;       ///< asked, but no threshold in range
  std::size_t unsupported = 0;  ///< no question for this model
  std::size_t failed = 0;
  std::size_t missing = 0;  ///< not yet
  std::optional<Misfit> all;
  std::optional<Misfit> calibration;
  std::optional<Misfit> held_out;
  std::vector<PhenomenonVerdict> phenomena;  ///< in the experiment's order

  /// Whether the model has anything to say of the experiment.
  bool is_answered() const { return stimuli > unsupported; }
};

/// One per model of the run, in its order; a pure function of the stored results.
std::vector<ModelSummary> summarize(const PsychophysicsRun& run, const Experiment& experiment);

}  // namespace results::psychophysics
