#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "perception/image.h"
#include "perception/viewing_conditions.h"
#include "renderers/clustered_visibility/clustered_lights.h"
#include "renderers/contract/renderer.h"
#include "renderers/many_lights/gather.h"
#include "renderers/many_lights/shade.h"
#include "renderers/opengl/geometry_buffer.h"
#include "renderers/opengl/gpu_scene.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::clustered_visibility {

/// What clusters are grown for.
struct GrowthInput {
  const RenderJob& job;
  const opengl::GpuScene& scene;
  const opengl::Buffer& lights;                 ///< VirtualLight, as ClusteredLights::make
  double clamp = 0.0;                           ///< of the geometry term, 1/m2; 0: none
  const ray_tracing::RayScene* rays = nullptr;  ///< for direct light; needed where it is shown
  double luminance_scale_cd_m2 = 100.0;         ///< of radiance 1.0, the scene's
};

/// One number of clusters tried after the first.
struct GrowthStep {
  int clusters = 0;
  double visible_share = 0.0;  ///< of the preview's pixels, changed visibly by as many more
};

/// Share of pixels whose luminances differ by more than the threshold of either picture.
/// @param coarse, fine  scene-linear radiance, same size
/// @param full_width_px  of the picture that they are previews of: its pixels are seen as small as
///   the viewing says, theirs are larger
double visible_share(const perception::Image& coarse, const perception::Image& fine,
                     const perception::ViewingConditions& viewing, int full_width_px);

/// As many clusters as the light of a picture needs (Dong et al. 2009, Sec. 8 name their number
/// future work; the way is ours).
///
/// A small preview is made with the first number of clusters and with twice as many, again and
/// again, until the two differ by less than the least visible difference (perception's threshold
/// map) in all but a share of its pixels. Errors of visibility fall about as 1 / M, so that the
/// difference between M and 2 M is what 2 M clusters are still wrong by.
class ClusterGrowth {
 public:
  ClusterGrowth(std::shared_ptr<opengl::Context> context, const Settings& settings);

  /// Makes the lights' clusters and shadows, sorted for the settings' interleave. Stages of
  /// ClusteredLights::make and `preview`, in which the preview is read back.
  void grow(const GrowthInput& input, ClusteredLights& lights, StageTimer& timer);

  /// Numbers tried by the last call after the first one.
  const std::vector<GrowthStep>& steps() const { return steps_; }
  std::int64_t memory_bytes() const;

 private:
  RenderJob begin(const GrowthInput& input, StageTimer& timer);
  perception::Image preview(const GrowthInput& input, ClusteredLights& lights, StageTimer& timer);

  std::shared_ptr<opengl::Context> context_;
  Settings settings_;
  many_lights::Gather gather_;
  many_lights::Shade shade_;
  std::unique_ptr<opengl::GeometryBuffer> surfaces_;
  perception::Image direct_;
  std::vector<GrowthStep> steps_;
};

}  // namespace renderers::clustered_visibility
