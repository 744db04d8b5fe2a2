#include "suites/repetition_runner.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "results/run_environment.h"

namespace suites {
namespace {

namespace fs = std::filesystem;

/// The first image of a cell is `frame.exr`, of a sequence `frame-NNNN.exr`; those of repetitions
/// with other pixels are numbered.
std::string image_name(const PlannedCell& cell, int frame, int repetition, bool is_first) {
  const std::string number =
      cell.scene->frames.is_sequence ? fmt::format("-{:04}", frame) : std::string();
  const std::string again = is_first ? std::string() : fmt::format("-r{:03}", repetition);
  return "frame" + number + again + ".exr";
}

fs::path probe_image(const fs::path& folder, std::size_t frame) {
  return folder / fmt::format("probe-{}.exr", frame);
}

/// The method with the setting that was found for the cell.
MethodChoice method_in_force(const PlannedCell& cell) {
  MethodChoice method = cell.method->choice;
  for (const auto& [name, value] : found_parameters(cell)) method.parameters.set(name, value);
  return method;
}

/// Nobody measured what a worker did that did not answer; in JSON they are null.
void forget_times(results::RenderRecord& render) {
  for (double* time_s : {&render.total_s, &render.prepare_s, &render.render_s, &render.start_up_s,
                         &render.readback_s, &render.unattributed_s}) {
    *time_s = std::numeric_limits<double>::quiet_NaN();
  }
}

bool is_from_another_device(const results::RenderRecord& rendered, const CellProgress& progress) {
  const bool has_image = !rendered.pixel_hash.empty();
  return has_image && !progress.device().empty() && device_text(rendered) != progress.device();
}

/// A median over two devices would be a number of neither: the repetition leaves no time, no image.
/// @param record  describes what was asked; takes in who answered and why that does not count
void refuse_device(const results::RenderRecord& rendered, const std::string& expected,
                   results::RenderRecord& record) {
  record.status = results::Status::unsupported;
  record.reason = fmt::format(
      "the device changed: this cell was measured on {}, this repetition ran on {}; --force starts "
      "a new run, --device forces a platform",
      expected, device_text(rendered));
  record.device = rendered.device;
  record.gl_platform = rendered.gl_platform;
  forget_times(record);
  std::error_code error;
  if (!rendered.image.empty()) fs::remove(rendered.image, error);
}

/// A worker that was killed in the middle of a file leaves it under its temporary name.
void remove_half_written(const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".tmp") fs::remove(entry.path(), error);
  }
}

}  // namespace

RepetitionRunner::RepetitionRunner(const Suite& suite, const RunOptions& options,
                                   results::RunFolder& folder)
    : suite_(suite),
      options_(options),
      folder_(folder),
      pool_(suite, options),
      machine_(results::machine_name()) {}

results::CellRecord RepetitionRunner::begin_record(const PlannedCell& cell, int repetition,
                                                   const PlannedFrame& frame) const {
  MeasureRequest request;
  request.scene = frame.state;
  request.method = method_in_force(cell);
  request.size_px = cell.scene->size_px;
  request.seed = cell.seed;
  request.frame = frame.frame;
  request.samples = samples_of(cell);
  request.time_budget_s = time_limit_s(cell);
  request.devices = devices_of(options_);
  results::CellRecord record;
  record.run = folder_.path().filename().string();
  record.cell = cell.name;
  record.scene = cell.scene->id;
  record.method = cell.method->id;
  record.budget = cell.budget.name();
  record.profile = suite_.profile;
  record.repetition = repetition;
  record.started_utc = base::utc_now();
  record.machine = machine_;
  record.jobs = options_.jobs;
  record.render = described(request);
  return record;
}

RenderOrder RepetitionRunner::order_of(const PlannedCell& cell, const CellProgress& progress,
                                       int repetition, const PlannedFrame& frame) const {
  const fs::path folder = fs::absolute(folder_.cell_folder(cell.name));
  const bool is_known = !progress.image(frame.frame).empty();
  RenderOrder order;
  order.repetition = repetition;
  order.frame = frame.frame;
  order.is_cold = &frame == &cell.frames.front();
  order.is_last = &frame == &cell.frames.back();
  order.has_new_view = suite_.measure.has_new_view && order.is_cold;
  order.seed = cell.seed;
  order.samples = samples_of(cell);
  order.time_s = time_limit_s(cell);
  order.settings = found_parameters(cell);
  order.image = folder / image_name(cell, frame.frame, repetition, !is_known);
  order.known_pixel_hash = progress.pixel_hash(frame.frame);
  // One curve of error over time per cell is enough; of every seed where it is to have an interval.
  const bool has_curve = cell.seed == 1 || suite_.measure.has_convergence;
  if (repetition == 0 && has_curve && order.is_cold) order.checkpoint_folder = folder;
  return order;
}

