#pragma once

#include <memory>
#include <vector>

#include "metrics/metric_list.h"

namespace metrics {

/// One choice for all frames of a sequence. What a metric would choose anew from each reference
/// image is found from all of them and written into the parameters; the text stays.
class SharedChoice {
 public:
  explicit SharedChoice(MetricChoice choice);

  /// False: the choice is the same for every image anyway, no reference needs to be shown.
  bool follows_reference() const { return settings_ != nullptr; }
  /// Shows a reference frame; its non-finite pixels have no say.
  /// @param mask  as `ImagePair::mask`
  void add(const Image& reference, const Image* mask);
  /// What the frames shown so far share.
  MetricChoice choice() const;

 private:
  MetricChoice choice_;
  std::unique_ptr<SequenceSettings> settings_;
};

/// Scores a span of frames with everything that holds for all metrics: numbers of frames and sizes
/// must agree; a non-finite pixel in a frame, or in one that its score depends on, makes the value
/// NaN (or is left out on request) and is counted.
/// @param pair  R, G, B
/// @return one score per frame from the metric's `history_frames()` on
/// @throws base::InputError naming the frame
std::vector<Score> score_sequence(const SequenceMetricChoice& choice, const SequencePair& pair,
                                  const ViewingConditions& viewing,
                                  const ScoreOptions& options = {});

}  // namespace metrics
