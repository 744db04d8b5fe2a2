#pragma once

#include <compare>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "suites/scoring.h"

namespace suites {

/// What a score is against.
struct ReferencePart {
  std::size_t reference = 0;  ///< index into RunPlan::references
  renderers::Part part = renderers::Part::all;
  friend auto operator<=>(const ReferencePart&, const ReferencePart&) = default;
};

/// A score to make: one metric of one frame of a cell against one reference.
struct WantedScore {
  std::size_t frame = 0;  ///< position in the cell's frames
  const SuiteMetric* metric = nullptr;
  std::string against;  ///< own | full
  ReferencePart truth;
  std::string context_hash;  ///< as MetricRecord's
  std::string mask_hash;     ///< likewise
};

/// Which scores there are to make. Looks at hashes only: no image is read.
class ScorePlan {
 public:
  /// @param input  must outlive the plan
  explicit ScorePlan(const ScoringInput& input);

  /// The missing scores of a cell (index into RunPlan::cells), frame by frame, those of sequence
  /// metrics last.
  std::vector<WantedScore> wanted(std::size_t cell) const;

  /// What the frames of a cell are scored against, one per frame.
  std::vector<ReferencePart> truths(std::size_t cell, const std::string& against) const;

  const std::string& reference_hash(std::size_t reference) const { return hashes_[reference]; }
  /// Of the reference's pixels as they are now; "" if there is none.
  const std::string& reference_pixel_hash(std::size_t reference) const {
    return pixel_hashes_[reference];
  }

 private:
  /// What the plan knows of a metric of the suite.
  struct MetricFacts {
    std::size_t history = 0;         ///< frames before the scored one that the score depends on
    bool follows_reference = false;  ///< a sequence shares settings found from its references
    std::string mask_hash;           ///< of a mask file
  };
  bool has_images(std::size_t cell, std::size_t first, std::size_t last) const;
  /// What the frames of a cell are scored against.
  struct FrameTruths {
    std::vector<ReferencePart> parts;  ///< one per frame
    std::string hash;                  ///< of all of them; "" for a single frame
  };
  FrameTruths frame_truths(std::size_t cell, const std::string& against) const;
  /// Of the images and references of the frames first ... end - 1.
  std::string hash_of_history(std::size_t cell, std::size_t first, std::size_t end,
                              const std::vector<ReferencePart>& truths) const;
  std::string hash_of_all(const std::vector<ReferencePart>& truths) const;
  bool is_known(std::size_t cell, const WantedScore& wanted, const std::string& viewing_hash) const;

  const ScoringInput& input_;
  std::vector<MetricFacts> facts_;         ///< one per metric of the suite
  std::vector<std::string> hashes_;        ///< of the plan's references: what they are images of
  std::vector<std::string> pixel_hashes_;  ///< of their pixels now
  /// By cell, frame, against, metric.
  std::map<std::tuple<std::string, int, std::string, std::string>, const results::MetricRecord*>
      known_;
};

}  // namespace suites
