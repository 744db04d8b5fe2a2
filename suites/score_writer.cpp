#include "suites/score_writer.h"

#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "suites/planned_work.h"
#include "suites/suite_runner.h"

namespace suites {

namespace fs = std::filesystem;

namespace {

/// Text as part of a file name: "relmse,trim=0.001" -> "relmse-trim-0.001".
std::string file_name_of(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool is_kept =
        (std::isalnum(static_cast<unsigned char>(c)) != 0) || c == '.' || c == '_' || c == '-';
    name += is_kept ? c : '-';
  }
  return name;
}

/// Of the frames that have a score.
bool is_first_frame(const WantedScore& wanted) {
  return wanted.frame + 1 == frames_needed(wanted.metric->choice);
}

/// Of a frame besides the first: "flip.own.frame-7.exr".
std::string map_name(const WantedScore& wanted, int frame) {
  std::string name = fmt::format("{}.{}", file_name_of(text_of(*wanted.metric)), wanted.against);
  if (!is_first_frame(wanted)) name += fmt::format(".frame-{}", frame);
  return name + ".exr";
}

}  // namespace

void set_score(const metrics::Score& score, results::MetricRecord& record) {
  if (std::isfinite(score.value)) record.value = score.value;
  record.is_infinite = std::isinf(score.value) && score.value > 0.0;
  for (const metrics::NamedValue& detail : score.details) {
    record.details.emplace_back(detail.name, detail.value);
  }
}

ScoreWriter::ScoreWriter(const ScoringInput& input, const ScorePlan& plan,
                         results::RunFolder& folder, ProgressMeter& meter, ScoringOutcome& outcome)
    : input_(input), plan_(plan), folder_(folder), meter_(meter), outcome_(outcome) {}

std::vector<perception::NamedImage> ScoreWriter::timed_picture(std::size_t cell, std::size_t frame,
                                                               bool with_aovs) const {
  const int number = input_.plan.cells[cell].frames[frame].frame;
  const fs::path path = folder_.path() / input_.progress[cell].image(number);
  std::vector<perception::NamedImage> parts;
  if (with_aovs) {
    parts = perception::read_image_file(path).parts;
  } else {
    parts.push_back({"radiance", perception::read_image(path)});
  }
  parts.front().image = perception::rgb_of(parts.front().image);
  if (perception::pixel_hash(parts.front().image) == input_.progress[cell].pixel_hash(number)) {
    return parts;
  }
  throw base::InputError(path.string() +
                         ": is not the image that was timed; its pixels were changed since");
}

bool ScoreWriter::keeps_map(std::size_t cell, const WantedScore& wanted) const {
  return input_.plan.cells[cell].seed == 1 &&
         (wanted.metric->keeps_all_maps || is_first_frame(wanted));
}

std::string ScoreWriter::frame_name(std::size_t cell, const WantedScore& wanted) const {
  const PlannedCell& planned = input_.plan.cells[cell];
  if (!planned.scene->frames.is_sequence) return "";
  return fmt::format("frame {} ", planned.frames[wanted.frame].frame);
}

void ScoreWriter::begin(std::size_t cell, const WantedScore& wanted) {
  if (interrupt_requested) throw Interrupted();
  const PlannedCell& planned = input_.plan.cells[cell];
  meter_.begin_step(fmt::format("score {} {} {}{}", planned.scene->id, planned.method->id,
                                frame_name(cell, wanted), text_of(*wanted.metric)),
                    work_of_score(planned));
}

std::string ScoreWriter::kept_map(std::size_t cell, const WantedScore& wanted,
                                  const perception::Image& map) const {
  const std::string& metric = text_of(*wanted.metric);
  const PlannedCell& planned = input_.plan.cells[cell];
  const fs::path name =
      fs::path("maps") / planned.name / map_name(wanted, planned.frames[wanted.frame].frame);
  fs::create_directories((folder_.path() / name).parent_path());
  perception::ImageFile file;
  file.parts.push_back({"map", map});
  file.attributes.text["discern:metric"] = metric;
  file.attributes.text["discern:against"] = wanted.against;
  file.attributes.text["discern:reference"] = plan_.reference_hash(wanted.truth.reference);
  file.attributes.text["discern:map_unit"] = description_of(wanted.metric->choice).map_unit;
  perception::write_exr(folder_.path() / name, file);
  return name.string();
}

results::MetricRecord ScoreWriter::record(std::size_t cell, const WantedScore& wanted,
                                          const MadeScore& made) const {
  const PlannedCell& planned = input_.plan.cells[cell];
  const PlannedFrame& frame = planned.frames[wanted.frame];
  results::MetricRecord record;
  record.cell = planned.name;
  record.frame = frame.frame;
  record.against = wanted.against;
  record.image_hash = input_.progress[cell].pixel_hash(frame.frame);
  record.reference_hash = plan_.reference_hash(wanted.truth.reference);
  record.reference_pixel_hash = plan_.reference_pixel_hash(wanted.truth.reference);
  record.context_hash = wanted.context_hash;
  record.metric = text_of(*wanted.metric);
  record.parameters = made.parameters.entries();
  record.version = description_of(wanted.metric->choice).version;
  record.id = wanted.metric->id;
  record.image = wanted.metric->image_text();
  record.mask = wanted.metric->mask.text();
  record.mask_hash = wanted.mask_hash;
  record.viewing_hash = hash_of(viewing_of(input_.suite, *planned.frames.front().state)).hex();
  set_score(made.score, record);
  record.noise_floor = made.noise_floor;
  if (made.score.map && keeps_map(cell, wanted)) {
    record.map = kept_map(cell, wanted, *made.score.map);
  }
  return record;
}

void ScoreWriter::append(const WantedScore& wanted, results::MetricRecord record) {
  record.against = wanted.against;
  folder_.append(record);
  ++outcome_.scores;
  meter_.finish_step();
}

void ScoreWriter::fail(std::size_t cell, const WantedScore& wanted, const std::string& reason) {
  outcome_.failures.push_back(fmt::format("{} {}{} {}: {}", input_.plan.cells[cell].name,
                                          frame_name(cell, wanted), text_of(*wanted.metric),
                                          wanted.against, reason));
  meter_.finish_step();
}

void ScoreWriter::fail_image(std::size_t cell, std::size_t scores, const std::string& reason) {
  outcome_.failures.push_back(fmt::format("{}: {}", input_.plan.cells[cell].name, reason));
  for (std::size_t i = 0; i < scores; ++i) meter_.finish_step();
}

}  // namespace suites
