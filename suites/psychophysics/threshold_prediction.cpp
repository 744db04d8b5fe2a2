#include "suites/psychophysics/threshold_prediction.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "metrics/threshold_search.h"
#include "suites/interruption.h"

namespace suites::psychophysics {
namespace {

using results::Status;
using results::psychophysics::PredictionRecord;

/// The trial is no question for the model; the message says why.
struct NoQuestion : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The model's answer is no number.
struct NotANumber : std::runtime_error {
  using std::runtime_error::runtime_error;
};

double db_of(double contrast) { return 20.0 * std::log10(contrast); }

perception::ViewingConditions viewing_of(const Trial& trial) {
  // Stimuli are light already: of the conditions only the size of a pixel plays a part.
  perception::ViewingConditions viewing = perception::default_viewing_conditions();
  viewing.pixels_per_degree = trial.pixels_per_degree;
  return viewing;
}

/// The pictures of one target at any contrast: what they add to the reference grows in proportion,
/// so that noise and patterns are made once.
class LinearTarget {
 public:
  explicit LinearTarget(const std::function<perception::StimulusPair(double)>& pair)
      : pair_(pair(kContrast)), step_(pair_.test) {
    for (std::size_t i = 0; i < step_.pixels.size(); ++i) {
      step_.pixels[i] -= pair_.reference.pixels[i];
    }
  }

  /// The pair of a contrast, valid until the next call.
  const perception::StimulusPair& at(double contrast) {
    const auto factor = static_cast<float>(contrast / kContrast);
    for (std::size_t i = 0; i < step_.pixels.size(); ++i) {
      pair_.test.pixels[i] = pair_.reference.pixels[i] + factor * step_.pixels[i];
    }
    return pair_;
  }

 private:
  static constexpr double kContrast = 0.5;
  perception::StimulusPair pair_;
  perception::Image step_;
};

/// A metric's response, refused where it is no number.
double checked_response(const MetricModel& model, const Trial& trial,
                        const perception::StimulusPair& pair, double contrast) {
  if (interrupt_requested) throw Interrupted();
  const double response = metrics::response_to(pair, model.readout, viewing_of(trial));
  if (std::isnan(response)) {
    throw NotANumber(fmt::format("the score is not a number at contrast {:g}", contrast));
  }
  return response;
}

/// The criterion of a model, from people's threshold of its anchor if it has one.
double criterion_of(const MetricModel& model, const PsychophysicsSuite& suite) {
  if (model.anchor.empty()) return model.criterion;
  for (const SuiteExperiment& experiment : suite.experiments) {
    for (const Trial& trial : experiment.trials) {
      if (trial.facts.id != model.anchor || trial.pairs.empty()) continue;
      const double contrast = std::pow(10.0, trial.facts.observed_db / 20.0);
      return checked_response(model, trial, LinearTarget(trial.pairs.front()).at(contrast),
                              contrast);
    }
  }
  throw NoQuestion(fmt::format("its anchor {} is no stimulus of a metric", model.anchor));
}

/// Answers one model's question, kind by kind.
class Answer {
 public:
  Answer(const Trial& trial, const PsychophysicsSuite& suite, PredictionRecord& record)
      : trial_(trial), suite_(suite), record_(record) {}

  void operator()(const CsfModel& model) const {
    if (!trial_.plain || !trial_.plain->gabor) {
      throw NoQuestion("a CSF knows single Gabor patches on a plain field only");
    }
    set(perception::gabor_threshold(*trial_.plain->gabor, trial_.facts.mean_cd_m2, model.csf,
                                    trial_.eccentricity_deg));
  }

  void operator()(const perception::PatternObserver& model) const {
    if (!trial_.plain) throw NoQuestion("the filter has no masking");
    if (trial_.eccentricity_deg > 0.0) throw NoQuestion("the filter looks at the fovea");
    set(perception::pattern_threshold(*trial_.plain, trial_.facts.mean_cd_m2,
                                      trial_.pixels_per_degree, model));
  }

  void operator()(const TviModel& model) const {
    if (!trial_.is_spot) throw NoQuestion("TVI knows spots on plain fields only");
    const double field = trial_.facts.mean_cd_m2;
    set(perception::threshold_cd_m2(model.curve, field) / field);
  }

  void operator()(const MetricModel& model) const {
    if (trial_.pairs.empty()) throw NoQuestion("a metric looks straight at the picture");
    const double criterion = criterion_of(model, suite_);
    double sum_db = 0.0;
    for (const auto& pair : trial_.pairs) {
      LinearTarget target(pair);
      const metrics::FoundThreshold found = metrics::find_threshold(
          [&](double contrast) {
            return checked_response(model, trial_, target.at(contrast), contrast);
          },
          criterion, trial_.range);
      record_.evaluations += found.evaluations;
      if (!found.contrast) {
        record_.samples_db.clear();
        record_.reason = reason_of(found);
        return;
      }
      record_.samples_db.push_back(db_of(*found.contrast));
      sum_db += record_.samples_db.back();
    }
    record_.threshold_db = sum_db / static_cast<double>(trial_.pairs.size());
  }

 private:
  std::string reason_of(const metrics::FoundThreshold& found) const {
    return found.is_below_range
               ? fmt::format("seen at the lowest contrast already, {:g}", trial_.range.lowest)
               : fmt::format("not seen at the largest contrast, {:g}", trial_.range.largest);
  }

  void set(double contrast) const {
    record_.evaluations = 1;
    if (!std::isfinite(contrast)) {
      record_.reason = "not seen at any contrast";
      return;
    }
    record_.threshold_db = db_of(contrast);
    record_.samples_db = {db_of(contrast)};
  }

  const Trial& trial_;
  const PsychophysicsSuite& suite_;
  PredictionRecord& record_;
};

}  // namespace

PredictionRecord predict(const SuiteModel& model, const Trial& trial,
                         const PsychophysicsSuite& suite) {
  PredictionRecord record;
  record.stimulus = trial.facts.id;
  record.model = model.id;
  try {
    std::visit(Answer(trial, suite, record), model.question);
  } catch (const NoQuestion& why) {
    record.status = Status::unsupported;
    record.reason = why.what();
  } catch (const base::InputError& error) {
    // E.g. a metric that takes no absolute light.
    record.status = Status::unsupported;
    record.reason = error.what();
  } catch (const NotANumber& error) {
    record.status = Status::non_finite;
    record.reason = error.what();
  }
  return record;
}

}  // namespace suites::psychophysics
