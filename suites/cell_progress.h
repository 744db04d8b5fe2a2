#pragma once

#include <map>
#include <string>
#include <vector>

#include "results/run_record.h"
#include "suites/suite_file.h"

namespace suites {

/// Where prepare takes longer a cell is repeated `min` times only (DESIGN section 3, clock).
inline constexpr double kLongPrepare_s = 10.0;

/// What is known of one cell: its repetitions so far, and whether it needs more.
class CellProgress {
 public:
  /// @param frame_count  frames of one repetition
  explicit CellProgress(std::size_t frame_count = 1) : frame_count_(frame_count) {}

  /// Takes in the record of a repetition, of a sequence that of one of its frames.
  void add(const results::CellRecord& record);

  /// At least `min`, at most `max` repetitions; between them until the 95 % interval of the median
  /// time, relative to it, is as narrow as asked, which takes kFewestForMedianInterval. The time of
  /// a repetition is its total_s, of a sequence the median next_frame_s of its frames. After `min`
  /// a cell stops where one repetition failed, or where prepare took over 10 s. After a timeout, a
  /// lack of memory or of a feature it stops at once: another try would cost as much and say the
  /// same.
  bool needs_more(const MeasurePlan& plan) const;

  /// The first repetition that is not finished: one that was interrupted starts anew.
  int next_repetition() const;
  /// Finished ones: all frames are there, or a frame failed.
  std::size_t repetitions() const;
  bool has_failed() const;   ///< a status other than ok, cached, unsupported, skipped
  bool was_skipped() const;  ///< unsupported or skipped

  /// The image of a frame that is scored: of the first repetition that made one; "" if there is
  /// none.
  const std::string& image(int frame) const;
  const std::string& pixel_hash(int frame) const;
  bool has_images() const { return !images_.empty(); }

  /// Those of the first repetition that kept some.
  const std::vector<results::Checkpoint>& checkpoints() const { return checkpoints_; }

  /// `device_text` of the first record that is a success; "" before. Times of other devices do not
  /// belong to the cell.
  const std::string& device() const { return device_; }

 private:
  struct Repetition {
    std::map<int, results::Status> frames;
    std::map<int, double> time_s;  ///< of its successes, by frame; a sequence's first has none
  };
  struct StoredImage {
    std::string image;
    std::string pixel_hash;
  };
  bool is_finished(const Repetition& repetition) const;
  std::vector<double> times_s() const;
  template <class Predicate>
  bool any_status(const Predicate& predicate) const;

  std::size_t frame_count_;
  std::map<int, Repetition> repetitions_;
  std::map<int, StoredImage> images_;
  std::vector<results::Checkpoint> checkpoints_;
  std::string device_;
  double longest_prepare_s_ = 0.0;
};

/// What made an image: "llvmpipe (osmesa)", "cpu".
std::string device_text(const results::RenderRecord& record);

/// Whether a sequence ends with a frame of this status: its renderer is gone, or cannot go on.
bool ends_sequence(results::Status status);

}  // namespace suites
