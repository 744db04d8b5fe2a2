#include <memory>
#include <optional>
#include <utility>

#include "perception/base/parallel.h"
#include "renderers/contract/frame_counters.h"
#include "renderers/final_gather/final_gather_renderer.h"
#include "renderers/final_gather/gather_base.h"
#include "renderers/final_gather/grid_gather.h"
#include "renderers/final_gather/grid_settings.h"

namespace renderers::final_gather {

namespace {

using perception::Image;

/// What one view needs, each referring to those before it.
struct View {
  std::uint64_t preview_rays = 0;
  std::unique_ptr<ViewPerception> perception;
  std::optional<GridAnchors> anchors;
  std::unique_ptr<SenderTransfer> transfer;
  std::unique_ptr<VertexClassifier> classifier;
  std::unique_ptr<GridGather> gather;
};

class GridGatherRenderer final : public GatherBase {
 public:
  GridGatherRenderer(GatherSettings gather, Devices devices, GridSettings settings)
      : GatherBase(std::move(gather), std::move(devices)), settings_(std::move(settings)) {}

  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  View view_of(const RenderJob& job, const CameraSamples& samples, StageTimer& timer) const;
  void add_decisions(const View& view, const RenderJob& job, Frame& frame) const;
  void add_counts(const View& view, Frame& frame) const;

  GridSettings settings_;
};

View GridGatherRenderer::view_of(const RenderJob& job, const CameraSamples& samples,
                                 StageTimer& timer) const {
  View view;
  if (solution() == nullptr) return view;
  {
    const auto stage = timer.stage("masking");
    view.perception = std::make_unique<ViewPerception>(
        preview_luminance(rays(), *shown(), job, view.preview_rays), settings_.perception);
  }
  const auto stage = timer.stage("cluster");
  {
    const auto inner = timer.stage("grid");
    view.anchors = GridAnchors::make(*solution()->tree, samples, job, settings_.grid);
  }
  if (!view.anchors) return view;
  const auto inner = timer.stage("classes");
  view.transfer = std::make_unique<SenderTransfer>(*solution(), transfer_of(job));
  view.classifier = std::make_unique<VertexClassifier>(*view.transfer, *view.anchors,
                                                       *view.perception, settings_.classes);
  view.gather = std::make_unique<GridGather>(*view.transfer, *view.anchors, *view.classifier);
  return view;
}

Frame GridGatherRenderer::render(const RenderJob& job, StageTimer& timer) {
  const base::ThreadLimit limit(devices().threads);
  const CameraSamples samples = camera_samples(job, timer);
  const View view = view_of(job, samples, timer);
  GatherPicture made;
  {
    const auto stage = timer.stage("gather");
    made = picture(samples, job, transfer_of(job), [&](const Receiver& receiver, std::uint32_t) {
      return view.gather ? view.gather->at(receiver) : GatheredLight{};
    });
  }
  const auto stage = timer.stage("readback");
  Frame frame = frame_of(std::move(made), samples, job);
  if (view.perception) add_decisions(view, job, frame);
  if (view.gather) add_counts(view, frame);
  return frame;
}

/// Preview, thresholds and masking, per pixel and as the grid's vertices hold it.
void GridGatherRenderer::add_decisions(const View& view, const RenderJob& job, Frame& frame) const {
  frame.aovs.push_back({"preview", view.perception->preview()});
  frame.aovs.push_back({"tvi", view.perception->thresholds().tvi_cd_m2});
  frame.aovs.push_back({"masking", view.perception->elevation_map()});
  if (!view.gather) return;
  Image cells = perception::make_gray_image(job.width_px, job.height_px, "Y",
                                            perception::Encoding::scene_linear);
  Image thresholds = cells;
  const ray_tracing::CameraRays camera(job.camera, job.width_px, job.height_px);
  const auto width = static_cast<std::size_t>(job.width_px);
  base::parallel_for(cells.pixel_count(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      ray_tracing::Hit hit;
      if (!rays().intersect(camera.through(static_cast<float>(i % width) + 0.5F,
                                           static_cast<float>(i / width) + 0.5F),
                            hit)) {
        continue;
      }
      cells.pixels[i] = static_cast<float>(view.gather->elevation(hit.position));
      thresholds.pixels[i] = static_cast<float>(view.gather->threshold_cd_m2(hit.position));
    }
  });
  frame.aovs.push_back({"masking_cell", std::move(cells)});
  frame.aovs.push_back({"threshold_cell", std::move(thresholds)});
}

void GridGatherRenderer::add_counts(const View& view, Frame& frame) const {
  double visibility = 0.0;
  double form_factors = 0.0;
  double senders = 0.0;
  double near = 0.0;
  double weak = 0.0;
  double classes[2][2] = {};  // [resamples form factor][resamples visibility]
  for (const GridVertex& vertex : view.gather->vertices()) {
    visibility += static_cast<double>(vertex.visibility_rays);
    form_factors += static_cast<double>(vertex.form_factor_samples);
    senders += vertex.senders;
    near += vertex.near_senders;
    weak += vertex.weak_share;
    for (const SenderRecord& record : vertex.records) {
      classes[record.resamples_form_factor ? 1 : 0][record.resamples_visibility ? 1 : 0] += 1.0;
    }
  }
  const auto touched = static_cast<double>(view.gather->vertices().size());
  frame.counters.insert(
      frame.counters.end(),
      {{"grid_vertices", static_cast<double>(view.anchors->grid().size().vertex_count())},
       {"touched_vertices", touched},
       {"grid_bytes", static_cast<double>(view.gather->memory_bytes())},
       {"class_visibility_samples", visibility},
       {"class_form_factor_samples", form_factors},
       {"senders_per_vertex", senders / touched},
       {"near_senders_per_vertex", near / touched},
       {"artefact_frequency_cpd", view.perception->edge_frequency_cpd()},
       {"weakly_masked_share", weak / touched},
       {"records_interpolated", classes[0][0]},
       {"records_visibility_resampled", classes[0][1]},
       {"records_form_factor_resampled", classes[1][0]},
       {"records_both_resampled", classes[1][1]}});
  add_to_counter("rays", visibility + static_cast<double>(view.preview_rays), frame);
}

}  // namespace

RendererInfo grid_gather_info() {
  RendererInfo info = gather_info();
  info.name = "grid-final-gather";
  info.summary =
      "Final gather over hierarchical radiosity that a grid in view space steers by what is seen.";
  info.parameters = grid_parameters();
  info.presets = grid_presets();
  info.create = [](const base::Parameters& parameters, const Devices& devices) {
    return std::make_unique<GridGatherRenderer>(gather_settings_of(parameters), devices,
                                                grid_settings_of(parameters));
  };
  return info;
}

}  // namespace renderers::final_gather
