#include "results/psychophysics/model_summary.h"

#include <algorithm>
#include <cmath>

#include "results/statistics.h"

namespace results::psychophysics {

namespace {

constexpr double kDbPerDecade = 20.0;

const Comparison* find(const std::vector<Comparison>& compared, const std::string& stimulus) {
  const auto found = std::find_if(compared.begin(), compared.end(), [&](const Comparison& one) {
    return one.stimulus->id == stimulus;
  });
  return found == compared.end() ? nullptr : &*found;
}

/// The values of a phenomenon's stimuli, in data and model; the model's are empty where one lacks.
struct Series {
  std::vector<double> log_x;
  std::vector<double> observed_db;
  std::vector<double> predicted_db;
  std::size_t within_factor = 0;
};

Series series_of(const Phenomenon& phenomenon, const std::vector<Comparison>& compared) {
  Series series;
  bool is_complete = true;
  const double most_db = kDbPerDecade * std::log10(phenomenon.factor) + 1e-9;
  for (const std::string& id : phenomenon.stimuli) {
    const Comparison* one = find(compared, id);
    if (one == nullptr) return {};
    const double step_db =
        phenomenon.is_of_step ? kDbPerDecade * std::log10(one->stimulus->mean_cd_m2) : 0.0;
    series.log_x.push_back(std::log10(one->stimulus->x));
    series.observed_db.push_back(one->stimulus->observed_db + step_db);
    if (!one->predicted_db) {
      is_complete = false;
      continue;
    }
    series.predicted_db.push_back(*one->predicted_db + step_db);
    if (std::abs(one->residual_db()) <= most_db) ++series.within_factor;
  }
  if (!is_complete) series.predicted_db.clear();
  return series;
}

bool was_asked(const std::vector<Comparison>& compared, const Phenomenon& phenomenon) {
  return std::all_of(phenomenon.stimuli.begin(), phenomenon.stimuli.end(), [&](const auto& id) {
    const Comparison* one = find(compared, id);
    return one != nullptr && one->record != nullptr && one->record->status == Status::ok;
  });
}

std::optional<double> log_slope(const std::vector<double>& log_x, const std::vector<double>& db) {
  if (db.size() != log_x.size()) return std::nullopt;
  const std::optional<Line> line = least_squares_line(log_x, db);
  return line ? std::optional(line->slope / kDbPerDecade) : std::nullopt;
}

/// Observed and predicted value of a phenomenon.
PhenomenonVerdict values_of(const Phenomenon& phenomenon, const std::vector<Comparison>& compared) {
  const Series series = series_of(phenomenon, compared);
  const std::vector<double>& observed = series.observed_db;
  const std::vector<double>& predicted = series.predicted_db;
  const bool is_complete = !predicted.empty();
  PhenomenonVerdict values;
  values.phenomenon = &phenomenon;
  switch (phenomenon.kind) {
    case PhenomenonKind::slope:
      values.observed = log_slope(series.log_x, observed);
      values.predicted = log_slope(series.log_x, predicted);
      break;
    case PhenomenonKind::lower:
      values.observed = observed.at(1) - observed.at(0);
      if (is_complete) values.predicted = predicted.at(1) - predicted.at(0);
      break;
    case PhenomenonKind::ranking:
      values.observed = 1.0;
      if (is_complete) values.predicted = rank_correlation(observed, predicted);
      break;
    case PhenomenonKind::within:
      // A target that the model does not see at all is off by more than the factor.
      values.observed = 1.0;
      if (was_asked(compared, phenomenon)) {
        values.predicted = static_cast<double>(series.within_factor) /
                           static_cast<double>(phenomenon.stimuli.size());
      }
      break;
  }
  return values;
}

PhenomenonVerdict verdict_of(const Phenomenon& phenomenon,
                             const std::vector<Comparison>& compared) {
  PhenomenonVerdict verdict = values_of(phenomenon, compared);
  if (!verdict.predicted) return verdict;
  const double value = *verdict.predicted;
  verdict.is_shown = value >= phenomenon.low;
  if (phenomenon.kind == PhenomenonKind::slope) {
    verdict.is_shown = *verdict.is_shown && value <= phenomenon.high;
  } else if (phenomenon.kind == PhenomenonKind::lower) {
    verdict.is_shown = *verdict.is_shown && value > 0.0;
  }
  return verdict;
}

void count(const Comparison& compared, ModelSummary& summary) {
  ++summary.stimuli;
  if (compared.record == nullptr) {
    ++summary.missing;
  } else if (compared.record->status == Status::unsupported) {
    ++summary.unsupported;
  } else if (compared.record->status != Status::ok) {
    ++summary.failed;
  } else if (!compared.record->threshold_db) {
    ++summary.unseen;
  }
}

}  // namespace

std::vector<Comparison> comparisons(const PsychophysicsRun& run, const Experiment& experiment,
                                    const VisionModel& model) {
  std::vector<Comparison> compared;
  for (const ObservedStimulus& stimulus : experiment.stimuli) {
    Comparison one{&stimulus, run.find(experiment.id, stimulus.id, model.id), std::nullopt};
    if (one.record != nullptr) one.predicted_db = one.record->threshold_db;
    if (one.predicted_db && !stimulus.over.empty()) {
      const PredictionRecord* base = run.find(experiment.id, stimulus.over, model.id);
      const bool has_base = base != nullptr && base->threshold_db.has_value();
      one.predicted_db =
          has_base ? std::optional(*one.predicted_db - *base->threshold_db) : std::nullopt;
    }
    compared.push_back(one);
  }
  return compared;
}

std::optional<Misfit> misfit(const std::vector<Comparison>& compared, Half half) {
  std::vector<const Comparison*> chosen;
  for (const Comparison& one : compared) {
    const bool is_wanted = half == Half::none || one.stimulus->half == half;
    if (is_wanted && one.predicted_db) chosen.push_back(&one);
  }
  if (chosen.empty()) return std::nullopt;
  Misfit result;
  result.count = chosen.size();
  double sum = 0.0;
  std::size_t thresholds = 0;
  for (const Comparison* one : chosen) {
    if (!one->stimulus->over.empty()) continue;
    sum += one->residual_db();
    ++thresholds;
  }
  if (thresholds > 0) result.gain_db = sum / static_cast<double>(thresholds);
  double squares = 0.0;
  double squares_after_gain = 0.0;
  for (const Comparison* one : chosen) {
    const double residual = one->residual_db();
    const double gain = one->stimulus->over.empty() ? *result.gain_db : 0.0;
    squares += residual * residual;
    squares_after_gain += (residual - gain) * (residual - gain);
  }
  const auto n = static_cast<double>(chosen.size());
  result.rms_db = std::sqrt(squares / n);
  result.rms_after_gain_db = std::sqrt(squares_after_gain / n);
  return result;
}

std::vector<ModelSummary> summarize(const PsychophysicsRun& run, const Experiment& experiment) {
  std::vector<ModelSummary> summaries;
  for (const VisionModel& model : run.models) {
    const std::vector<Comparison> compared = comparisons(run, experiment, model);
    ModelSummary summary;
    summary.model = &model;
    for (const Comparison& one : compared) count(one, summary);
    summary.all = misfit(compared);
    summary.calibration = misfit(compared, Half::calibration);
    summary.held_out = misfit(compared, Half::held_out);
    for (const Phenomenon& phenomenon : experiment.phenomena) {
      summary.phenomena.push_back(verdict_of(phenomenon, compared));
    }
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

}  // namespace results::psychophysics
