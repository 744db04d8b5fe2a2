#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "perception/base/parameter_spec.h"
#include "renderers/contract/renderer.h"
#include "renderers/contract/stage_timer.h"

namespace results {

inline constexpr int kSchemaVersion = 1;

using ParameterValues = std::vector<std::pair<std::string, base::ParameterValue>>;

/// How a repetition ended. Failure is a record, never a missing row.
enum class Status {
  ok,
  cached,
  timeout,
  crash,
  out_of_memory,
  non_finite,
  diverged,
  unsupported,
  skipped
};
std::string to_string(Status status);
Status status_from_text(const std::string& text);  ///< @throws base::InputError
bool is_success(Status status);                    ///< ok or cached
bool is_failure(Status status);                    ///< neither a success, unsupported nor skipped

/// The fields of `discern render --json` (DESIGN section 7), in its order.
struct RenderRecord {
  Status status = Status::ok;
  std::optional<std::string> reason;
  std::string scene;
  std::string scene_hash;
  std::string renderer;
  std::string preset;
  ParameterValues parameters;  ///< all of them, resolved
  std::string transport;
  std::string part;
  std::optional<double> geometry_clamp;
  int width_px = 0;
  int height_px = 0;
  std::uint64_t seed = 1;
  int frame = 0;
  std::optional<std::int64_t> samples;
  std::string device = "cpu";
  std::optional<std::string> gl_platform;
  int threads = 1;
  /// wall(prepare) + wall(render) - readback - checkpoint sink; NaN for the following frames of a
  /// sequence.
  double total_s = 0.0;
  /// wall(update) + wall(render) - readback of a following frame of a sequence; else absent.
  std::optional<double> next_frame_s;
  /// wall of a further render with the camera turned a little, less its readback; never in total_s.
  std::optional<double> new_view_s;
  double prepare_s = 0.0;          ///< NaN for a following frame
  std::optional<double> update_s;  ///< wall(update) of a following frame
  double render_s = 0.0;
  double start_up_s = 0.0;
  double readback_s = 0.0;
  std::vector<renderers::StageRecord> stages;
  /// total_s (next_frame_s of a following frame) - sum of top-level stages, readback left out.
  double unattributed_s = 0.0;
  std::vector<std::pair<std::string, renderers::CounterValue>> counters;
  std::int64_t peak_memory_bytes = 0;
  std::size_t non_finite_pixels = 0;
  std::string pixel_hash;
  std::string image;  ///< path as written; in cells.jsonl relative to the run folder; "" if none
  std::vector<std::string> notes;
};

/// What the record's stages add up to: next_frame_s of a following frame of a sequence, else
/// total_s.
double timed_s(const RenderRecord& record);

/// @return {"schema":1,"status":...} with every field, non-finite numbers as null
nlohmann::ordered_json to_json(const RenderRecord& record);
/// @throws base::InputError naming the missing or mistyped field
RenderRecord render_record_from_json(const nlohmann::ordered_json& json);

struct Checkpoint {
  double elapsed_s = 0.0;  ///< total_s at this image
  std::int64_t samples = 0;
  std::string image;
};

/// One line of cells.jsonl: one repetition of one cell, of a sequence one frame of it.
struct CellRecord {
  std::string run;
  std::string cell;    ///< <scene>.<method>.<budget>.s<seed>-<8 hex>
  std::string scene;   ///< id in the suite
  std::string method;  ///< id in the suite, sweep values included: val[vals=30]
  std::string budget;
  std::string profile;
  int repetition = 0;
  std::string started_utc;
  std::string machine;
  /// Wall time of a fixed piece of work right before a repetition's first frame: tells a slower
  /// machine from a slower method. Absent for following frames.
  std::optional<double> canary_s;
  int jobs = 1;  ///< repetitions that ran at once, this one included
  RenderRecord render;
  std::vector<Checkpoint> checkpoints;
};
/// "scene" is written once: the suite's id, which takes the place of `render.scene`.
nlohmann::ordered_json to_json(const CellRecord& record);
CellRecord cell_record_from_json(const nlohmann::ordered_json& json);

/// One line of metrics.jsonl.
struct MetricRecord {
  std::string cell;
  int frame = 0;
  std::string against;  ///< own | full
  std::string image_hash;
  std::string reference_hash;  ///< of what the reference is an image of: its folder
  /// Of the reference's pixels when the score was made; samples may be added.
  std::string reference_pixel_hash;
  /// Of the images and references of other frames that the score depends on; "" if there are none.
  std::string context_hash;
  std::string metric;     ///< the choice as written in the suite, behind its id if it has one
  std::string id;         ///< of the suite's entry; "" if it has none
  std::string image;      ///< the AOV that was scored; "": the radiance
  std::string mask;       ///< pixels that took part; "": all
  std::string mask_hash;  ///< of a mask file; "" if there is none
  ParameterValues parameters;
  int version = 1;
  std::string viewing_hash;
  std::optional<double> value;  ///< absent: non-finite
  bool is_infinite = false;     ///< `value` is absent because it is +infinity: identical images
  std::vector<std::pair<std::string, double>> details;
  std::string map;  ///< path relative to the run folder, "" if none was kept
  /// Score of the reference against a perturbation by its own noise; errors below it are the
  /// reference's. Absent if it was not estimated.
  std::optional<double> noise_floor;
};
nlohmann::ordered_json to_json(const MetricRecord& record);
MetricRecord metric_record_from_json(const nlohmann::ordered_json& json);

/// One line of convergence.jsonl: a score of a checkpoint, an image on the way to the cell's own.
struct CheckpointScore {
  int checkpoint = 0;  ///< number within the cell, from 0
  std::int64_t samples = 0;
  double elapsed_s = 0.0;  ///< total_s at this image
  MetricRecord score;      ///< without map and noise floor
};
nlohmann::ordered_json to_json(const CheckpointScore& record);
CheckpointScore checkpoint_score_from_json(const nlohmann::ordered_json& json);

}  // namespace results
