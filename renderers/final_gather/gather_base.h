#pragma once

#include <memory>
#include <utility>

#include "renderers/contract/renderer.h"
#include "renderers/element_hierarchy/shown_light.h"
#include "renderers/final_gather/gather_picture.h"
#include "renderers/final_gather/gather_settings.h"

namespace renderers::final_gather {

/// What all final gathers do: solve, then go through the pixels.
class GatherBase : public Renderer {
 public:
  GatherBase(GatherSettings settings, Devices devices)
      : gather_settings_(std::move(settings)), devices_(std::move(devices)) {}

  void prepare(const scene::Scene& scene, StageTimer& timer) override;

 protected:
  /// Camera rays of a job, in stage `gather/borders`.
  CameraSamples camera_samples(const RenderJob& job, StageTimer& timer) const;
  GatherPicture picture(const CameraSamples& samples, const RenderJob& job,
                        const TransferSettings& transfer, const PointGather& gather) const;
  /// Transfer settings with the job's seed.
  TransferSettings transfer_of(const RenderJob& job) const;
  /// Moves a picture and its maps into a frame, with the counters that all gathers have.
  Frame frame_of(GatherPicture picture, const CameraSamples& samples, const RenderJob& job) const;

  const Devices& devices() const { return devices_; }
  const GatherSettings& gather_settings() const { return gather_settings_; }
  const ray_tracing::RayScene& rays() const { return *rays_; }
  const element_hierarchy::Solution* solution() const { return solution_.get(); }
  const element_hierarchy::PatchVertices* patch_vertices() const { return vertices_.get(); }
  const element_hierarchy::ShownLight* shown() const { return shown_.get(); }

 private:
  GatherSettings gather_settings_;
  Devices devices_;
  // Each refers to those before it.
  std::unique_ptr<ray_tracing::RayScene> rays_;
  std::unique_ptr<element_hierarchy::Solution> solution_;  ///< null: light reaches no surface
  std::unique_ptr<element_hierarchy::PatchVertices> vertices_;
  std::unique_ptr<element_hierarchy::ShownLight> shown_;
};

/// `albedo` and `normal` (towards the camera) at the pixels' centres.
std::vector<perception::NamedImage> show_surfaces(const ray_tracing::RayScene& rays,
                                                  const RenderJob& job);

/// Entries of the renderer list that all gathers share; without name, summary, parameters, create.
RendererInfo gather_info();

}  // namespace renderers::final_gather
