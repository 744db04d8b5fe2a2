#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "perception/base/document.h"
#include "perception/base/units.h"
#include "results/run_record.h"

namespace suites {

/// First job of a worker: the scene and the method whose repetitions it will serve.
struct OpenJob {
  std::filesystem::path scene_file;
  std::vector<base::Node> scene_overlays;  ///< laid over the file in order; their places get lost
  int frame = 0;                           ///< the first one
  bool is_sequence = false;                ///< further frames follow the first
  base::SizePx size_px;
  std::string renderer;
  std::string preset;
  results::ParameterValues parameters;  ///< all of them
  int threads = 0;                      ///< 0: one per core
  std::string platform = "auto";
  int warmups = 1;
};

/// One frame: a cold start, or the frame after the one before it on the same renderer. A static
/// scene's repetition is one cold start; that of a sequence is a cold start, then its other frames.
struct RenderOrder {
  int repetition = 0;
  int frame = 0;
  bool is_cold = true;        ///< prepare; else update
  bool is_last = true;        ///< no frame follows
  bool has_new_view = false;  ///< measure new_view_s, too
  std::uint64_t seed = 1;
  std::optional<std::int64_t> samples;
  std::optional<double> time_s;
  results::ParameterValues settings;        ///< parameters with other values than the open job's
  std::filesystem::path image;              ///< target; the worker renames a temporary file to it
  std::filesystem::path checkpoint_folder;  ///< empty: none are kept
  /// Hash of the image that is scored: equal pixels are not written again.
  std::string known_pixel_hash;
};

/// Ends a worker; so does closing the channel.
struct CloseJob {};

using Job = std::variant<OpenJob, RenderOrder, CloseJob>;

/// The scene is loaded and the method warm.
struct Opened {
  double start_up_s = 0.0;
  std::string scene_hash;
};

/// A frame has ended, well or with a status that says how.
struct Rendered {
  results::RenderRecord record;  ///< `image`: the path as ordered; empty if none was written
  std::vector<results::Checkpoint> checkpoints;
};

/// The job could not be done: an unreadable scene, a job that is no job.
struct Refused {
  std::string reason;
};

/// The image could not be written: the results folder's fault, not the renderer's.
struct NotStored {
  std::string reason;
};

using Reply = std::variant<Opened, Rendered, Refused, NotStored>;

/// One JSON object on one line, without the line end.
std::string to_line(const Job& job);
std::string to_line(const Reply& reply);

/// @throws base::InputError naming what is missing or mistyped
Job job_from_line(const std::string& line);
Reply reply_from_line(const std::string& line);

}  // namespace suites
