#include "suites/psychophysics/psychophysics_runner.h"

#include <algorithm>
#include <chrono>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/parallel.h"
#include "perception/base/units.h"
#include "perception/image_file.h"
#include "results/psychophysics/psychophysics_run.h"
#include "results/result_store.h"
#include "results/run_environment.h"
#include "suites/name_filter.h"
#include "suites/progress_meter.h"
#include "suites/psychophysics/threshold_prediction.h"
#include "suites/run_choice.h"
#include "suites/run_description.h"

namespace suites::psychophysics {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using results::Status;
using results::psychophysics::PredictionRecord;

PredictionRecord named_record(const PlannedQuestion& question) {
  PredictionRecord record;
  record.experiment = question.experiment->facts.id;
  record.stimulus = question.trial->facts.id;
  record.model = question.model->id;
  return record;
}

/// Path of a stimulus's picture within the run folder; "" where there is nothing to look at.
std::string picture_path(const SuiteExperiment& experiment, const Trial& trial) {
  if (trial.pairs.empty()) return "";
  return fmt::format("images/{}/{}.png", experiment.facts.id, trial.facts.id);
}

/// The target well above threshold on its mask, mean grey at half the signal: what the models see,
/// not how bright it was.
perception::Image stimulus_picture(const Trial& trial) {
  const double contrast = trial.is_spot ? 1.0 : 0.5;
  const perception::Image light = trial.pairs.front()(contrast).test;
  perception::Image picture = light;
  picture.encoding = perception::Encoding::display;
  const auto scale = static_cast<float>(0.5 / trial.facts.mean_cd_m2);
  for (float& value : picture.pixels) value = std::clamp(scale * value, 0.0F, 1.0F);
  return picture;
}

void write_pictures(const PsychophysicsSuite& suite, const fs::path& folder) {
  for (const SuiteExperiment& experiment : suite.experiments) {
    fs::create_directories(folder / "images" / experiment.facts.id);
    for (const Trial& trial : experiment.trials) {
      const std::string path = picture_path(experiment, trial);
      if (path.empty() || fs::exists(folder / path)) continue;
      perception::write_png(folder / path, stimulus_picture(trial));
    }
  }
}

ordered_json describe(const PsychophysicsSuite& suite, const RunOptions& options,
                      const std::string& run) {
  ordered_json experiments = ordered_json::array();
  for (const SuiteExperiment& experiment : suite.experiments) {
    results::psychophysics::Experiment facts = experiment.facts;
    for (std::size_t i = 0; i < facts.stimuli.size(); ++i) {
      facts.stimuli[i].picture = picture_path(experiment, experiment.trials[i]);
    }
    experiments.push_back(to_json(facts));
  }
  ordered_json models = ordered_json::array();
  for (const SuiteModel& model : suite.models) {
    models.push_back({{"id", model.id}, {"kind", kind_of(model)}, {"summary", summary_of(model)}});
  }
  return {{"schema", results::kSchemaVersion},
          {"kind", "psychophysics"},
          {"run", run},
          {"suite", suite.name},
          {"summary", suite.summary},
          {"suite_file", suite.file.string()},
          {"command", options.command},
          {"filter", options.filter},
          {"state", to_string(RunState::running)},
          {"updated_utc", base::utc_now()},
          {"identity", run_identity(options)},
          {"environment", results::run_environment()},
          {"experiments", std::move(experiments)},
          {"models", std::move(models)},
          {"planned_questions", plan_questions(suite, "").size()}};
}

/// One session on one run folder.
class Session {
 public:
  Session(const PsychophysicsSuite& suite, const RunOptions& options,
          const std::function<void(const Progress&)>& report)
      : suite_(suite),
        path_(choose_run_folder({suite.name, suite.resolved}, options)),
        questions_(plan_questions(suite, options.filter)),
        folder_(results::RunFolder::open_for_writing(path_)),
        meter_(report),
        info_(describe(suite, options, path_.filename().string())) {
    folder_.write_resolved_suite(suite.resolved);
    write_info(RunState::running);
    for (const PredictionRecord& record :
         results::psychophysics::load_psychophysics_run(path_).predictions) {
      answered_.emplace(cell_name(record), record.status);
    }
  }

  RunOutcome run() {
    outcome_.run_folder = path_;
    outcome_.cells = questions_.size();
    std::vector<const PlannedQuestion*> open;
    for (const PlannedQuestion& question : questions_) {
      const auto answer = answered_.find(cell_name(named_record(question)));
      if (answer == answered_.end()) {
        open.push_back(&question);
      } else {
        count(answer->second);
      }
    }
    write_pictures(suite_, path_);
    meter_.plan(open.size(), static_cast<double>(open.size()));
    try {
      for (const PlannedQuestion* question : open) answer(*question);
    } catch (const Interrupted&) {
      outcome_.was_interrupted = true;
    }
    write_info(outcome_.was_interrupted ? RunState::interrupted : RunState::complete);
    return outcome_;
  }

 private:
  void answer(const PlannedQuestion& question) {
    if (interrupt_requested) throw Interrupted();
    PredictionRecord record = named_record(question);
    meter_.begin_step(cell_name(record), 1.0);
    meter_.show();
    const std::string started = base::utc_now();
    const auto start = std::chrono::steady_clock::now();
    record = predict(*question.model, *question.trial, suite_);
    record.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    record.experiment = question.experiment->facts.id;
    record.run = path_.filename().string();
    record.started_utc = started;
    record.machine = results::machine_name();
    folder_.append_cell(to_json(record));
    count(record.status);
    ++outcome_.new_repetitions;
    meter_.finish_step();
  }

  void count(Status status) {
    ++outcome_.finished_repetitions;
    if (status == Status::unsupported) ++outcome_.skipped_cells;
    if (is_failure(status)) ++outcome_.failed_cells;
  }

  void write_info(RunState state) {
    info_["state"] = to_string(state);
    info_["updated_utc"] = base::utc_now();
    folder_.write_run_json(info_);
  }

  const PsychophysicsSuite& suite_;
  fs::path path_;
  std::vector<PlannedQuestion> questions_;
  results::RunFolder folder_;
  ProgressMeter meter_;
  ordered_json info_;
  std::map<std::string, Status> answered_;  ///< by earlier sessions
  RunOutcome outcome_;
};

}  // namespace

std::vector<PlannedQuestion> plan_questions(const PsychophysicsSuite& suite,
                                            const std::string& filter) {
  const NameFilter wanted(filter);
  std::vector<PlannedQuestion> questions;
  for (const SuiteExperiment& experiment : suite.experiments) {
    for (const Trial& trial : experiment.trials) {
      for (const SuiteModel& model : suite.models) {
        const PlannedQuestion question{&experiment, &trial, &model};
        if (wanted.matches(cell_name(named_record(question)))) {
          questions.push_back(question);
        }
      }
    }
  }
  return questions;
}

RunOutcome run_psychophysics(const PsychophysicsSuite& suite, const RunOptions& options,
                             const std::function<void(const Progress&)>& report) {
  const base::ThreadLimit limit(options.threads);
  return Session(suite, options, report).run();
}

}  // namespace suites::psychophysics