void RepetitionRunner::take_answer(WorkerAnswer answer, const PlannedCell& cell,
                                   const CellProgress& progress,
                                   results::CellRecord& record) const {
  const fs::path folder = fs::path("images") / cell.name;
  if (!answer.rendered) {
    record.render.status = answer.status;
    record.render.reason = answer.reason;
    forget_times(record.render);
    for (const char* log : {"stdout.log", "stderr.log"}) {
      std::error_code error;
      const auto size_bytes = fs::file_size(folder_.cell_folder(cell.name) / log, error);
      if (!error && size_bytes > 0)
        record.render.notes.push_back("log: " + (folder / log).string());
    }
    remove_half_written(folder_.cell_folder(cell.name));
    return;
  }
  record.render = std::move(answer.rendered->record);
  record.checkpoints = std::move(answer.rendered->checkpoints);
  for (results::Checkpoint& checkpoint : record.checkpoints) {
    checkpoint.image = (folder / checkpoint.image).string();
  }
  results::RenderRecord& render = record.render;
  if (render.pixel_hash.empty()) return;
  const std::string& known_image = progress.image(render.frame);
  if (render.pixel_hash == progress.pixel_hash(render.frame)) {
    render.image = known_image;
    return;
  }
  const std::string name = image_name(cell, render.frame, record.repetition, known_image.empty());
  render.image = (folder / name).string();
  // Proof that the timed image is the scored image; under a time budget they differ by nature.
  if (!known_image.empty() && !time_limit_s(cell)) {
    render.notes.push_back("timed image differs from scored image");
  }
}

results::CellRecord RepetitionRunner::run_frame(const PlannedCell& cell,
                                                const CellProgress& progress, int repetition,
                                                const PlannedFrame& frame) {
  results::CellRecord record = begin_record(cell, repetition, frame);
  if (cell.unsupported) {
    record.render.status = results::Status::unsupported;
    record.render.reason = cell.unsupported;
    return record;
  }
  if (cell.no_setting) {
    record.render.status = results::Status::skipped;
    record.render.reason = cell.no_setting;
    forget_times(record.render);
    return record;
  }
  // Before a worker starts, whose own work would be in the canary's time; beside other jobs it
  // would measure them.
  if (&frame == &cell.frames.front() && options_.jobs == 1) {
    record.canary_s = canary_.run().wall_s;
  }
  WorkerProcess& worker = pool_.worker(cell, folder_.cell_folder(cell.name));
  WorkerAnswer answer = worker.render(order_of(cell, progress, repetition, frame));
  if (answer.is_interrupted) {
    remove_half_written(folder_.cell_folder(cell.name));
    throw Interrupted();
  }
  if (answer.rendered && is_from_another_device(answer.rendered->record, progress)) {
    refuse_device(answer.rendered->record, progress.device(), record.render);
    return record;
  }
  take_answer(std::move(answer), cell, progress, record);
  return record;
}

ProbeOutcome RepetitionRunner::probe(const PlannedCell& cell) {
  ProbeOutcome outcome;
  const fs::path folder = folder_.cell_folder(cell.name);
  const std::size_t count = std::min(cell.frames.size(), kProbedFrames);
  const CellProgress nothing(cell.frames.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (interrupt_requested) throw Interrupted();
    RenderOrder order = order_of(cell, nothing, 0, cell.frames[i]);
    order.image = probe_image(fs::absolute(folder), i);
    order.is_last = i + 1 == count;
    order.has_new_view = false;
    order.checkpoint_folder.clear();
    const WorkerAnswer answer = pool_.worker(cell, folder).render(order);
    if (answer.is_interrupted) throw Interrupted();
    if (!answer.rendered || !results::is_success(answer.rendered->record.status)) {
      const std::string reason =
          answer.rendered ? answer.rendered->record.reason.value_or("") : answer.reason;
      outcome.failure = fmt::format("a render of the search failed: {}", reason);
      return outcome;
    }
    outcome.frames.push_back({answer.rendered->record, order.image});
  }
  return outcome;
}

void RepetitionRunner::end_probes(const PlannedCell& cell) const {
  std::error_code error;  // an image that is not there is none to remove
  for (std::size_t i = 0; i < kProbedFrames; ++i) {
    fs::remove(probe_image(folder_.cell_folder(cell.name), i), error);
  }
}

void RepetitionRunner::run(const PlannedCell& cell, CellProgress& progress,
                           const std::function<void(double)>& show) {
  const int repetition = progress.next_repetition();
  const auto count = static_cast<double>(cell.frames.size());
  for (std::size_t i = 0; i < cell.frames.size(); ++i) {
    if (interrupt_requested) throw Interrupted();
    const results::CellRecord record = run_frame(cell, progress, repetition, cell.frames[i]);
    folder_.append(record);
    progress.add(record);
    if (show) show(static_cast<double>(i + 1) / count);
    if (ends_sequence(record.render.status)) return;
  }
}

}  // namespace suites
