#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "suites/score_plan.h"
#include "suites/score_references.h"
#include "suites/score_writer.h"

namespace suites {

/// Scores what changes from frame to frame, in spans of a few frames, so that memory is bounded
/// whatever the length of the sequence.
class SequenceScorer {
 public:
  /// All parameters must outlive this object.
  SequenceScorer(const ScoringInput& input, const ScorePlan& plan, ScoreReferences& references,
                 ScoreWriter& writer)
      : input_(input), plan_(plan), references_(references), writer_(writer) {}

  /// @param all  of sequence metrics on the cell, by frame
  void score_cell(std::size_t cell, std::span<const WantedScore> all);

 private:
  class Window;
  using Records = std::map<std::size_t, results::MetricRecord>;  ///< by position of the frame

  /// @param wanted  of one metric against one kind of reference, frames right after each other
  /// @param records  those made are added
  void score_span(std::size_t cell, std::span<const WantedScore> wanted, Window& window,
                  Records& records);
  /// @param known  records of the same references, made under another `against`
  void score_frames(std::size_t cell, std::span<const WantedScore> wanted, Records& known);
  std::optional<double> noise_floor(const SuiteMetric& metric,
                                    std::span<const ReferencePart> truths,
                                    const perception::ViewingConditions& viewing);

  const ScoringInput& input_;
  const ScorePlan& plan_;
  ScoreReferences& references_;
  ScoreWriter& writer_;
  /// By metric and the references that the score depends on.
  std::map<std::pair<std::string, std::vector<ReferencePart>>, std::optional<double>> noise_floors_;
};

}  // namespace suites
