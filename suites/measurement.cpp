#include "suites/measurement.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <exception>
#include <functional>
#include <limits>
#include <new>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "perception/base/available_memory.h"
#include "perception/base/parallel.h"
#include "suites/checkpoint_writer.h"
#include "suites/new_view.h"
#include "suites/peak_memory.h"
#include "suites/picture_memory.h"
#include "suites/stage_sums.h"

namespace suites {
namespace {

using renderers::Phase;
using renderers::StageTimer;
using results::Status;

/// Sides of the warm-up image (DESIGN section 3) where the pictures' are powers of two, or not.
constexpr int kWarmUpSide_px = 64;
constexpr int kOtherWarmUpSide_px = 56;
/// Progressive units of the warm-up: enough to touch every code path.
constexpr std::int64_t kWarmUpSamples = 2;
/// Every frame has a radiance of so many channels.
constexpr std::size_t kRadianceChannels = 3;
/// Of a frame that is stored: the renderer's images and those of the file (`image_file_of`).
constexpr std::size_t kCopiesOfFrame = 2;

/// Parameters with `samples` as the budget sets it: what the renderer works with.
base::Parameters parameters_in_force(const MeasureRequest& request) {
  base::Parameters parameters = request.method.parameters;
  if (request.samples && parameters.contains("samples")) {
    parameters.set("samples", *request.samples);
  }
  return parameters;
}

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

/// What of the frame's time no stage covers.
double unattributed_s(const results::RenderRecord& record) {
  return timed_s(record) - (top_level_s(record.stages) - record.readback_s);
}

/// Prepare or update, then render, timed from outside (DESIGN section 3, clock).
/// @return wall time of the first, seconds, its readback with it
double render_timed(renderers::Renderer& renderer, const MeasureRequest& request, Phase first,
                    Measurement& measurement) {
  StageTimer timer;
  CheckpointWriter checkpoints(request, timer);
  reset_peak_memory();

  timer.set_phase(first);
  const double start_s = renderers::steady_seconds();
  if (first == Phase::prepare) {
    renderer.prepare(*request.scene, timer);
  } else {
    renderer.update(*request.scene, timer);
  }
  const double ready_s = renderers::steady_seconds() - start_s;

  // What this took is no longer there for render.
  renderers::RenderJob job = job_of(request);
  const double ready_clock_s = ready_s - readback_s(timer.records());
  if (job.time_budget_s) job.time_budget_s = std::max(0.0, *job.time_budget_s - ready_clock_s);
  if (!request.checkpoint_folder.empty() && request.method.info->progressive_unit) {
    job.checkpoint = [&](const perception::Image& radiance, std::int64_t samples) {
      checkpoints.store(radiance, samples);
    };
  }
  timer.set_phase(Phase::render);
  const double render_start_s = renderers::steady_seconds();
  checkpoints.start(ready_s, render_start_s);
  measurement.frame = renderer.render(job, timer);

  results::RenderRecord& record = measurement.record;
  record.render_s = renderers::steady_seconds() - render_start_s - checkpoints.spent_s();
  record.peak_memory_bytes = peak_memory_bytes();
  record.stages = without_checkpoints(timer.records());
  record.readback_s = readback_s(record.stages);
  measurement.storage_error = checkpoints.storage_error();
  measurement.checkpoints = checkpoints.take();
  return ready_s;
}

/// The same scene from a place nearby. Its image is not kept.
void render_new_view(renderers::Renderer& renderer, const MeasureRequest& request,
                     results::RenderRecord& record) {
  StageTimer timer;
  timer.set_phase(Phase::new_view);
  renderers::RenderJob job = job_of(request);
  job.camera = turned_camera(job.camera);
  const double start_s = renderers::steady_seconds();
  try {
    renderer.render(job, timer);
  } catch (const std::bad_alloc& error) {
    // The picture before it stands.
    record.notes.push_back(fmt::format("the new view ran out of memory ({})", error.what()));
    return;
  }
  const double wall_s = renderers::steady_seconds() - start_s;
  record.new_view_s = wall_s - readback_s(timer.records());
  record.stages.insert(record.stages.end(), timer.records().begin(), timer.records().end());
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
  record.device = frame.device;
  if (!frame.gl_platform.empty()) record.gl_platform = frame.gl_platform;
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
  } catch (const renderers::UnsupportedError& error) {
    fail(Status::unsupported, error.what());
  } catch (const base::InputError& error) {
    fail(Status::unsupported, error.what());
    measurement.is_refused = true;
  } catch (const std::bad_alloc& error) {
    fail(Status::out_of_memory, fmt::format("the renderer ran out of memory ({})", error.what()));
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
  const renderers::Claims claims = info.claims(parameters, *request.scene);
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

base::SizePx warm_up_size(const base::SizePx& pictures_px) {
  const auto side_px = [](int pictures) {
    const bool is_power = std::has_single_bit(static_cast<unsigned>(std::max(pictures, 0)));
    return is_power ? kWarmUpSide_px : kOtherWarmUpSide_px;
  };
  return {side_px(pictures_px.width), side_px(pictures_px.height)};
}

MeasuredRenderer::MeasuredRenderer(const MethodChoice& method, const renderers::scene::Scene& scene,
                                   const renderers::Devices& devices, const WarmUp& warm_up)
    : method_(method), devices_(devices), channels_(kRadianceChannels) {
  if (devices_.warm == nullptr) devices_.warm = std::make_shared<renderers::WarmStore>();
  if (!renderers::unsupported_features(*method.info, scene).empty()) return;
  MeasureRequest request;
  request.scene = &scene;
  request.method = method;
  request.size_px = warm_up_size(warm_up.size_px);
  request.frame = scene.frame_index;
  if (method.info->progressive_unit) request.samples = kWarmUpSamples;
  request.devices = devices;
  request.is_last = !warm_up.is_sequence;
  const double start_s = renderers::steady_seconds();
  const base::ThreadLimit limit(devices.threads);
  for (int i = 0; i < warm_up.renders; ++i) {
    Measurement measurement;
    guarded(
        [&] {
          render_cold(request, measurement);
          if (warm_up.is_sequence) render_next(request, measurement);
        },
        measurement);
    if (measurement.record.reason) warm_up_failure_ = *measurement.record.reason;
    channels_ = std::max(channels_, channel_count(measurement.frame));
    renderer_.reset();
  }
  start_up_s_ = renderers::steady_seconds() - start_s;
}

MeasuredRenderer::~MeasuredRenderer() = default;

void MeasuredRenderer::render_cold(const MeasureRequest& request, Measurement& measurement) {
  renderer_.reset();
  renderer_ = method_.info->create(parameters_in_force(request), devices_);
  results::RenderRecord& record = measurement.record;
  record.prepare_s = render_timed(*renderer_, request, Phase::prepare, measurement);
  record.total_s = record.prepare_s + record.render_s - record.readback_s;
  record.unattributed_s = unattributed_s(record);
  // A view in between may change the next frame of a method with history.
  const bool is_disturbing = method_.info->history && !request.is_last;
  if (request.has_new_view && !is_disturbing) render_new_view(*renderer_, request, record);
}

void MeasuredRenderer::render_next(const MeasureRequest& request, Measurement& measurement) {
  assert(renderer_ != nullptr);
  results::RenderRecord& record = measurement.record;
  // There is no cold start to tell of.
  record.total_s = std::numeric_limits<double>::quiet_NaN();
  record.prepare_s = std::numeric_limits<double>::quiet_NaN();
  record.update_s = render_timed(*renderer_, request, Phase::update, measurement);
  record.next_frame_s = *record.update_s + record.render_s - record.readback_s;
  record.unattributed_s = unattributed_s(record);
}

Measurement MeasuredRenderer::measured(const MeasureRequest& request,
                                       const std::function<void(Measurement&)>& render) {
  Measurement measurement;
  results::RenderRecord& record = measurement.record;
  record = described(request);
  record.start_up_s = start_up_s_;
  const std::vector<std::string> lacking =
      renderers::unsupported_features(*method_.info, *request.scene);
  if (!lacking.empty()) {
    record.status = Status::unsupported;
    record.reason = fmt::format("renderer \"{}\" does not support {}", method_.info->name,
                                fmt::join(lacking, ", "));
    return measurement;
  }
  if (const auto lack = lack_of_memory(request.size_px, channels_, kCopiesOfFrame,
                                       base::available_memory_bytes())) {
    record.status = Status::out_of_memory;
    record.reason = *lack;
    if (!warm_up_failure_.empty()) {
      record.notes.push_back("the warm-up failed: " + warm_up_failure_);
    }
    measurement.is_refused = true;
    renderer_.reset();
    return measurement;
  }
  const base::ThreadLimit limit(devices_.threads);
  guarded(
      [&] {
        render(measurement);
        describe_frame(request, measurement);
      },
      measurement);
  const bool has_image = !measurement.frame.radiance.is_empty();
  if (request.is_last || !has_image) renderer_.reset();
  // What the repetition says by itself need not be said twice.
  const bool is_said = record.status == Status::unsupported && record.reason == warm_up_failure_;
  if (!warm_up_failure_.empty() && !is_said) {
    record.notes.insert(record.notes.begin(), "the warm-up failed: " + warm_up_failure_);
  }
  return measurement;
}

Measurement MeasuredRenderer::measure(const MeasureRequest& request) {
  return measured(request, [&](Measurement& measurement) { render_cold(request, measurement); });
}

Measurement MeasuredRenderer::measure_next(const MeasureRequest& request) {
  return measured(request, [&](Measurement& measurement) { render_next(request, measurement); });
}

Measurement measure_once(const MeasureRequest& request) {
  MeasuredRenderer renderer(request.method, *request.scene, request.devices,
                            {.size_px = request.size_px});
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
  number[record.next_frame_s ? "discern:next_frame_s" : "discern:total_s"] = timed_s(record);
  return file;
}

}  // namespace suites
