#include "results/psychophysics/model_tables.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace results::psychophysics {

namespace {

/// A value that rounds to zero has no sign.
double without_negative_zero(double value, double step) {
  return std::abs(value) < 0.5 * step ? 0.0 : value;
}

TableColumn text_column(const std::string& title) { return {title, "", Direction::none, false}; }

TableColumn db_column(const std::string& title, Direction better) {
  return {title, "dB", better, true};
}

TableCell text_cell(const std::string& text) { return {text, std::nullopt, false, ""}; }

TableCell db_cell(const std::optional<double>& db, const char* missing = "-") {
  if (!db) return text_cell(missing);
  return {fmt::format("{:.1f}", without_negative_zero(*db, 0.1)), *db, false, ""};
}

/// Five steps of a residual's size, each twice the one before.
int shade_of(double residual_db) {
  constexpr double kFinest_db = 1.5;
  const double steps = std::ceil(std::log2(std::abs(residual_db) / kFinest_db));
  return static_cast<int>(std::clamp(steps, 0.0, 4.0));
}

bool has_halves(const Experiment& experiment) {
  return std::any_of(experiment.stimuli.begin(), experiment.stimuli.end(),
                     [](const auto& stimulus) { return stimulus.half != Half::none; });
}

std::optional<double> rms_of(const std::optional<Misfit>& misfit) {
  return misfit ? std::optional(misfit->rms_db) : std::nullopt;
}

/// "38 of 41", with what became of the others.
TableCell found_cell(const ModelSummary& summary) {
  const std::size_t found = summary.all ? summary.all->count : 0;
  TableCell cell = text_cell(fmt::format("{} of {}", found, summary.stimuli));
  cell.sort_value = static_cast<double>(found);
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) cell.note += fmt::format("{}{} {}", cell.note.empty() ? "" : ", ", count, what);
  };
  add(summary.unseen, "out of range");
  add(summary.unsupported, "not its question");
  add(summary.failed, "failed");
  add(summary.missing, "not yet");
  return cell;
}

std::vector<TableCell> model_row(const Experiment& experiment, const ModelSummary& summary) {
  std::vector<TableCell> row{
      text_cell(summary.model->id), found_cell(summary), db_cell(rms_of(summary.all)),
      db_cell(summary.all ? summary.all->gain_db : std::nullopt),
      db_cell(summary.all ? std::optional(summary.all->rms_after_gain_db) : std::nullopt)};
  if (has_halves(experiment)) {
    row.push_back(db_cell(rms_of(summary.calibration)));
    row.push_back(db_cell(rms_of(summary.held_out)));
  }
  for (const PhenomenonVerdict& verdict : summary.phenomena) {
    row.push_back({format_verdict(verdict), verdict.predicted, false, ""});
  }
  return row;
}

/// What people show: the first row, against which every model's is read.
std::vector<TableCell> people_row(const Experiment& experiment,
                                  const std::vector<ModelSummary>& summaries) {
  std::vector<TableCell> row{text_cell("people"), text_cell(""), text_cell(""), text_cell(""),
                             text_cell("")};
  if (has_halves(experiment)) row.insert(row.end(), 2, text_cell(""));
  if (summaries.empty()) return row;
  for (const PhenomenonVerdict& verdict : summaries.front().phenomena) {
    row.push_back(text_cell(
        verdict.observed ? format_phenomenon_value(*verdict.phenomenon, *verdict.observed) : "-"));
  }
  return row;
}

void append_notes(const Experiment& experiment, const std::vector<ModelSummary>& summaries,
                  Table& table) {
  table.notes.emplace_back(
      "rms: of predicted less observed thresholds, 20 log10; > 0 gain: people see more than the "
      "model; after gain: with that mean taken out of thresholds, not of elevations");
  for (const Phenomenon& phenomenon : experiment.phenomena) {
    table.notes.push_back(fmt::format("{}: {}", phenomenon.id, phenomenon.says));
  }
  std::string silent;
  for (const ModelSummary& summary : summaries) {
    if (summary.is_answered()) continue;
    silent += (silent.empty() ? "" : ", ") + summary.model->id;
  }
  if (!silent.empty()) table.notes.push_back("not a question for: " + silent);
}

}  // namespace

