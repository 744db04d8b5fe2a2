#include "suites/command_line/diff_sequence.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "metrics/sequence_score.h"
#include "perception/base/errors.h"
#include "suites/command_line/frame_pattern.h"
#include "suites/suite_file.h"

namespace suites::command_line {

namespace {

using metrics::AnyMetricChoice;
using metrics::MetricChoice;
using metrics::SequenceMetricChoice;

/// The files that the command line names.
struct SequenceFiles {
  FramePattern reference;
  std::vector<FramePattern> tests;
  std::vector<int> frames;
};

void require_file(const std::string& file) {
  if (std::filesystem::exists(file)) return;
  throw base::InputError({file}, "no such file; --frames names it");
}

SequenceFiles sequence_files(const DiffArguments& arguments) {
  if (!arguments.at.empty()) {
    throw base::InputError({"--at"},
                           "tells a pixel of single images; accepted: without --frames, on the "
                           "files of one frame");
  }
  SequenceFiles files{
      {arguments.reference, {"reference"}}, {}, parse_frames(arguments.frames, {"--frames"})};
  for (const std::string& test : arguments.tests) files.tests.push_back({test, {"test"}});
  for (const int frame : files.frames) {
    require_file(files.reference.file(frame));
    for (const FramePattern& test : files.tests) require_file(test.file(frame));
  }
  return files;
}

void require_enough_frames(const std::vector<AnyMetricChoice>& choices, std::size_t frames) {
  for (const AnyMetricChoice& choice : choices) {
    if (frames >= frames_needed(choice)) continue;
    throw base::InputError({"--frames"},
                           fmt::format("{} frame; metric \"{}\" accepts {} or more", frames,
                                       text_of(choice), frames_needed(choice)));
  }
}

/// Counts a frame's non-finite pixels as those of its sequence.
void add_non_finite(const DiffImage& frame, int number, DiffImage& sequence) {
  if (frame.non_finite.pixels > 0 && sequence.non_finite.pixels == 0) {
    sequence.non_finite.first_x_px = frame.non_finite.first_x_px;
    sequence.non_finite.first_y_px = frame.non_finite.first_y_px;
    sequence.first_non_finite_frame = number;
  }
  sequence.non_finite.pixels += frame.non_finite.pixels;
}

/// Reads and scores the frames in order.
class SequenceScoring {
 public:
  SequenceScoring(const DiffArguments& arguments, const std::vector<AnyMetricChoice>& choices)
      : arguments_(arguments), choices_(choices), files_(sequence_files(arguments)) {
    require_enough_frames(choices, files_.frames.size());
    for (const AnyMetricChoice& choice : choices) {
      most_held_ = std::max(most_held_, frames_needed(choice));
    }
    DiffArguments first = arguments;
    first.reference = files_.reference.file(files_.frames.front());
    inputs_ = read_diff_inputs(first);
    inputs_.frames = files_.frames;
  }

  DiffOutcome run() {
    share_settings();
    start_results();
    for (const int frame : files_.frames) score_frame(frame);
    for (DiffResult& result : results_) {
      for (DiffScore& score : result.scores) {
        score.entry.score = summary_of(score.frames, description_of(*score.choice).better);
      }
    }
    inputs_.reference = std::move(reference_);
    return {std::move(inputs_), std::move(results_)};
  }

 private:
  /// Image metrics get the settings that all reference frames agree on.
  void share_settings() {
    std::vector<std::optional<metrics::SharedChoice>> shared;
    for (const AnyMetricChoice& choice : choices_) {
      const auto* of_image = std::get_if<MetricChoice>(&choice);
      shared.emplace_back();
      if (of_image != nullptr) shared.back().emplace(*of_image);
    }
    const auto follows = [](const auto& one) { return one && one->follows_reference(); };
    if (std::any_of(shared.begin(), shared.end(), follows)) {
      for (const int frame : files_.frames) {
        const DiffImage reference = read_test_image(files_.reference.file(frame), inputs_);
        for (auto& one : shared) {
          if (follows(one)) one->add(reference.image, mask());
        }
      }
    }
    for (std::size_t i = 0; i < choices_.size(); ++i) {
      in_force_.push_back(shared[i] ? AnyMetricChoice(shared[i]->choice()) : choices_[i]);
    }
  }

