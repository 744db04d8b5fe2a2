#include "metrics/sequence_score.h"

#include <cassert>
#include <utility>

#include <fmt/format.h>

#include "metrics/finite_pixels.h"
#include "metrics/metric_input.h"
#include "metrics/score_pooling.h"
#include "perception/base/errors.h"

namespace metrics {
namespace {

void require_size(const Image& frame, const char* name, std::size_t index, const Image& first) {
  if (frame.has_size_of(first)) return;
  throw base::InputError(
      fmt::format("{} {} is {}x{} pixels, the first reference frame {}x{}; accepted: one size",
                  name, index, frame.width_px, frame.height_px, first.width_px, first.height_px));
}

void require_sequence(const SequencePair& pair) {
  if (pair.reference.size() != pair.test.size()) {
    throw base::InputError(
        fmt::format("{} reference frames and {} test frames; accepted: equal numbers",
                    pair.reference.size(), pair.test.size()));
  }
  for (std::size_t t = 0; t < pair.reference.size(); ++t) {
    require_size(pair.reference[t], "reference frame", t, pair.reference.front());
    require_size(pair.test[t], "test frame", t, pair.reference.front());
    assert(pair.reference[t].channel_count() == 3 && pair.test[t].channel_count() == 3);
  }
  if (pair.mask != nullptr && !pair.reference.empty()) {
    require_size(*pair.mask, "the mask of frame", 0, pair.reference.front());
  }
}

/// The frames begin ... begin + count - 1 of a span.
SequencePair part_of(const SequencePair& pair, std::size_t begin, std::size_t count) {
  return {pair.reference.subspan(begin, count), pair.test.subspan(begin, count),
          pair.frames_per_second, pair.mask};
}

/// The last frame of a span in which pixels are not finite, without these pixels.
Score score_others(const SequenceMetric& metric, const SequencePair& pair,
                   const ViewingConditions& viewing) {
  std::vector<Image> reference;
  std::vector<Image> test;
  Image mask;
  for (std::size_t t = 0; t < pair.reference.size(); ++t) {
    FinitePair finite = make_finite(pair.reference[t], pair.test[t], t == 0 ? pair.mask : &mask);
    reference.push_back(std::move(finite.reference));
    test.push_back(std::move(finite.test));
    mask = std::move(finite.mask);
  }
  if (pooled_pixel_count(mask, &mask) == 0) {
    throw base::InputError("no pixel is finite in all images; nothing is left to score");
  }
  return metric.evaluate({reference, test, pair.frames_per_second, &mask}, viewing).back();
}

/// The score of the last frame of a span as long as the metric needs.
Score score_last(const SequenceMetric& metric, const SequencePair& pair,
                 const ViewingConditions& viewing, const ScoreOptions& options) {
  const NonFinitePixels found = find_non_finite(pair.reference, pair.test, pair.mask);
  const auto evaluated = [&] {
    if (found.inside > 0 && !options.ignore_non_finite) {
      return not_a_number(found, pair.reference.front().width_px);
    }
    if (found.inside + found.outside > 0) return score_others(metric, pair, viewing);
    return metric.evaluate(pair, viewing).back();
  };
  Score score = evaluated();
  add_non_finite(found, score);
  return score;
}

/// The image without pixels that are not finite, as a mask; nothing if all of them take part.
std::optional<Image> finite_mask(const Image& rgb, const Image* mask) {
  const NonFinitePixels found = find_non_finite({&rgb, 1}, {}, mask);
  if (found.inside == 0) return std::nullopt;
  return make_finite(rgb, rgb, mask).mask;
}

}  // namespace

SharedChoice::SharedChoice(MetricChoice choice) : choice_(std::move(choice)) {
  if (choice_.info->sequence_settings == nullptr) return;
  settings_ = choice_.info->sequence_settings(choice_.parameters);
}

void SharedChoice::add(const Image& reference, const Image* mask) {
  assert(follows_reference());
  const InputImage rgb = rgb_input(reference);
  const std::optional<Image> finite = finite_mask(rgb.image(), mask);
  const Image* in_force = finite ? &*finite : mask;
  if (in_force != nullptr && pooled_pixel_count(*in_force, in_force) == 0) return;
  settings_->add(rgb.image(), in_force);
}

MetricChoice SharedChoice::choice() const {
  MetricChoice shared = choice_;
  if (settings_ != nullptr) shared.parameters = settings_->parameters();
  return shared;
}

std::vector<Score> score_sequence(const SequenceMetricChoice& choice, const SequencePair& pair,
                                  const ViewingConditions& viewing, const ScoreOptions& options) {
  require_sequence(pair);
  const std::unique_ptr<SequenceMetric> metric = choice.info->create(choice.parameters);
  const auto history = static_cast<std::size_t>(metric->history_frames());
  std::vector<Score> scores;
  if (pair.reference.size() <= history) return scores;
  const NonFinitePixels found = find_non_finite(pair.reference, pair.test, pair.mask);
  if (found.inside + found.outside == 0) {
    scores = metric->evaluate(pair, viewing);
  } else {
    for (std::size_t begin = 0; begin + history < pair.reference.size(); ++begin) {
      scores.push_back(score_last(*metric, part_of(pair, begin, history + 1), viewing, options));
    }
  }
  if (!options.with_map) {
    for (Score& score : scores) score.map.reset();
  }
  return scores;
}

}  // namespace metrics
