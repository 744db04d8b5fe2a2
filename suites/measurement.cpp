#include "suites/measurement.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <functional>
#include <new>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "perception/base/child_process.h"
#include "perception/base/parallel.h"
#include "suites/stage_sums.h"

namespace suites {
namespace {

using renderers::Phase;
using renderers::StageTimer;
using results::Status;

/// Size of the warm-up image, DESIGN section 3.
constexpr base::SizePx kWarmUpSize{64, 64};
/// Progressive units of the warm-up: enough to touch every code path.
constexpr std::int64_t kWarmUpSamples = 2;

/// Parameters with `samples` as the budget sets it: what the renderer works with.
base::Parameters parameters_in_force(const MeasureRequest& request) {
  base::Parameters parameters = request.method.parameters;
  if (request.samples && parameters.contains("samples")) {
    parameters.set("samples", *request.samples);
  }
  return parameters;
}

/// Lets the kernel count this process's peak memory anew, so that a repetition reports its own.
/// Where /proc refuses, the peak of the process so far is reported.
void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5"; }

/// VmHWM of /proc/self/status, bytes: the peak since the last reset.
std::int64_t peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::int64_t{1024} * std::stoll(line.substr(6));
  }
  return base::peak_resident_bytes();
}

/// Stores the images that a progressive renderer hands over; its time is taken out of the stages.
class CheckpointWriter {
 public:
  CheckpointWriter(const MeasureRequest& request, StageTimer& timer)
      : request_(request), timer_(timer) {}

  /// @param prepare_s  wall time of prepare, its readback with it
  /// @param start_s    start of the render call, steady clock
  void start(double prepare_s, double start_s) {
    prepare_s_ = prepare_s;
    start_s_ = start_s;
  }

  void store(const perception::Image& radiance, std::int64_t samples) {
    const double now_s = renderers::steady_seconds();
    const auto stage = timer_.stage(kCheckpointStage);
    results::Checkpoint checkpoint;
    // The clock of total_s: neither this sink nor any readback so far is in it.
    const double read_s = readback_s(without_checkpoints(timer_.records()));
    checkpoint.elapsed_s = prepare_s_ + now_s - start_s_ - spent_s_ - read_s;
    checkpoint.samples = samples;
    checkpoint.image = fmt::format("checkpoint-{:03}.exr", checkpoints_.size());
    perception::ImageFile file;
    file.parts.push_back({"radiance", radiance});
    file.attributes.number[perception::kLuminanceScaleAttribute] =
        request_.scene->luminance_scale_cd_m2;
    try {
      perception::write_exr(request_.checkpoint_folder / checkpoint.image, file);
      checkpoints_.push_back(std::move(checkpoint));
    } catch (const base::InputError& error) {
      storage_error_ = error.what();  // the folder's fault: the renderer goes on
    }
    spent_s_ += renderers::steady_seconds() - now_s;
  }

  double spent_s() const { return spent_s_; }
  std::vector<results::Checkpoint> take() { return std::move(checkpoints_); }
  const std::optional<std::string>& storage_error() const { return storage_error_; }

 private:
  const MeasureRequest& request_;
  StageTimer& timer_;
  std::vector<results::Checkpoint> checkpoints_;
  std::optional<std::string> storage_error_;
  double prepare_s_ = 0.0;
  double start_s_ = 0.0;
  double spent_s_ = 0.0;
};

renderers::RenderJob job_of(const MeasureRequest& request) {
  renderers::RenderJob job;
  job.width_px = request.size_px.width;
  job.height_px = request.size_px.height;
  job.camera = request.scene->camera;
  job.seed = request.seed;
  job.frame_index = request.frame;
  job.samples = request.samples;
  job.time_budget_s = request.time_budget_s;
  return job;
}

