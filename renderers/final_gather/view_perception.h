#pragma once

#include <memory>
#include <string>

#include "perception/image.h"
#include "perception/threshold_map.h"
#include "perception/tone_mapping.h"
#include "perception/viewing_conditions.h"
#include "renderers/contract/renderer.h"
#include "renderers/element_hierarchy/camera_surface.h"
#include "renderers/element_hierarchy/shown_light.h"

namespace renderers::final_gather {

enum class ToneOperator {
  histogram,  ///< Ward Larson et al. 1997, whose TVI the paper takes; the operator is ours
  linear      ///< world light as it is, within the display's range
};

struct PerceptionSettings {
  ToneOperator tone = ToneOperator::histogram;
  std::string profile = "rama99_calibrated";  ///< of `perception::threshold_profile`
  bool has_masking = true;
  double threshold_scale = 1.0;  ///< multiplies every threshold
  double pixels_per_degree = 67.0;
  double peak_cd_m2 = 200.0;
};

/// What a viewer of the preview can tell apart: the radiosity solution with all textures and
/// objects, tone mapped, and the least visible change of each of its pixels.
///
/// The tone curve is made once, from the preview: a change of D on L is t(L + D) - t(L) on the
/// display.
/// Source: Scheel et al. 2002, Sec. 5.2, with the threshold model of perception/threshold_map.h.
class ViewPerception {
 public:
  /// @param world_cd_m2  luminance of the preview, one channel
  ViewPerception(perception::Image world_cd_m2, const PerceptionSettings& settings);

  double world_cd_m2(std::size_t pixel) const;
  /// Least visible change on the display, cd/m2, with masking if asked for.
  double threshold_cd_m2(std::size_t pixel) const;
  /// The same without masking.
  double base_threshold_cd_m2(std::size_t pixel) const;
  double elevation(std::size_t pixel) const;
  /// Change on the display of a change of the world's luminance.
  double shown_change_cd_m2(double world_cd_m2, double change_cd_m2) const;

  const perception::Image& preview() const { return preview_; }  ///< tone mapped, cd/m2
  const perception::ThresholdMap& thresholds() const { return thresholds_; }

 private:
  PerceptionSettings settings_;
  perception::Image world_;
  std::unique_ptr<perception::ToneCurve> curve_;
  perception::Image preview_;
  perception::ThresholdMap thresholds_;
};

/// Luminance of the solution as the camera sees it through the pixels' centres, cd/m2, Gouraud
/// shaded, with point lights by shadow rays. @param rays  counts those cast
perception::Image preview_luminance(const ray_tracing::RayScene& rays,
                                    const element_hierarchy::ShownLight& shown,
                                    const RenderJob& job, std::uint64_t& cast);

}  // namespace renderers::final_gather
