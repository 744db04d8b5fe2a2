#include "suites/sequence_scoring.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "metrics/sequence_score.h"
#include "suites/score_images.h"

namespace suites {
namespace {

/// Seed of the noise of the reference of frame 0; every other reference has noise of its own, as
/// references rendered one by one have.
constexpr std::uint64_t kFirstNoiseSeed = 1;

/// Frames that one span judges: as many as it needs before them, so that at most half of its frames
/// are looked at twice.
std::size_t judged_frames(std::size_t history) { return std::max<std::size_t>(1, history); }

}  // namespace

/// The frames of a cell and of its references that are held, a few in a row.
class SequenceScorer::Window {
 public:
  Window(std::size_t cell, const SuiteMetric& metric, std::vector<ReferencePart> truths,
         ScoreReferences& references, const ScoreWriter& writer)
      : cell_(cell),
        metric_(metric),
        truths_(std::move(truths)),
        references_(references),
        writer_(writer) {}

  /// The frames first ... last, of which those that are held are not loaded again.
  /// @param first  never before that of an earlier call
  metrics::SequencePair frames(std::size_t first, std::size_t last) {
    while (!test_.empty() && first_ < first) {
      reference_.erase(reference_.begin());
      test_.erase(test_.begin());
      ++first_;
    }
    if (test_.empty()) first_ = first;
    while (first_ + test_.size() <= last) {
      const std::size_t frame = first_ + test_.size();
      perception::Image image =
          seen_picture(metric_, writer_.timed_picture(cell_, frame, !metric_.image.empty()));
      const ReferencePart& truth = truths_[frame];
      const auto reference = references_.get(truth);
      if (!mask_) mask_ = mask_image(metric_, *reference);
      reference_.push_back(perception::rgb_of(seen_reference(metric_, *reference, truth.part)));
      test_.push_back(std::move(image));
    }
    metrics::SequencePair pair{reference_, test_};
    if (mask_) pair.mask = &*mask_;
    return pair;
  }

  std::span<const ReferencePart> truths(std::size_t first, std::size_t last) const {
    return std::span(truths_).subspan(first, last - first + 1);
  }

 private:
  std::size_t cell_;
  const SuiteMetric& metric_;
  std::vector<ReferencePart> truths_;  ///< one per frame of the cell
  ScoreReferences& references_;
  const ScoreWriter& writer_;
  std::size_t first_ = 0;
  std::vector<perception::Image> reference_;
  std::vector<perception::Image> test_;
  std::optional<perception::Image> mask_;  ///< for every frame
};

std::optional<double> SequenceScorer::noise_floor(const SuiteMetric& metric,
                                                  std::span<const ReferencePart> truths,
                                                  const perception::ViewingConditions& viewing) {
  // The variance is that of the radiance.
  if (!metric.image.empty()) return std::nullopt;
  const auto& choice = std::get<metrics::SequenceMetricChoice>(metric.choice);
  const auto key = std::make_pair(choice.text, std::vector(truths.begin(), truths.end()));
  const auto found = noise_floors_.find(key);
  if (found != noise_floors_.end()) return found->second;
  std::optional<double>& floor = noise_floors_[key];
  std::vector<perception::Image> clean;
  std::vector<perception::Image> noisy;
  std::optional<perception::Image> mask;
  for (const ReferencePart& truth : truths) {
    const auto reference = references_.get(truth);
    if (!has_variance(*reference, truth.part)) return floor;
    if (!mask) mask = mask_image(metric, *reference);
    const int frame = input_.plan.references[truth.reference].frame;
    clean.push_back(perception::rgb_of(reference->all));
    noisy.push_back(perception::rgb_of(
        perturbed(*reference, kFirstNoiseSeed + static_cast<std::uint64_t>(frame))));
  }
  metrics::SequencePair pair{clean, noisy};
  if (mask) pair.mask = &*mask;
  const std::vector<metrics::Score> scores =
      metrics::score_sequence(choice, pair, viewing, {false, false});
  if (std::isfinite(scores.back().value)) floor = scores.back().value;
  return floor;
}

void SequenceScorer::score_span(std::size_t cell, std::span<const WantedScore> wanted,
                                Window& window, Records& records) {
  const SuiteMetric& metric = *wanted.front().metric;
  const auto& choice = std::get<metrics::SequenceMetricChoice>(metric.choice);
  const std::size_t history = frames_needed(metric.choice) - 1;
  const std::size_t first = wanted.front().frame - history;
  const perception::ViewingConditions viewing =
      viewing_of(input_.suite, *input_.plan.cells[cell].frames.front().state);
  const bool with_map = std::any_of(wanted.begin(), wanted.end(), [&](const WantedScore& one) {
    return writer_.keeps_map(cell, one);
  });
  std::vector<metrics::Score> scores = metrics::score_sequence(
      choice, window.frames(first, wanted.back().frame), viewing, {false, with_map});
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::size_t frame = wanted[i].frame;
    MadeScore made{std::move(scores[i]), choice.parameters, std::nullopt};
    made.noise_floor = noise_floor(metric, window.truths(frame - history, frame), viewing);
    records.emplace(frame, writer_.record(cell, wanted[i], made));
  }
}

void SequenceScorer::score_frames(std::size_t cell, std::span<const WantedScore> wanted,
                                  Records& known) {
  const SuiteMetric& metric = *wanted.front().metric;
  Window window(cell, metric, plan_.truths(cell, wanted.front().against), references_, writer_);
  const std::size_t judged = judged_frames(frames_needed(metric.choice) - 1);
  while (!wanted.empty()) {
    // Frames right after each other that are not scored yet, or one that is.
    std::size_t count = 1;
    const bool is_known = known.contains(wanted.front().frame);
    while (!is_known && count < std::min(judged, wanted.size()) &&
           wanted[count].frame == wanted[count - 1].frame + 1 &&
           !known.contains(wanted[count].frame)) {
      ++count;
    }
    const std::span<const WantedScore> span = wanted.first(count);
    std::optional<std::string> reason;
    writer_.begin(cell, span.front());
    try {
      if (!is_known) score_span(cell, span, window, known);
    } catch (const base::InputError& error) {
      reason = error.what();
    }
    for (const WantedScore& one : span) {
      writer_.begin(cell, one);
      if (reason) writer_.fail(cell, one, *reason);
      if (!reason) writer_.append(one, known.at(one.frame));
    }
    wanted = wanted.subspan(count);
  }
}

void SequenceScorer::score_cell(std::size_t cell, std::span<const WantedScore> all) {
  if (all.empty()) return;
  const bool has_one_truth = plan_.truths(cell, "own") == plan_.truths(cell, "full");
  for (const SuiteMetric& metric : input_.suite.metrics) {
    Records known;
    for (const char* against : {"own", "full"}) {
      std::vector<WantedScore> wanted;
      std::copy_if(all.begin(), all.end(), std::back_inserter(wanted), [&](const WantedScore& one) {
        return one.metric == &metric && one.against == against;
      });
      // A method that claims full transport is scored once and recorded twice.
      if (!has_one_truth) known.clear();
      if (!wanted.empty()) score_frames(cell, wanted, known);
    }
  }
}

}  // namespace suites