/// prepare and render, timed from outside (DESIGN section 3, clock).
void render_timed(const MeasureRequest& request, Measurement& measurement) {
  results::RenderRecord& record = measurement.record;
  const auto renderer = request.method.info->create(parameters_in_force(request), request.devices);
  StageTimer timer;
  CheckpointWriter checkpoints(request, timer);
  reset_peak_memory();

  timer.set_phase(Phase::prepare);
  const double prepare_start_s = renderers::steady_seconds();
  renderer->prepare(*request.scene, timer);
  record.prepare_s = renderers::steady_seconds() - prepare_start_s;
  const double prepared_s = record.prepare_s - readback_s(timer.records());

  // What prepare took is no longer there for render.
  renderers::RenderJob job = job_of(request);
  if (job.time_budget_s) job.time_budget_s = std::max(0.0, *job.time_budget_s - prepared_s);
  if (!request.checkpoint_folder.empty() && request.method.info->progressive_unit) {
    job.checkpoint = [&](const perception::Image& radiance, std::int64_t samples) {
      checkpoints.store(radiance, samples);
    };
  }
  timer.set_phase(Phase::render);
  const double render_start_s = renderers::steady_seconds();
  checkpoints.start(record.prepare_s, render_start_s);
  measurement.frame = renderer->render(job, timer);
  record.render_s = renderers::steady_seconds() - render_start_s - checkpoints.spent_s();

  record.peak_memory_bytes = peak_memory_bytes();
  record.stages = without_checkpoints(timer.records());
  record.readback_s = readback_s(record.stages);
  record.total_s = record.prepare_s + record.render_s - record.readback_s;
  record.unattributed_s = record.total_s - (top_level_s(record.stages) - record.readback_s);
  measurement.storage_error = checkpoints.storage_error();
  measurement.checkpoints = checkpoints.take();
}

/// What the image itself says: hash, samples, counters, pixels that are no numbers.
void describe_frame(const MeasureRequest& request, Measurement& measurement) {
  results::RenderRecord& record = measurement.record;
  const renderers::Frame& frame = measurement.frame;
  if (frame.radiance.width_px != request.size_px.width ||
      frame.radiance.height_px != request.size_px.height) {
    throw base::DeviceError(fmt::format("the renderer returned {}x{} pixels; asked were {}x{}",
                                        frame.radiance.width_px, frame.radiance.height_px,
                                        request.size_px.width, request.size_px.height));
  }
  record.counters = frame.counters;
  record.notes.insert(record.notes.end(), frame.notes.begin(), frame.notes.end());
  if (request.method.info->progressive_unit) record.samples = frame.samples;
  record.pixel_hash = perception::pixel_hash(frame.radiance);
  const perception::NonFinite bad = perception::count_non_finite(frame.radiance);
  record.non_finite_pixels = bad.pixels;
  if (bad.pixels == 0) return;
  record.status = Status::non_finite;
  record.reason = fmt::format("{} of {} pixels are not finite, the first at ({}, {})", bad.pixels,
                              frame.radiance.pixel_count(), bad.first_x_px, bad.first_y_px);
}

/// Runs a piece of work of a renderer; what it throws becomes status and reason.
void guarded(const std::function<void()>& work, Measurement& measurement) {
  const auto fail = [&](Status status, const std::string& reason) {
    measurement.record.status = status;
    measurement.record.reason = reason;
    measurement.frame = renderers::Frame{};
  };
  try {
    work();
  } catch (const std::bad_alloc&) {
    fail(Status::out_of_memory, "the renderer ran out of memory (std::bad_alloc)");
  } catch (const std::exception& error) {
    fail(Status::crash, fmt::format("exception: {}", error.what()));
  } catch (...) {
    fail(Status::crash, "exception of an unknown type");
  }
}

}  // namespace

