#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/contract/frame_counters.h"
#include "renderers/final_gather/final_gather_renderer.h"
#include "renderers/final_gather/gather_base.h"
#include "renderers/final_gather/grid_gather.h"
#include "renderers/final_gather/steered_settings.h"
#include "renderers/final_gather/surface_choice.h"
#include "renderers/final_gather/surface_gather.h"

namespace renderers::final_gather {

namespace {

using perception::Image;

/// What one view needs, each referring to those before it.
struct View {
  std::uint64_t preview_rays = 0;
  std::unique_ptr<ViewPerception> perception;
  std::unique_ptr<std::vector<Anchor>> anchors = std::make_unique<std::vector<Anchor>>();
  std::optional<SurfaceChoice> choice;  ///< none: the camera sees no surface that light reaches
  std::unique_ptr<SenderTransfer> transfer;
  std::unique_ptr<SenderClasses> classes;
  std::unique_ptr<GridAnchors> grid_anchors;
  std::unique_ptr<VertexClassifier> grid_classifier;
  std::unique_ptr<GridGather> grid;
  std::unique_ptr<SurfaceVertices> surface_vertices;
  std::unique_ptr<SurfaceClassifier> surface_classifier;
  std::unique_ptr<SurfaceGather> surface;

  bool can_gather() const { return grid != nullptr || surface != nullptr; }
  std::vector<WeightedVertex> around(const ray_tracing::SurfacePoint& point,
                                     const glm::vec3& towards, std::uint32_t leaf) const {
    return choice->is_on_surface(leaf) ? surface->around(point, towards)
                                       : grid->around(point.position);
  }
  GatheredLight at(const Receiver& receiver, std::uint32_t leaf) const {
    return choice->is_on_surface(leaf) ? surface->at(receiver) : grid->at(receiver);
  }
};

/// A gather steered by what is seen, by the vertices of a grid, of surfaces, or of both.
class SteeredGatherRenderer final : public GatherBase {
 public:
  SteeredGatherRenderer(GatherSettings gather, Devices devices, SteeredSettings settings)
      : GatherBase(std::move(gather), std::move(devices)), settings_(std::move(settings)) {}

  Frame render(const RenderJob& job, StageTimer& timer) override;

 private:
  View view_of(const RenderJob& job, const CameraSamples& samples, StageTimer& timer) const;
  void choose(const RenderJob& job, View& view) const;
  void classify(const RenderJob& job, View& view) const;
  void add_decisions(const View& view, const RenderJob& job, Frame& frame) const;
  void add_counts(const View& view, Frame& frame) const;

