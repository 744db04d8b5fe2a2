#include "renderers/clustered_visibility/cluster_growth.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

#include "perception/display_model.h"
#include "perception/luminance_input.h"
#include "perception/threshold_map.h"
#include "renderers/many_lights/direct_part.h"
#include "renderers/opengl/gpu_stage.h"
#include "renderers/opengl/view.h"

namespace renderers::clustered_visibility {

namespace {

using opengl::GpuStage;
using perception::Image;

/// A pixel of the preview takes a quarter of the lights, spread over all; not blurred, for a blur
/// would hide the edges of single shadows.
constexpr int kPreviewInterleave = 2;

perception::ViewingConditions preview_viewing(const perception::ViewingConditions& viewing,
                                              int width_px, int full_width_px) {
  perception::ViewingConditions preview = viewing;
  preview.pixels_per_degree *= static_cast<double>(width_px) / full_width_px;
  return preview;
}

/// The preview's size: as the picture's shape, its longer side that of the settings at most.
std::pair<int, int> preview_size(const RenderJob& job, int longest_px) {
  const double scale =
      std::min(1.0, static_cast<double>(longest_px) / std::max(job.width_px, job.height_px));
  const auto scaled = [&](int side_px) {
    return std::max(1, static_cast<int>(std::lround(side_px * scale)));
  };
  return {scaled(job.width_px), scaled(job.height_px)};
}

}  // namespace

double visible_share(const Image& coarse, const Image& fine,
                     const perception::ViewingConditions& viewing, int full_width_px) {
  assert(coarse.width_px == fine.width_px && coarse.height_px == fine.height_px);
  const perception::ViewingConditions seen = preview_viewing(viewing, fine.width_px, full_width_px);
  const Image coarse_light = perception::to_display_light(coarse, seen);
  const Image fine_light = perception::to_display_light(fine, seen);
  const perception::ThresholdMap thresholds = perception::threshold_map(
      coarse_light, fine_light, seen, perception::threshold_profile("rama99_calibrated"));
  const Image a = perception::luminance_input(coarse_light).luminance;
  const Image b = perception::luminance_input(fine_light).luminance;
  std::size_t visible = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (std::fabs(a.pixels[i] - b.pixels[i]) > thresholds.threshold_cd_m2.pixels[i]) ++visible;
  }
  return static_cast<double>(visible) / static_cast<double>(a.pixels.size());
}

ClusterGrowth::ClusterGrowth(std::shared_ptr<opengl::Context> context, const Settings& settings)
    : context_(std::move(context)), settings_(settings), gather_(context_), shade_(context_) {}

void ClusterGrowth::grow(const GrowthInput& input, ClusteredLights& lights, StageTimer& timer) {
  const RenderJob small = begin(input, timer);
  const GrowthInput preview_input{small,       input.scene, input.lights,
                                  input.clamp, input.rays,  input.luminance_scale_cd_m2};
  perception::ViewingConditions viewing = settings_.growth.viewing;
  viewing.luminance_scale_cd_m2 = input.luminance_scale_cd_m2;
  const int most = settings_.clusters.clusters;
  int count = std::min(settings_.growth.first, most);
  lights.make(input.lights, input.scene, count, timer);
  Image before = preview(preview_input, lights, timer);
  while (count < most) {
    count = std::min(2 * count, most);
    lights.make(input.lights, input.scene, count, timer);
    Image now = preview(preview_input, lights, timer);
    const auto stage = timer.stage("preview");
    const double share = visible_share(before, now, viewing, input.job.width_px);
    steps_.push_back({count, share});
    if (share <= settings_.growth.tolerance) break;
    before = std::move(now);
  }
  const GpuStage stage(*context_, timer, "cluster");
  lights.sort_runs(input.lights, input.scene, settings_.interleave);
}

RenderJob ClusterGrowth::begin(const GrowthInput& input, StageTimer& timer) {
  steps_.clear();
  RenderJob small = input.job;
  std::tie(small.width_px, small.height_px) = preview_size(input.job, settings_.growth.preview_px);
  small.checkpoint = {};
  const GpuStage stage(*context_, timer, "preview");
  if (!surfaces_ || surfaces_->width_px() != small.width_px ||
      surfaces_->height_px() != small.height_px) {
    surfaces_ = std::make_unique<opengl::GeometryBuffer>(context_, small.width_px, small.height_px);
  }
  surfaces_->render(input.scene,
                    opengl::camera_view(small.camera, small.width_px, small.height_px));
  direct_ = {};
  if (settings_.part == Part::all) {
    assert(input.rays);
    many_lights::add_direct_light(*input.rays, small, settings_, {.seed = small.seed}, direct_);
  }
  return small;
}

Image ClusterGrowth::preview(const GrowthInput& input, ClusteredLights& lights, StageTimer& timer) {
  const GpuStage stage(*context_, timer, "preview");
  many_lights::GatherSettings settings;
  settings.interleave = kPreviewInterleave;
  settings.geometry_clamp = static_cast<float>(input.clamp);
  settings.with_glossy = input.scene.has_glossy();
  settings.camera_position = input.job.camera.position;
  lights.sort_runs(input.lights, input.scene, kPreviewInterleave);
  gather_.begin(*surfaces_, settings);
  lights.gather(*surfaces_, input.scene, settings, gather_);
  shade_.begin(input.job.width_px, input.job.height_px);
  shade_.add(*surfaces_, gather_.targets(), settings.with_glossy, 1.0F);
  context_->check("making a preview");
  const std::vector<float> rgba = shade_.radiance().read();
  Image image = perception::make_rgb_image(input.job.width_px, input.job.height_px,
                                           perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = rgba[i / 3 * 4 + i % 3];
    if (!direct_.is_empty()) image.pixels[i] += direct_.pixels[i];
  }
  return image;
}

std::int64_t ClusterGrowth::memory_bytes() const {
  std::int64_t bytes = gather_.memory_bytes();
  if (surfaces_) bytes += surfaces_->memory_bytes();
  if (!shade_.radiance().is_empty()) bytes += opengl::size_bytes_of(shade_.radiance().shape());
  return bytes;
}

}  // namespace renderers::clustered_visibility
