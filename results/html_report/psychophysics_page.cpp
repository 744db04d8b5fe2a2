#include "results/html_report/psychophysics_page.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "results/html_report/frame_chart.h"
#include "results/html_report/html_table.h"
#include "results/html_report/html_text.h"
#include "results/html_report/json_text.h"
#include "results/html_report/page_frame.h"
#include "results/html_report/run_facts.h"
#include "results/psychophysics/model_summary.h"
#include "results/psychophysics/model_tables.h"
#include "results/run_files.h"

namespace results::html_report {

namespace {

using psychophysics::Comparison;
using psychophysics::Experiment;
using psychophysics::ModelSummary;
using psychophysics::ObservedStimulus;
using psychophysics::PsychophysicsRun;

/// Lines that a chart holds beside the observed one; more cannot be told apart.
constexpr std::size_t kMostLines = 7;

std::string header(const PsychophysicsRun& run) {
  const nlohmann::ordered_json& info = *run.info;
  std::string html = fmt::format("<header><h1>{}</h1>\n", escape(text_at(info, {"suite"})));
  const std::string summary = text_at(info, {"summary"});
  if (!summary.empty()) html += fmt::format("<p class=\"lead\">{}</p>\n", escape(summary));
  html += "<dl class=\"facts\">";
  html += fact("run", text_at(info, {"run"}));
  html += fact("started", text_at(info, {"environment", "started_utc"}));
  html += fact("state", state_text(info));
  html += fact("machine", text_at(info, {"environment", "machine"}));
  html += fact("commit", commit_text(info));
  html += fact("answers", fmt::format("{} of {}", run.predictions.size(),
                                      text_at(info, {"planned_questions"})));
  html += "</dl>\n";
  if (run.unreadable_lines > 0) {
    html += fmt::format(
        "<p class=\"warning\">{} cut lines of the result files were left out: a "
        "process was killed while it wrote.</p>\n",
        run.unreadable_lines);
  }
  std::string links;
  for (std::size_t i = 0; i < run.experiments.size(); ++i) {
    links += fmt::format("<a href=\"#experiment-{}\">{}</a>", i, escape(run.experiments[i].id));
  }
  return html + "</header>\n<nav>" + links +
         "<a href=\"#models\">Models</a><a href=\"#provenance\">Provenance</a></nav>\n";
}

std::string format_db(double db) {
  return fmt::format("{:.1f} dB", std::abs(db) < 0.05 ? 0.0 : db);
}

/// Series of the experiment in the order of their first stimuli.
std::vector<std::string> series_of(const Experiment& experiment) {
  std::vector<std::string> names;
  for (const ObservedStimulus& stimulus : experiment.stimuli) {
    if (std::find(names.begin(), names.end(), stimulus.series) == names.end()) {
      names.push_back(stimulus.series);
    }
  }
  return names;
}

/// The stimuli of a series that share a scale: elevations, where there are any, else thresholds.
std::vector<const ObservedStimulus*> charted_stimuli(const Experiment& experiment,
                                                     const std::string& series) {
  std::vector<const ObservedStimulus*> thresholds;
  std::vector<const ObservedStimulus*> elevations;
  for (const ObservedStimulus& stimulus : experiment.stimuli) {
    if (stimulus.series != series) continue;
    (stimulus.over.empty() ? thresholds : elevations).push_back(&stimulus);
  }
  return elevations.empty() ? thresholds : elevations;
}

ChartLine observed_line(const std::vector<const ObservedStimulus*>& stimuli) {
  ChartLine line{"observed", 0, {}, true};
  for (const ObservedStimulus* stimulus : stimuli) {
    line.points.push_back({stimulus->x, stimulus->observed_db, stimulus->sd_db.value_or(0.0)});
  }
  return line;
}

ChartLine model_line(const std::vector<Comparison>& compared,
                     const std::vector<const ObservedStimulus*>& stimuli, const std::string& label,
                     std::size_t color) {
  ChartLine line{label, color, {}, false};
  for (const Comparison& one : compared) {
    if (std::find(stimuli.begin(), stimuli.end(), one.stimulus) == stimuli.end()) continue;
    line.points.push_back({one.stimulus->x,
                           one.predicted_db.value_or(std::numeric_limits<double>::quiet_NaN()),
                           0.0});
  }
  return line;
}

/// Axes and title of a series' chart.
FrameChart empty_chart(const Experiment& experiment, const std::string& series,
                       const std::vector<const ObservedStimulus*>& stimuli) {
  constexpr std::size_t kMostNames = 8;
  FrameChart chart;
  const char* quantity = stimuli.front()->over.empty() ? "threshold" : "elevation";
  chart.title = series.empty() ? quantity : fmt::format("{}, {}", quantity, series);
  chart.is_log_x = !experiment.axis.title.empty();
  chart.x_title = chart.is_log_x
                      ? fmt::format("{} ({})", experiment.axis.title, experiment.axis.unit)
                      : "stimulus";
  if (!chart.is_log_x && stimuli.size() <= kMostNames) {
    for (const ObservedStimulus* stimulus : stimuli) {
      chart.x_names.emplace_back(stimulus->x, stimulus->id);
    }
    // Room for the outermost names.
    chart.x_range = {stimuli.front()->x - 0.5, stimuli.back()->x + 0.5};
  }
  chart.starts_at_zero = false;
  chart.format = format_db;
  chart.lines.push_back(observed_line(stimuli));
  return chart;
}

/// The models that fit best, as many as a chart holds, in the order of the suite.
std::vector<const ModelSummary*> charted_models(const std::vector<ModelSummary>& summaries) {
  std::vector<const ModelSummary*> models;
  for (const ModelSummary& summary : summaries) {
    if (summary.all) models.push_back(&summary);
  }
  if (models.size() <= kMostLines) return models;
  std::vector<const ModelSummary*> best = models;
  std::stable_sort(best.begin(), best.end(), [](const auto* a, const auto* b) {
    return a->all->rms_after_gain_db < b->all->rms_after_gain_db;
  });
  best.resize(kMostLines);
  std::erase_if(models, [&](const auto* model) {
    return std::find(best.begin(), best.end(), model) == best.end();
  });
  return models;
}

std::string charts(const PsychophysicsRun& run, const Experiment& experiment,
                   const std::vector<ModelSummary>& summaries) {
  const std::vector<const ModelSummary*> models = charted_models(summaries);
  std::string html;
  std::vector<ChartLine> legend{{"observed", 0, {}, true}};
  for (const std::string& series : series_of(experiment)) {
    const std::vector<const ObservedStimulus*> stimuli = charted_stimuli(experiment, series);
    FrameChart chart = empty_chart(experiment, series, stimuli);
    for (std::size_t i = 0; i < models.size(); ++i) {
      const std::string& id = models[i]->model->id;
      chart.lines.push_back(
          model_line(comparisons(run, experiment, *models[i]->model), stimuli, id, i + 1));
      if (legend.size() <= models.size()) legend.push_back({id, i + 1, {}, false});
    }
    html += frame_chart(chart);
  }
  std::string note;
  if (models.size() == kMostLines && summaries.size() > kMostLines) {
    note = fmt::format(
        "<p class=\"note\">The {} models with the least misfit after gain are "
        "shown.</p>\n",
        kMostLines);
  }
  return line_legend(legend) + note + "<div class=\"frame-charts\">" + html + "</div>\n";
}

/// What the stimuli look like, well above threshold.
std::string gallery(const PsychophysicsRun& run, const Experiment& experiment) {
  std::string figures;
  for (const ObservedStimulus& stimulus : experiment.stimuli) {
    const std::filesystem::path path = run.folder / stimulus.picture;
    std::error_code error;
    if (stimulus.picture.empty() || !std::filesystem::is_regular_file(path, error)) continue;
    figures += fmt::format(
        "<figure><img class=\"picture\" src=\"data:image/png;base64,{}\" alt=\"{}\">"
        "<figcaption><b>{}</b><span>{}</span></figcaption></figure>\n",
        base64(base::read_text_file(path)), escape(stimulus.description), escape(stimulus.id),
        escape(format_db(stimulus.observed_db)));
  }
  if (figures.empty()) return "";
  return "<details><summary>the stimuli, their targets well above threshold, on a field of half "
         "signal</summary><div class=\"pictures stimuli\">" +
         figures + "</div></details>\n";
}

std::string experiment_section(const PsychophysicsRun& run, std::size_t index) {
  const Experiment& experiment = run.experiments[index];
  const std::vector<ModelSummary> summaries = summarize(run, experiment);
  std::string html =
      fmt::format("<section id=\"experiment-{}\"><h2>{}</h2>\n", index, escape(experiment.id));
  if (!experiment.summary.empty()) {
    html += fmt::format("<p class=\"lead\">{}</p>\n", escape(experiment.summary));
  }
  html += fmt::format("<p class=\"note\">Data: {}</p>\n", escape(experiment.source));
  html += html_table(psychophysics::model_table(experiment, summaries),
                     fmt::format("models-{}", index));
  html += charts(run, experiment, summaries) + gallery(run, experiment);
  html +=
      "<h3>Every stimulus</h3>\n<p class=\"note\">Threshold in dB, below it the residual; "
      "colour by its size: <span class=\"rank-0\">to 1.5</span> <span class=\"rank-1\">to "
      "3</span> <span class=\"rank-2\">to 6</span> <span class=\"rank-3\">to 12</span> "
      "<span class=\"rank-4\">more</span>.</p>\n";
  return html +
         html_table(psychophysics::stimulus_table(run, experiment),
                    fmt::format("stimuli-{}", index)) +
         "</section>\n";
}

std::string model_section(const PsychophysicsRun& run) {
  std::string rows;
  for (const psychophysics::VisionModel& model : run.models) {
    rows += word_row({escape(model.id), escape(model.kind), escape(model.summary)});
  }
  std::string html = "<section id=\"models\"><h2>Models</h2>\n" +
                     word_table({"model", "kind", "what it is asked"}, rows);
  const Table calibration = psychophysics::calibration_table(run);
  if (!calibration.rows.empty()) {
    html += "<h3>Calibration</h3>\n" + html_table(calibration, "calibration");
  }
  return html + "</section>\n";
}

}  // namespace

std::string psychophysics_page(const PsychophysicsRun& run) {
  std::string body = header(run) + "<main>\n";
  for (std::size_t i = 0; i < run.experiments.size(); ++i) body += experiment_section(run, i);
  body += model_section(run) + "<section id=\"provenance\"><h2>Provenance</h2>\n" +
          machine_table(*run.info) + command_and_suite(*run.info, run.resolved_suite) +
          "</section>\n</main>\n";
  return page_frame(
      run.folder.parent_path().filename().string() + " · " + run.folder.filename().string(), body);
}

std::filesystem::path write_report(const PsychophysicsRun& run) {
  require_no_links(run.folder);
  return write_page(run.folder, psychophysics_page(run));
}

}  // namespace results::html_report
