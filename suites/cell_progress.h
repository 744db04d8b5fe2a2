#pragma once

#include <string>
#include <vector>

#include "results/run_record.h"
#include "suites/suite_file.h"

namespace suites {

/// What is known of one cell: its repetitions so far, and whether it needs more.
class CellProgress {
 public:
  void add(const results::CellRecord& record);

  /// At least `min`, at most `max` repetitions; between them until the 95 % interval of the median
  /// total_s, relative to it, is as narrow as asked, which takes three. After `min` a cell stops
  /// where one repetition failed, or where prepare took over 10 s. After a timeout, a lack of
  /// memory or of a feature it stops at once: another try would cost as much and say the same.
  bool needs_more(const MeasurePlan& plan) const;

  int next_repetition() const { return next_repetition_; }
  std::size_t repetitions() const { return statuses_.size(); }
  bool has_failed() const;   ///< a status other than ok, cached, unsupported, skipped
  bool was_skipped() const;  ///< unsupported or skipped

  /// The image that is scored: of the first repetition that made one; "" if there is none.
  const std::string& image() const { return image_; }
  const std::string& pixel_hash() const { return pixel_hash_; }
  int frame() const { return frame_; }

 private:
  std::vector<results::Status> statuses_;
  std::vector<double> total_s_;  ///< of successful repetitions
  double longest_prepare_s_ = 0.0;
  int next_repetition_ = 0;
  int frame_ = 0;
  std::string image_;
  std::string pixel_hash_;
};

}  // namespace suites