std::string format_phenomenon_value(const Phenomenon& phenomenon, double value) {
  switch (phenomenon.kind) {
    case PhenomenonKind::slope:
    case PhenomenonKind::ranking:
      return fmt::format("{:.2f}", without_negative_zero(value, 0.01));
    case PhenomenonKind::lower:
      return fmt::format("{:.1f} dB", without_negative_zero(value, 0.1));
    case PhenomenonKind::within: {
      const auto count = static_cast<double>(phenomenon.stimuli.size());
      return fmt::format("{:.0f} of {:.0f}", value * count, count);
    }
  }
  return "";
}

std::string format_verdict(const PhenomenonVerdict& verdict) {
  if (!verdict.predicted) return "-";
  return fmt::format("{} {}", *verdict.is_shown ? "yes" : "no",
                     format_phenomenon_value(*verdict.phenomenon, *verdict.predicted));
}

Table model_table(const Experiment& experiment, const std::vector<ModelSummary>& summaries) {
  Table table;
  table.columns = {text_column("model"),
                   {"thresholds", "", Direction::none, true},
                   db_column("rms", Direction::lower),
                   db_column("gain", Direction::none),
                   db_column("rms after gain", Direction::lower)};
  if (has_halves(experiment)) {
    table.columns.push_back(db_column("rms, calibration half", Direction::lower));
    table.columns.push_back(db_column("rms, held-out half", Direction::lower));
  }
  for (const Phenomenon& phenomenon : experiment.phenomena) {
    table.columns.push_back({phenomenon.id, "", Direction::none, true});
  }
  if (!experiment.phenomena.empty()) table.rows.push_back(people_row(experiment, summaries));
  for (const ModelSummary& summary : summaries) {
    if (summary.is_answered()) table.rows.push_back(model_row(experiment, summary));
  }
  append_notes(experiment, summaries, table);
  return table;
}

Table calibration_table(const PsychophysicsRun& run) {
  Table table;
  table.columns = {text_column("model"), db_column("rms, calibration half", Direction::lower),
                   db_column("rms, held-out half", Direction::lower)};
  for (const VisionModel& model : run.models) {
    std::vector<Comparison> compared;
    for (const Experiment& experiment : run.experiments) {
      const std::vector<Comparison> more = comparisons(run, experiment, model);
      compared.insert(compared.end(), more.begin(), more.end());
    }
    const std::optional<Misfit> calibration = misfit(compared, Half::calibration);
    if (!calibration) continue;
    table.rows.push_back({text_cell(model.id), db_cell(calibration->rms_db),
                          db_cell(rms_of(misfit(compared, Half::held_out)))});
  }
  std::stable_sort(table.rows.begin(), table.rows.end(), [](const auto& a, const auto& b) {
    return *a[1].sort_value < *b[1].sort_value;
  });
  if (!table.rows.empty()) {
    table.rows.front().front().note = "calibrated";
    table.notes.emplace_back(
        "constants are chosen by the calibration halves of all experiments alone; the held-out "
        "halves say what the choice is worth");
  }
  return table;
}

Table stimulus_table(const PsychophysicsRun& run, const Experiment& experiment) {
  Table table;
  table.columns = {text_column("stimulus"), db_column("observed", Direction::none)};
  std::vector<std::vector<Comparison>> compared;
  for (const ModelSummary& summary : summarize(run, experiment)) {
    if (!summary.is_answered()) continue;
    table.columns.push_back(db_column(summary.model->id, Direction::none));
    compared.push_back(comparisons(run, experiment, *summary.model));
  }
  for (std::size_t i = 0; i < experiment.stimuli.size(); ++i) {
    const ObservedStimulus& stimulus = experiment.stimuli[i];
    TableCell name = text_cell(stimulus.id);
    name.note = stimulus.description;
    TableCell observed = db_cell(stimulus.observed_db);
    if (stimulus.sd_db) observed.note = fmt::format("sd {:.1f}", *stimulus.sd_db);
    std::vector<TableCell> row{name, observed};
    for (const auto& model : compared) {
      TableCell cell = db_cell(model[i].predicted_db);
      if (model[i].predicted_db) {
        cell.note = fmt::format("{:+.1f}", model[i].residual_db());
        cell.shade = shade_of(model[i].residual_db());
      }
      row.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace results::psychophysics
