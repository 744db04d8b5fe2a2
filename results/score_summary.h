#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "metrics/metric.h"
#include "results/run_record.h"
#include "results/statistics.h"

namespace results {

/// The score of one frame of a sequence.
struct FrameScore {
  int frame = 0;
  double value = 0.0;  ///< mean over seeds; NaN and infinity as they come
};

/// One metric of one row: mean over seeds. Of a sequence a seed's score is the median over its
/// frames, that of a sequence metric the mean over them (metrics/metric.h).
struct ScoreSummary {
  std::string metric;                 ///< the choice as written in the suite
  std::string against;                ///< own | full
  bool is_wanted = true;              ///< false: the suite restricts the metric to other rows
  std::optional<Estimate> score;      ///< of the finite scores; absent: there is none (yet)
  std::size_t perfect = 0;            ///< seeds of infinite score: identical to the reference
  std::size_t non_finite = 0;         ///< seeds whose score is no number, finite or infinite
  std::optional<double> noise_floor;  ///< mean over seeds
  /// The floor's part of the error, error being the distance from the score of identical images.
  std::optional<double> noise_share;
  bool has_reference_noise = false;  ///< a good part of the error is noise of the reference
  std::vector<FrameScore> frames;    ///< of a sequence, by frame; else empty
  std::optional<FrameScore> worst;   ///< of them, the frame of the worst finite score

  /// The mean of the finite scores; infinity if there are infinite ones only.
  std::optional<double> value() const;
  std::size_t seeds() const;  ///< seeds that `value` is of
};

/// The scores of a run by cell.
using ScoresOfCell = std::map<std::string, std::vector<const MetricRecord*>>;

/// @param cells  those of one (scene, method, budget): its seeds
ScoreSummary summarize_scores(const ScoresOfCell& scores, const std::set<std::string>& cells,
                              const std::string& metric, const std::string& against);

/// What the metric's entry says, by the text of a suite ("flip", "relmse,trim=0.001", "flicker",
/// with an id "edges:relmse"); null if this build does not know it.
const metrics::MetricDescription* metric_info_of(const std::string& metric);
/// "edges" of "edges:relmse"; "" of a text without an id.
std::string metric_id_of(const std::string& metric);
/// Whether it scores sequences only; false if this build does not know it.
bool is_sequence_metric(const std::string& metric);

}  // namespace results
