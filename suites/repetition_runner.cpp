#include "suites/repetition_runner.h"

#include <limits>

#include <fmt/format.h>

#include "results/run_environment.h"

namespace suites {
namespace {

namespace fs = std::filesystem;

/// The first image of a cell is `frame.exr`; those of repetitions with other pixels are numbered.
std::string image_name(int repetition, bool is_first) {
  return is_first ? "frame.exr" : fmt::format("frame-r{:03}.exr", repetition);
}

/// Nobody measured what a worker did that did not answer; in JSON they are null.
void forget_times(results::RenderRecord& render) {
  for (double* time_s : {&render.total_s, &render.prepare_s, &render.render_s, &render.start_up_s,
                         &render.readback_s, &render.unattributed_s}) {
    *time_s = std::numeric_limits<double>::quiet_NaN();
  }
}

/// A worker that was killed in the middle of a file leaves it under its temporary name.
void remove_half_written(const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".tmp") fs::remove(entry.path(), error);
  }
}

}  // namespace

RepetitionRunner::RepetitionRunner(const Suite& suite,
                                   const std::vector<renderers::scene::Scene>& scenes,
                                   const RunOptions& options, results::RunFolder& folder)
    : suite_(suite),
      scenes_(scenes),
      options_(options),
      folder_(folder),
      pool_(suite, options),
      machine_(results::machine_name()) {}

results::CellRecord RepetitionRunner::begin_record(const PlannedCell& cell, int repetition) const {
  MeasureRequest request;
  request.scene = &scenes_[static_cast<std::size_t>(cell.scene - suite_.scenes.data())];
  request.method = cell.method->choice;
  request.size_px = cell.scene->size_px;
  request.seed = cell.seed;
  request.frame = cell.scene->frame;
  request.samples = cell.budget.samples;
  request.time_budget_s = cell.budget.time_s;
  request.devices = {options_.threads, options_.platform};
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
  record.render = described(request);
  return record;
}

RenderOrder RepetitionRunner::order_of(const PlannedCell& cell,
                                       const CellProgress& progress) const {
  const fs::path folder = fs::absolute(folder_.cell_folder(cell.name));
  RenderOrder order;
  order.repetition = progress.next_repetition();
  order.seed = cell.seed;
  order.samples = cell.budget.samples;
  order.time_s = cell.budget.time_s;
  order.image = folder / image_name(order.repetition, progress.image().empty());
  order.known_pixel_hash = progress.pixel_hash();
  // One curve of error over time per cell is enough.
  if (order.repetition == 0 && cell.seed == 1) order.checkpoint_folder = folder;
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
  if (render.pixel_hash == progress.pixel_hash()) {
    render.image = progress.image();
    return;
  }
  render.image = (folder / image_name(record.repetition, progress.image().empty())).string();
  // Proof that the timed image is the scored image; under a time budget they differ by nature.
  if (!progress.image().empty() && !cell.budget.time_s) {
    render.notes.push_back("timed image differs from scored image");
  }
}

void RepetitionRunner::run(const PlannedCell& cell, CellProgress& progress) {
  results::CellRecord record = begin_record(cell, progress.next_repetition());
  if (cell.unsupported) {
    record.render.status = results::Status::unsupported;
    record.render.reason = cell.unsupported;
  } else {
    WorkerAnswer answer =
        pool_.worker(cell, folder_.cell_folder(cell.name)).render(order_of(cell, progress));
    if (answer.is_interrupted) {
      remove_half_written(folder_.cell_folder(cell.name));
      throw Interrupted();
    }
    take_answer(std::move(answer), cell, progress, record);
  }
  folder_.append(record);
  progress.add(record);
}

}  // namespace suites