results::RenderRecord described(const MeasureRequest& request) {
  const renderers::RendererInfo& info = *request.method.info;
  const base::Parameters parameters = parameters_in_force(request);
  const renderers::Claims claims = info.claims(parameters);
  results::RenderRecord record;
  record.scene = request.scene->name;
  record.scene_hash = request.scene->hash.hex();
  record.renderer = info.name;
  record.preset = request.method.preset;
  record.parameters = parameters.entries();
  record.transport = to_string(claims.transport);
  record.part = to_string(claims.part);
  record.geometry_clamp = claims.geometry_clamp;
  record.width_px = request.size_px.width;
  record.height_px = request.size_px.height;
  record.seed = request.seed;
  record.frame = request.frame;
  record.threads = request.devices.threads > 0 ? request.devices.threads : base::core_count();
  return record;
}

MeasuredRenderer::MeasuredRenderer(const MethodChoice& method, const renderers::scene::Scene& scene,
                                   const renderers::Devices& devices, int warmups)
    : method_(method), devices_(devices) {
  if (!renderers::unsupported_features(*method.info, scene).empty()) return;
  MeasureRequest request;
  request.scene = &scene;
  request.method = method;
  request.size_px = kWarmUpSize;
  request.frame = scene.frame_index;
  if (method.info->progressive_unit) request.samples = kWarmUpSamples;
  request.devices = devices;
  const double start_s = renderers::steady_seconds();
  const base::ThreadLimit limit(devices.threads);
  for (int i = 0; i < warmups; ++i) {
    Measurement measurement;
    guarded([&] { render_timed(request, measurement); }, measurement);
    if (measurement.record.reason) warm_up_failure_ = *measurement.record.reason;
  }
  start_up_s_ = renderers::steady_seconds() - start_s;
}

MeasuredRenderer::~MeasuredRenderer() = default;

Measurement MeasuredRenderer::measure(const MeasureRequest& request) {
  Measurement measurement;
  measurement.record = described(request);
  measurement.record.start_up_s = start_up_s_;
  const std::vector<std::string> lacking =
      renderers::unsupported_features(*method_.info, *request.scene);
  if (!lacking.empty()) {
    measurement.record.status = Status::unsupported;
    measurement.record.reason = fmt::format("renderer \"{}\" does not support {}",
                                            method_.info->name, fmt::join(lacking, ", "));
    return measurement;
  }
  if (!warm_up_failure_.empty()) {
    measurement.record.notes.push_back("the warm-up failed: " + warm_up_failure_);
  }
  const base::ThreadLimit limit(devices_.threads);
  guarded(
      [&] {
        render_timed(request, measurement);
        describe_frame(request, measurement);
      },
      measurement);
  return measurement;
}

Measurement measure_once(const MeasureRequest& request) {
  MeasuredRenderer renderer(request.method, *request.scene, request.devices);
  return renderer.measure(request);
}

perception::ImageFile image_file_of(const Measurement& measurement, double luminance_scale_cd_m2) {
  const results::RenderRecord& record = measurement.record;
  perception::ImageFile file;
  file.parts.push_back({"radiance", measurement.frame.radiance});
  for (const perception::NamedImage& aov : measurement.frame.aovs) file.parts.push_back(aov);
  auto& text = file.attributes.text;
  text["discern:scene"] = record.scene;
  text["discern:scene_hash"] = record.scene_hash;
  text["discern:renderer"] = record.renderer;
  text["discern:preset"] = record.preset;
  text["discern:parameters"] = base::Parameters(record.parameters).to_text();
  text["discern:transport"] = record.transport;
  text["discern:part"] = record.part;
  text["discern:status"] = to_string(record.status);
  text["discern:device"] = record.device;
  auto& number = file.attributes.number;
  number[perception::kLuminanceScaleAttribute] = luminance_scale_cd_m2;
  if (record.samples) number["discern:samples"] = static_cast<double>(*record.samples);
  number["discern:seed"] = static_cast<double>(record.seed);
  number["discern:frame"] = record.frame;
  number["discern:total_s"] = record.total_s;
  return file;
}

}  // namespace suites
