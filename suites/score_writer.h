#pragma once

#include <optional>
#include <string>
#include <vector>

#include "perception/image_file.h"
#include "suites/score_plan.h"

namespace suites {

/// A score as it was made.
struct MadeScore {
  metrics::Score score;
  base::Parameters parameters;  ///< those in force
  std::optional<double> noise_floor;
};

/// Value and details of a score as the record has them; a value that is not finite is absent.
void set_score(const metrics::Score& score, results::MetricRecord& record);

/// Turns scores into records of a run, maps included, and tells the progress display.
class ScoreWriter {
 public:
  /// @param all  must outlive this object
  ScoreWriter(const ScoringInput& input, const ScorePlan& plan, results::RunFolder& folder,
              ProgressMeter& meter, ScoringOutcome& outcome);

  /// The stored picture of a frame, with the proof that it is the one that was timed: its radiance,
  /// R, G, B, and behind it its AOVs where they are asked for.
  /// @throws base::InputError if it cannot be read, or is another one
  std::vector<perception::NamedImage> timed_picture(std::size_t cell, std::size_t frame,
                                                    bool with_aovs) const;
  /// True if the map of this score is kept: of seed 1, of the first frame that has a score, or of
  /// all where the metric says so.
  bool keeps_map(std::size_t cell, const WantedScore& wanted) const;

  /// @throws Interrupted
  void begin(std::size_t cell, const WantedScore& wanted);
  /// The record, its map written where it is kept.
  results::MetricRecord record(std::size_t cell, const WantedScore& wanted,
                               const MadeScore& made) const;
  /// Appends a record, which may have been made for the same reference under another `against`.
  void append(const WantedScore& wanted, results::MetricRecord record);
  /// Notes why there is no score.
  void fail(std::size_t cell, const WantedScore& wanted, const std::string& reason);
  /// Notes why an image has none of its scores.
  void fail_image(std::size_t cell, std::size_t scores, const std::string& reason);

 private:
  std::string frame_name(std::size_t cell, const WantedScore& wanted) const;
  std::string kept_map(std::size_t cell, const WantedScore& wanted,
                       const perception::Image& map) const;

  const ScoringInput& input_;
  const ScorePlan& plan_;
  results::RunFolder& folder_;
  ProgressMeter& meter_;
  ScoringOutcome& outcome_;
};

}  // namespace suites