  void start_results() {
    reference_.path = files_.reference.text();
    test_windows_.resize(files_.tests.size());
    for (const FramePattern& test : files_.tests) {
      DiffResult result;
      result.test.path = test.text();
      for (std::size_t i = 0; i < choices_.size(); ++i) {
        result.scores.push_back({&choices_[i], parameters_of(in_force_[i]), {}, {}});
      }
      results_.push_back(std::move(result));
    }
  }

  void score_frame(int frame) {
    inputs_.reference = read_test_image(files_.reference.file(frame), inputs_);
    add_non_finite(inputs_.reference, frame, reference_);
    push(reference_window_, inputs_.reference.image);
    std::vector<std::string> names;
    for (const FramePattern& test : files_.tests) names.push_back(test.file(frame));
    const std::vector<std::string> stems = map_stems(names);
    for (std::size_t i = 0; i < names.size(); ++i) {
      DiffImage test = read_test_image(names[i], inputs_);
      add_non_finite(test, frame, results_[i].test);
      if (results_[i].test.notes.empty()) results_[i].test.notes = test.notes;
      push(test_windows_[i], test.image);
      for (std::size_t k = 0; k < choices_.size(); ++k) {
        std::optional<metrics::Score> score = frame_score(k, test, test_windows_[i]);
        if (!score) continue;
        DiffFrame entry{frame, {std::move(*score), "", ""}};
        if (!arguments_.map_folder.empty()) {
          write_map(inputs_, test, {arguments_.map_folder, stems[i]}, choices_[k], entry.entry);
        }
        entry.entry.score.map.reset();
        results_[i].scores[k].frames.push_back(std::move(entry));
      }
    }
  }

  /// The score of a metric on the frame that was read last; nothing for a sequence metric that
  /// needs more frames before it.
  std::optional<metrics::Score> frame_score(std::size_t metric, const DiffImage& test,
                                            std::span<const perception::Image> window) const {
    const metrics::ScoreOptions options{arguments_.ignore_non_finite,
                                        !arguments_.map_folder.empty()};
    if (const auto* of_image = std::get_if<MetricChoice>(&in_force_[metric])) {
      return score_image(*of_image, inputs_, test, options);
    }
    const std::size_t needed = frames_needed(in_force_[metric]);
    if (window.size() < needed) return std::nullopt;
    const metrics::SequencePair pair{.reference = std::span(reference_window_).last(needed),
                                     .test = window.last(needed),
                                     .mask = mask()};
    return metrics::score_sequence(std::get<SequenceMetricChoice>(in_force_[metric]), pair,
                                   inputs_.viewing, options)
        .back();
  }

  const perception::Image* mask() const { return inputs_.mask ? &*inputs_.mask : nullptr; }

  void push(std::vector<perception::Image>& window, const perception::Image& image) const {
    if (window.size() == most_held_) window.erase(window.begin());
    window.push_back(image);
  }

  const DiffArguments& arguments_;
  const std::vector<AnyMetricChoice>& choices_;
  SequenceFiles files_;
  std::size_t most_held_ = 1;  ///< frames that some metric looks at together
  DiffInputs inputs_;          ///< its reference is the frame that was read last
  std::vector<AnyMetricChoice> in_force_;
  DiffImage reference_;  ///< what is told of the sequence
  std::vector<DiffResult> results_;
  std::vector<perception::Image> reference_window_;
  std::vector<std::vector<perception::Image>> test_windows_;  ///< one per test
};

}  // namespace

DiffOutcome diff_sequences(const DiffArguments& arguments,
                           const std::vector<AnyMetricChoice>& choices) {
  return SequenceScoring(arguments, choices).run();
}

}  // namespace suites::command_line
