#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "metrics/metric_list.h"
#include "suites/command_line/diff_inputs.h"

namespace suites::command_line {

/// A score of one image, with the files of its map.
struct MappedScore {
  metrics::Score score;
  std::string map;          ///< path of the EXR, "" if none was written
  std::string map_picture;  ///< path of the false-colour PNG
};

/// A score of one frame of a sequence.
struct DiffFrame {
  int frame = 0;
  MappedScore entry;
};

/// One metric of one test image, or of a test sequence.
struct DiffScore {
  const metrics::AnyMetricChoice* choice = nullptr;
  base::Parameters parameters;  ///< those in force: the frames of a sequence may share some
  MappedScore entry;            ///< of a sequence the summary of its frames, without a map
  std::vector<DiffFrame> frames;
};

/// All metrics of one test.
struct DiffResult {
  DiffImage test;
  std::vector<DiffScore> scores;
  std::vector<std::string> violated_gates;  ///< "flip=0.1"
};

/// What a `diff` compared, and what came out for each test.
struct DiffOutcome {
  DiffInputs inputs;
  std::vector<DiffResult> results;
};

metrics::Score score_image(const metrics::MetricChoice& choice, const DiffInputs& inputs,
                           const DiffImage& test, const metrics::ScoreOptions& options);

/// Names of the tests' maps: the files' stems, with a number where two agree.
std::vector<std::string> map_stems(const std::vector<std::string>& tests);

/// Where the maps of one image go.
struct MapFiles {
  std::filesystem::path folder;
  std::string stem;  ///< of the files' names
};

/// Writes a score's map as EXR and as a picture; nothing if it has none.
void write_map(const DiffInputs& inputs, const DiffImage& test, const MapFiles& files,
               const metrics::AnyMetricChoice& choice, MappedScore& entry);

/// The score of a sequence: the mean over its frames (NaN if a frame has none, infinite only if
/// every frame is), as details the `worst` one, its number `worst_frame` and `p95`, what 95 % of
/// the frames are at least as good as; non-finite pixels of all frames.
/// @param frames  at least one
metrics::Score summary_of(const std::vector<DiffFrame>& frames, metrics::Better better);

}  // namespace suites::command_line
