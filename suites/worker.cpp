#include "suites/worker.h"

#include <cstdio>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/parent_channel.h"
#include "renderers/scene/scene_file.h"
#include "suites/measurement.h"
#include "suites/worker_protocol.h"

namespace suites {
namespace {

/// The method as the job spells it out, checked against the renderer's declarations again.
MethodChoice method_of(const OpenJob& job) {
  const base::Place place{"worker job", 0, 0};
  MethodChoice method;
  method.info = &renderers::find_renderer(job.renderer, place);
  method.preset = job.preset;
  std::vector<base::ParameterSetting> settings;
  for (const auto& [name, value] : job.parameters) {
    settings.push_back({name, base::parse_document(base::to_json(value).dump(), place.file)});
  }
  method.parameters = base::resolve_parameters(
      method.info->parameters, &renderers::find_preset(*method.info, job.preset, place), settings,
      fmt::format("renderer \"{}\"", job.renderer));
  return method;
}

/// The scene and the warm renderer between jobs.
class Session {
 public:
  explicit Session(const OpenJob& job)
      : job_(job),
        method_(method_of(job)),
        file_(renderers::scene::read_scene_file(job.scene_file, job.scene_overlays)),
        scene_(state_at(job.frame)),
        renderer_(method_, *scene_, devices(), {job.warmups, job.is_sequence, job.size_px}) {}

  Opened opened() const { return {renderer_.start_up_s(), scene_->hash.hex()}; }

  Reply render(const RenderOrder& order) {
    if (!order.is_cold && !renderer_.has_next()) {
      return Refused{
          fmt::format("frame {} follows no other: no sequence is under way", order.frame)};
    }
    // The renderer may look at the scene of the frame before until it has its update.
    const auto scene_before = scene_;
    if (scene_->frame_index != order.frame) scene_ = state_at(order.frame);
    const MeasureRequest request = request_of(order);
    Measurement measurement =
        order.is_cold ? renderer_.measure(request) : renderer_.measure_next(request);
    if (measurement.storage_error) return NotStored{*measurement.storage_error};
    const bool is_stored = !measurement.frame.radiance.is_empty() &&
                           measurement.record.pixel_hash != order.known_pixel_hash;
    if (is_stored) {
      try {
        perception::write_exr(order.image,
                              image_file_of(measurement, scene_->luminance_scale_cd_m2));
      } catch (const base::InputError& error) {
        return NotStored{error.what()};
      }
      measurement.record.image = order.image.string();
    }
    return Rendered{std::move(measurement.record), std::move(measurement.checkpoints)};
  }

 private:
  std::shared_ptr<const renderers::scene::Scene> state_at(int frame) const {
    return std::make_shared<const renderers::scene::Scene>(file_.at_frame(frame));
  }

  MeasureRequest request_of(const RenderOrder& order) const {
    MeasureRequest request;
    request.scene = scene_.get();
    request.method = method_;
    for (const auto& [name, value] : order.settings) request.method.parameters.set(name, value);
    request.size_px = job_.size_px;
    request.seed = order.seed;
    request.frame = order.frame;
    request.samples = order.samples;
    request.time_budget_s = order.time_s;
    request.devices = devices();
    request.checkpoint_folder = order.checkpoint_folder;
    request.has_new_view = order.has_new_view;
    request.is_last = order.is_last;
    return request;
  }

  renderers::Devices devices() const { return {job_.threads, job_.platform, nullptr}; }

  OpenJob job_;
  MethodChoice method_;
  renderers::scene::SceneFile file_;
  std::shared_ptr<const renderers::scene::Scene> scene_;  ///< of the frame at hand
  MeasuredRenderer renderer_;
};

Reply answer(const Job& job, std::optional<Session>& session) {
  try {
    if (const auto* open = std::get_if<OpenJob>(&job)) {
      session.emplace(*open);
      return session->opened();
    }
    if (!session) return Refused{"a worker's first job must be \"open\""};
    return session->render(std::get<RenderOrder>(job));
  } catch (const std::exception& error) {
    return Refused{error.what()};
  }
}

}  // namespace

int serve_worker(int channel_fd) {
  base::ParentChannel channel(channel_fd);
  std::optional<Session> session;
  try {
    while (const std::optional<std::string> line = channel.receive_line()) {
      const Job job = job_from_line(*line);
      if (std::holds_alternative<CloseJob>(job)) return 0;
      const Reply reply = answer(job, session);
      // What the renderer printed is in the log before the harness hears of the end.
      std::fflush(nullptr);
      channel.send_line(to_line(reply));
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "worker: {}\n", error.what());
    return 2;
  }
  return 0;
}

}  // namespace suites
