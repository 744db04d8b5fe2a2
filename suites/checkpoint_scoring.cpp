#include "suites/checkpoint_scoring.h"

#include <map>
#include <tuple>

#include <fmt/format.h>

#include "perception/image_file.h"
#include "suites/planned_work.h"
#include "suites/score_plan.h"
#include "suites/score_references.h"
#include "suites/score_writer.h"
#include "suites/suite_runner.h"

namespace suites {
namespace {

using results::CheckpointScore;

/// One score of one checkpoint.
struct WantedCheckpoint {
  std::size_t cell = 0;  ///< index into RunPlan::cells
  std::size_t checkpoint = 0;
  const metrics::MetricChoice* metric = nullptr;
  std::string against;
  ReferencePart truth;
  std::string viewing_hash;
};

/// What is missing, checkpoint by checkpoint.
class CheckpointPlan {
 public:
  CheckpointPlan(const ScoringInput& input, const std::vector<CheckpointScore>& known)
      : input_(input), plan_(input) {
    for (const CheckpointScore& one : known) {
      known_[{one.score.cell, one.checkpoint, one.score.against, one.score.metric}] = &one;
    }
  }

  const ScorePlan& references() const { return plan_; }

  std::vector<WantedCheckpoint> wanted() const {
    std::vector<WantedCheckpoint> all;
    if (!input_.suite.measure.has_convergence) return all;
    for (const std::size_t cell : input_.cells) {
      const bool is_still = input_.plan.cells[cell].frames.size() == 1;
      if (is_still && !input_.progress[cell].checkpoints().empty()) append(cell, all);
    }
    return all;
  }

 private:
  void append(std::size_t cell, std::vector<WantedCheckpoint>& all) const {
    const PlannedCell& planned = input_.plan.cells[cell];
    WantedCheckpoint one;
    one.cell = cell;
    one.viewing_hash = hash_of(viewing_of(input_.suite, *planned.frames.front().state)).hex();
    for (; one.checkpoint < input_.progress[cell].checkpoints().size(); ++one.checkpoint) {
      for (const SuiteMetric& metric : input_.suite.metrics) {
        one.metric = std::get_if<metrics::MetricChoice>(&metric.choice);
        if (one.metric == nullptr || !metric.is_of_whole_picture()) continue;
        if (!is_wanted(metric, *planned.scene, *planned.method)) continue;
        for (const std::string& against : metric.against) {
          one.against = against;
          one.truth = plan_.truths(cell, against).front();
          if (!is_known(one)) all.push_back(one);
        }
      }
    }
  }

  bool is_known(const WantedCheckpoint& one) const {
    const auto found =
        known_.find({input_.plan.cells[one.cell].name, static_cast<int>(one.checkpoint),
                     one.against, one.metric->text});
    if (found == known_.end()) return false;
    const results::MetricRecord& score = found->second->score;
    return score.reference_hash == plan_.reference_hash(one.truth.reference) &&
           score.reference_pixel_hash == plan_.reference_pixel_hash(one.truth.reference) &&
           score.version == one.metric->info->version && score.viewing_hash == one.viewing_hash;
  }

  const ScoringInput& input_;
  ScorePlan plan_;
  std::map<std::tuple<std::string, int, std::string, std::string>, const CheckpointScore*> known_;
};

/// An image that stays loaded while its scores are made.
struct LoadedImage {
  std::string path;
  perception::Image image;
  std::string pixel_hash;
};

const LoadedImage& loaded(const std::filesystem::path& path, LoadedImage& held) {
  if (held.path == path.string()) return held;
  held.image = perception::rgb_of(perception::read_image(path));
  held.pixel_hash = perception::pixel_hash(held.image);
  held.path = path.string();
  return held;
}

CheckpointScore made(const ScoringInput& input, const CheckpointPlan& plan,
                     const WantedCheckpoint& wanted, const LoadedImage& held,
                     const perception::Image& truth) {
  const PlannedCell& cell = input.plan.cells[wanted.cell];
  const results::Checkpoint& checkpoint =
      input.progress[wanted.cell].checkpoints()[wanted.checkpoint];
  const metrics::Score score =
      metrics::score(*wanted.metric, {truth, held.image},
                     viewing_of(input.suite, *cell.frames.front().state), {false, false});
  CheckpointScore record;
  record.checkpoint = static_cast<int>(wanted.checkpoint);
  record.samples = checkpoint.samples;
  record.elapsed_s = checkpoint.elapsed_s;
  results::MetricRecord& made = record.score;
  made.cell = cell.name;
  made.frame = cell.frames.front().frame;
  made.against = wanted.against;
  made.image_hash = held.pixel_hash;
  made.reference_hash = plan.references().reference_hash(wanted.truth.reference);
  made.reference_pixel_hash = plan.references().reference_pixel_hash(wanted.truth.reference);
  made.metric = wanted.metric->text;
  made.parameters = wanted.metric->parameters.entries();
  made.version = wanted.metric->info->version;
  made.viewing_hash = wanted.viewing_hash;
  set_score(score, made);
  return record;
}

}  // namespace

std::size_t missing_checkpoint_scores(const ScoringInput& input,
                                      const std::vector<CheckpointScore>& known) {
  return CheckpointPlan(input, known).wanted().size();
}

std::size_t score_checkpoints(const ScoringInput& input, const std::vector<CheckpointScore>& known,
                              results::RunFolder& folder, ProgressMeter& meter,
                              ScoringOutcome& outcome) {
  const CheckpointPlan plan(input, known);
  ScoreReferences references(input.plan, input.references);
  LoadedImage held;
  const std::vector<WantedCheckpoint> all = plan.wanted();
  for (const WantedCheckpoint& one : all) {
    if (interrupt_requested) throw Interrupted();
    const PlannedCell& cell = input.plan.cells[one.cell];
    const results::Checkpoint& checkpoint = input.progress[one.cell].checkpoints()[one.checkpoint];
    meter.begin_step(fmt::format("score {} {} checkpoint {} {}", cell.scene->id, cell.method->id,
                                 one.checkpoint, one.metric->text),
                     work_of_score(cell));
    try {
      const auto truth = references.get(one.truth);
      const LoadedImage& image = loaded(folder.path() / checkpoint.image, held);
      folder.append(made(input, plan, one, image, truth->image(one.truth.part)));
      ++outcome.scores;
    } catch (const base::InputError& error) {
      outcome.failures.push_back(fmt::format("{} checkpoint {} {} {}: {}", cell.name,
                                             one.checkpoint, one.metric->text, one.against,
                                             error.what()));
    }
    meter.finish_step();
  }
  return all.size();
}

}  // namespace suites