  SteeredSettings settings_;
};

View SteeredGatherRenderer::view_of(const RenderJob& job, const CameraSamples& samples,
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
    *view.anchors = camera_anchors(*solution()->tree, samples);
    if (!view.anchors->empty()) choose(job, view);
  }
  if (!view.choice) return view;
  const auto inner = timer.stage("classes");
  classify(job, view);
  return view;
}

/// Which anchors belong to the grid, and which to surfaces.
void SteeredGatherRenderer::choose(const RenderJob& job, View& view) const {
  const element_hierarchy::ElementTree& tree = *solution()->tree;
  std::optional<GatherGrid> grid;
  if (settings_.surface != SurfaceUse::always) {
    grid = grid_around(*view.anchors, job, settings_.grid);
  }
  view.choice.emplace(tree, settings_.surface, grid ? &*grid : nullptr);
  std::vector<bool> is_on_surface(view.anchors->size());
  for (std::size_t i = 0; i < view.anchors->size(); ++i) {
    is_on_surface[i] = view.choice->is_on_surface((*view.anchors)[i].leaf);
  }
  if (std::ranges::find(is_on_surface, true) != is_on_surface.end()) {
    const bool by_vertices = settings_.decided_for == DecidedFor::vertices;
    view.surface_vertices = std::make_unique<SurfaceVertices>(
        tree, by_vertices ? patch_vertices() : nullptr, *view.anchors, is_on_surface);
  }
  if (!grid) return;
  is_on_surface.flip();
  view.grid_anchors = std::make_unique<GridAnchors>(*grid, *view.anchors, is_on_surface);
}

void SteeredGatherRenderer::classify(const RenderJob& job, View& view) const {
  view.transfer = std::make_unique<SenderTransfer>(*solution(), transfer_of(job));
  view.classes =
      std::make_unique<SenderClasses>(*view.transfer, *view.perception, settings_.classes);
  if (view.grid_anchors) {
    view.grid_classifier =
        std::make_unique<VertexClassifier>(*view.classes, *view.grid_anchors, settings_.hit_rule);
    view.grid =
        std::make_unique<GridGather>(*view.transfer, *view.grid_anchors, *view.grid_classifier);
  }
  if (!view.surface_vertices) return;
  const double image_height_at_one =
      2.0 * std::tan(0.5 * glm::radians(static_cast<double>(job.camera.vertical_fov_deg)));
  view.surface_classifier = std::make_unique<SurfaceClassifier>(
      *view.classes, *view.surface_vertices, settings_.vertex_visibility,
      SurfaceViewpoint{job.camera.position,
                       glm::normalize(job.camera.look_at - job.camera.position),
                       job.height_px / image_height_at_one});
  view.surface = std::make_unique<SurfaceGather>(*view.transfer, *view.surface_vertices,
                                                 *view.surface_classifier);
}

Frame SteeredGatherRenderer::render(const RenderJob& job, StageTimer& timer) {
  const base::ThreadLimit limit(devices().threads);
  const CameraSamples samples = camera_samples(job, timer);
  const View view = view_of(job, samples, timer);
  GatherPicture made;
  {
    const auto stage = timer.stage("gather");
    made =
        picture(samples, job, transfer_of(job), [&](const Receiver& receiver, std::uint32_t leaf) {
          return view.can_gather() ? view.at(receiver, leaf) : GatheredLight{};
        });
  }
  const auto stage = timer.stage("readback");
  Frame frame = frame_of(std::move(made), samples, job);
  add_to_counter("rays", static_cast<double>(view.preview_rays), frame);
  if (view.perception) add_decisions(view, job, frame);
  if (view.can_gather()) add_counts(view, frame);
  return frame;
}

/// Preview, thresholds and masking, per pixel and as the vertices hold it.
void SteeredGatherRenderer::add_decisions(const View& view, const RenderJob& job,
                                          Frame& frame) const {
  const perception::NonFinite& non_finite = view.perception->thresholds().non_finite;
  if (non_finite.pixels > 0) {
    frame.notes.push_back(fmt::format(
        "{} pixels of the preview are not finite, the first at ({}, {}): around them nothing is "
        "evaluated anew",
        non_finite.pixels, non_finite.first_x_px, non_finite.first_y_px));
  }
  frame.aovs.push_back({"preview", view.perception->preview()});
  frame.aovs.push_back({"tvi", view.perception->thresholds().tvi_cd_m2});
  frame.aovs.push_back({"masking", view.perception->elevation_map()});
  if (!view.can_gather()) return;
  Image cells = perception::make_gray_image(job.width_px, job.height_px, "Y",
                                            perception::Encoding::scene_linear);
  Image thresholds = cells;
  Image by_surface = cells;
  const ray_tracing::CameraRays camera(job.camera, job.width_px, job.height_px);
  const auto width = static_cast<std::size_t>(job.width_px);
  base::parallel_for(cells.pixel_count(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ray_tracing::Ray ray = camera.through(static_cast<float>(i % width) + 0.5F,
                                                  static_cast<float>(i / width) + 0.5F);
      ray_tracing::Hit hit;
      if (!rays().intersect(ray, hit)) continue;
      const std::uint32_t leaf = solution()->tree->leaf_at(hit, -ray.direction);
      if (leaf == element_hierarchy::kNoElement) continue;
      const bool is_on_surface = view.choice->is_on_surface(leaf);
      // A pixel's centre can see what none of its rays did.
      if (is_on_surface && view.surface == nullptr) continue;
      const std::vector<WeightedVertex> vertices = view.around(hit, -ray.direction, leaf);
      cells.pixels[i] = static_cast<float>(mean_elevation(vertices));
      thresholds.pixels[i] = static_cast<float>(mean_threshold_cd_m2(vertices));
      by_surface.pixels[i] = is_on_surface ? 1.0F : 0.0F;
    }
  });
  frame.aovs.push_back({"masking_cell", std::move(cells)});
  frame.aovs.push_back({"threshold_cell", std::move(thresholds)});
  frame.aovs.push_back({"by_surface", std::move(by_surface)});
}

