#include "suites/scoring.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <tuple>

#include "metrics/sequence_score.h"
#include "suites/score_images.h"
#include "suites/score_plan.h"
#include "suites/score_references.h"
#include "suites/score_writer.h"
#include "suites/sequence_scoring.h"

namespace suites {
namespace {

/// Scores image by image.
class ImageScorer {
 public:
  ImageScorer(const ScoringInput& input, const ScorePlan& plan, ScoreReferences& references,
              ScoreWriter& writer)
      : input_(input), plan_(plan), references_(references), writer_(writer) {}

  /// @param all  of image metrics on one frame of the cell
  void score_frame(std::size_t cell, std::span<const WantedScore> all);

 private:
  const metrics::MetricChoice& choice_in_force(std::size_t cell, const WantedScore& wanted);
  MadeScore made(std::size_t cell, const WantedScore& wanted,
                 const std::vector<perception::NamedImage>& picture);
  std::optional<double> noise_floor(const metrics::MetricChoice& choice, const WantedScore& wanted,
                                    const Reference& reference,
                                    const perception::ViewingConditions& viewing,
                                    const perception::Image* mask);

  const ScoringInput& input_;
  const ScorePlan& plan_;
  ScoreReferences& references_;
  ScoreWriter& writer_;
  /// Choices of sequences by text and hash of the references.
  std::map<std::pair<std::string, std::string>, metrics::MetricChoice> shared_;
  /// By reference, metric, its parameters.
  std::map<std::tuple<std::size_t, std::string, std::string>, std::optional<double>> noise_floors_;
};

/// The suite's choice; where a metric follows the reference, what the references of all frames of
/// the sequence agree on, so that its scores can be compared from frame to frame.
const metrics::MetricChoice& ImageScorer::choice_in_force(std::size_t cell,
                                                          const WantedScore& wanted) {
  const auto& choice = std::get<metrics::MetricChoice>(wanted.metric->choice);
  if (wanted.context_hash.empty()) return choice;
  const auto key = std::make_pair(choice.text, wanted.context_hash);
  const auto found = shared_.find(key);
  if (found != shared_.end()) return found->second;
  metrics::SharedChoice shared(choice);
  const std::vector<ReferencePart> truths = plan_.truths(cell, wanted.against);
  for (const ReferencePart& truth : std::set(truths.begin(), truths.end())) {
    const auto reference = references_.find(truth.reference);
    if (reference == nullptr || reference->image(truth.part).is_empty()) continue;
    const std::optional<perception::Image> mask = mask_image(*wanted.metric, *reference);
    shared.add(seen_reference(*wanted.metric, *reference, truth.part), mask ? &*mask : nullptr);
  }
  return shared_.emplace(key, shared.choice()).first->second;
}

std::optional<double> ImageScorer::noise_floor(const metrics::MetricChoice& choice,
                                               const WantedScore& wanted,
                                               const Reference& reference,
                                               const perception::ViewingConditions& viewing,
                                               const perception::Image* mask) {
  // The variance is that of the radiance.
  if (!wanted.metric->image.empty()) return std::nullopt;
  if (!has_variance(reference, wanted.truth.part)) return std::nullopt;
  const auto key =
      std::make_tuple(wanted.truth.reference, choice.text, choice.parameters.to_text());
  const auto found = noise_floors_.find(key);
  if (found != noise_floors_.end()) return found->second;
  return noise_floors_[key] =
             suites::noise_floor(reference, wanted.truth.part, choice, viewing, mask);
}

MadeScore ImageScorer::made(std::size_t cell, const WantedScore& wanted,
                            const std::vector<perception::NamedImage>& picture) {
  const perception::ViewingConditions viewing =
      viewing_of(input_.suite, *input_.plan.cells[cell].frames.front().state);
  const auto truth = references_.get(wanted.truth);
  const metrics::MetricChoice& choice = choice_in_force(cell, wanted);
  const bool is_of_radiance = wanted.metric->image.empty();
  const perception::Image* variance =
      is_of_radiance && has_variance(*truth, wanted.truth.part) ? &truth->variance : nullptr;
  const perception::Image reference = seen_reference(*wanted.metric, *truth, wanted.truth.part);
  const perception::Image test = seen_picture(*wanted.metric, picture);
  const std::optional<perception::Image> mask = mask_image(*wanted.metric, *truth);
  MadeScore made;
  made.score = metrics::score(choice, {reference, test, variance, mask ? &*mask : nullptr}, viewing,
                              {false, writer_.keeps_map(cell, wanted)});
  made.parameters = choice.parameters;
  made.noise_floor = noise_floor(choice, wanted, *truth, viewing, mask ? &*mask : nullptr);
  return made;
}

void ImageScorer::score_frame(std::size_t cell, std::span<const WantedScore> all) {
  std::vector<perception::NamedImage> picture;
  const bool with_aovs = std::any_of(
      all.begin(), all.end(), [](const WantedScore& one) { return !one.metric->image.empty(); });
  try {
    picture = writer_.timed_picture(cell, all.front().frame, with_aovs);
  } catch (const base::InputError& error) {
    writer_.fail_image(cell, all.size(), error.what());
    return;
  }
  // A method that claims full transport has one reference: scored once, recorded twice.
  std::map<std::tuple<std::string, ReferencePart, std::string>, results::MetricRecord> done;
  for (const WantedScore& one : all) {
    writer_.begin(cell, one);
    try {
      const auto key = std::make_tuple(text_of(*one.metric), one.truth, one.context_hash);
      auto found = done.find(key);
      if (found == done.end()) {
        found = done.emplace(key, writer_.record(cell, one, made(cell, one, picture))).first;
      }
      writer_.append(one, found->second);
    } catch (const base::InputError& error) {
      writer_.fail(cell, one, error.what());
    }
  }
}

/// Pieces of a list in which `is_same(first, other)` holds.
template <typename Same, typename Use>
void for_each_group(std::span<const WantedScore> all, const Same& is_same, const Use& use) {
  while (!all.empty()) {
    const auto end = std::find_if_not(
        all.begin(), all.end(), [&](const WantedScore& one) { return is_same(all.front(), one); });
    const auto count = static_cast<std::size_t>(end - all.begin());
    use(all.first(count));
    all = all.subspan(count);
  }
}

}  // namespace

perception::ViewingConditions viewing_of(const Suite& suite, const renderers::scene::Scene& scene) {
  perception::ViewingConditions viewing = suite.viewing;
  if (suite.exposure_from_scene) viewing.exposure_ev = 0.0;
  if (viewing.luminance_scale_origin == "suite") return viewing;
  viewing.luminance_scale_cd_m2 = scene.luminance_scale_cd_m2;
  viewing.luminance_scale_origin = "scene";
  return viewing;
}

std::size_t score_count(const Suite& suite, const PlannedCell& cell) {
  std::size_t count = 0;
  for (const SuiteMetric& metric : suite.metrics) {
    if (!is_wanted(metric, *cell.scene, *cell.method)) continue;
    const std::size_t history = frames_needed(metric.choice) - 1;
    if (cell.frames.size() > history) {
      count += metric.against.size() * (cell.frames.size() - history);
    }
  }
  return count;
}

std::vector<std::size_t> missing_scores(const ScoringInput& input) {
  const ScorePlan plan(input);
  std::vector<std::size_t> counts;
  for (const std::size_t index : input.cells) counts.push_back(plan.wanted(index).size());
  return counts;
}

ScoringOutcome score_cells(const ScoringInput& input, results::RunFolder& folder,
                           ProgressMeter& meter) {
  ScoringOutcome outcome;
  const ScorePlan plan(input);
  ScoreReferences references(input.plan, input.references);
  ScoreWriter writer(input, plan, folder, meter, outcome);
  ImageScorer images(input, plan, references, writer);
  SequenceScorer sequences(input, plan, references, writer);
  for (const std::size_t cell : input.cells) {
    const std::vector<WantedScore> all = plan.wanted(cell);
    const auto is_of_image = [](const WantedScore& one) {
      return std::holds_alternative<metrics::MetricChoice>(one.metric->choice);
    };
    const auto middle = std::find_if_not(all.begin(), all.end(), is_of_image);
    const auto is_same_frame = [](const auto& a, const auto& b) { return a.frame == b.frame; };
    for_each_group({all.begin(), middle}, is_same_frame,
                   [&](std::span<const WantedScore> group) { images.score_frame(cell, group); });
    sequences.score_cell(cell, {middle, all.end()});
  }
  return outcome;
}

}  // namespace suites
