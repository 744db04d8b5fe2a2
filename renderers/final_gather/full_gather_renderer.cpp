#include <memory>
#include <utility>

#include "perception/base/parallel.h"
#include "renderers/final_gather/final_gather_renderer.h"
#include "renderers/final_gather/gather_base.h"

namespace renderers::final_gather {

namespace {

class FullGatherRenderer final : public GatherBase {
 public:
  using GatherBase::GatherBase;

  Frame render(const RenderJob& job, StageTimer& timer) override {
    const base::ThreadLimit limit(devices().threads);
    const CameraSamples samples = camera_samples(job, timer);
    const TransferSettings transfer_settings = transfer_of(job);
    GatherPicture made;
    {
      const auto stage = timer.stage("gather");
      if (solution() == nullptr) {
        made = picture(samples, job, transfer_settings, nullptr);
      } else {
        const SenderTransfer transfer(*solution(), transfer_settings);
        const LinkGather gather(transfer, gather_settings().gather);
        made = picture(samples, job, transfer_settings,
                       [&](const Receiver& receiver, std::uint32_t leaf) {
                         return gather.at(receiver, leaf);
                       });
      }
    }
    const auto stage = timer.stage("readback");
    return frame_of(std::move(made), samples, job);
  }
};

}  // namespace

RendererInfo full_gather_info() {
  RendererInfo info = gather_info();
  info.name = "final-gather";
  info.version = 2;
  info.summary = "Final gather over hierarchical radiosity: every link evaluated anew per pixel.";
  info.parameters = gather_parameters();
  info.presets = {base::Preset{"paper", paper_gather_values()}, base::Preset{"best", {}}};
  info.create = [](const base::Parameters& parameters, const Devices& devices) {
    return std::make_unique<FullGatherRenderer>(gather_settings_of(parameters), devices);
  };
  return info;
}

}  // namespace renderers::final_gather