/// Sums over vertices.
struct VertexCounts {
  double visibility = 0.0;
  double form_factors = 0.0;
  double senders = 0.0;
  double near = 0.0;
  double weak = 0.0;
  double classes[2][2] = {};  ///< [resamples form factor][resamples visibility]
  double vertices = 0.0;

  void add(const std::vector<GatherVertex>& some) {
    for (const GatherVertex& vertex : some) {
      visibility += static_cast<double>(vertex.visibility_rays);
      form_factors += static_cast<double>(vertex.form_factor_samples);
      senders += vertex.senders;
      near += vertex.near_senders;
      weak += vertex.weak_share;
      for (const SenderRecord& record : vertex.records) {
        classes[record.resamples_form_factor ? 1 : 0][record.resamples_visibility ? 1 : 0] += 1.0;
      }
    }
    vertices += static_cast<double>(some.size());
  }
};

void SteeredGatherRenderer::add_counts(const View& view, Frame& frame) const {
  VertexCounts counts;
  double touched = 0.0;
  double bytes = 0.0;
  if (view.grid) {
    counts.add(view.grid->vertices());
    touched = counts.vertices;
    bytes = static_cast<double>(view.grid->memory_bytes());
    frame.counters.push_back(
        {"grid_vertices", static_cast<double>(view.grid_anchors->grid().size().vertex_count())});
    frame.counters.push_back({"touched_vertices", touched});
    frame.counters.push_back({"grid_bytes", bytes});
  }
  if (view.surface) {
    counts.add(view.surface->vertices());
    bytes += static_cast<double>(view.surface->memory_bytes());
  }
  const auto& classes = counts.classes;
  frame.counters.insert(
      frame.counters.end(),
      {{"surface_vertices", counts.vertices - touched},
       {"gather_bytes", bytes},
       {"point_bytes", static_cast<double>(view.transfer->points().memory_bytes())},
       {"class_visibility_samples", counts.visibility},
       {"class_form_factor_samples", counts.form_factors},
       {"senders_per_vertex", counts.senders / counts.vertices},
       {"near_senders_per_vertex", counts.near / counts.vertices},
       {"artefact_frequency_cpd", view.perception->edge_frequency_cpd()},
       {"weakly_masked_share", counts.weak / counts.vertices},
       {"records_interpolated", classes[0][0]},
       {"records_visibility_resampled", classes[0][1]},
       {"records_form_factor_resampled", classes[1][0]},
       {"records_both_resampled", classes[1][1]}});
  add_to_counter("rays", counts.visibility, frame);
}

}  // namespace

RendererInfo grid_gather_info() {
  RendererInfo info = gather_info();
  info.name = "grid-final-gather";
  info.version = 3;
  info.summary =
      "Final gather over hierarchical radiosity that a grid in view space steers by what is seen.";
  info.parameters = grid_parameters();
  info.presets = grid_presets();
  info.create = [](const base::Parameters& parameters, const Devices& devices) {
    return std::make_unique<SteeredGatherRenderer>(gather_settings_of(parameters), devices,
                                                   grid_settings_of(parameters));
  };
  return info;
}

RendererInfo surface_gather_info() {
  RendererInfo info = gather_info();
  info.name = "surface-final-gather";
  info.version = 2;
  info.summary =
      "Final gather over hierarchical radiosity that the vertices of its patches steer by what is "
      "seen.";
  info.source =
      "Scheel, Stamminger, Seidel 2001, \"Thrifty Final Gather for Radiosity\", "
      "doi:10.1007/978-3-7091-6242-2_1, as Scheel et al. 2002 describe it";
  info.parameters = surface_parameters();
  info.presets = surface_presets();
  info.create = [](const base::Parameters& parameters, const Devices& devices) {
    return std::make_unique<SteeredGatherRenderer>(gather_settings_of(parameters), devices,
                                                   surface_settings_of(parameters));
  };
  return info;
}

}  // namespace renderers::final_gather
