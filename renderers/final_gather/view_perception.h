#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

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

/// Which of the preview's contrasts hide an artefact.
enum class MaskedBy {
  all,     ///< those of all frequencies together (Sec. 5.2)
  matched  ///< those within an octave of the artefact's frequency, which is known here; ours
};

struct PerceptionSettings {
  ToneOperator tone = ToneOperator::histogram;
  std::string profile = "rama99_calibrated";  ///< of `perception::threshold_profile`
  bool has_masking = true;                    ///< false: contrasts hide nothing
  MaskedBy masked_by = MaskedBy::matched;
  double threshold_scale = 1.0;  ///< multiplies every threshold
  double pixels_per_degree = 67.0;
  double peak_cd_m2 = 200.0;
};

/// What a viewer of the preview can tell apart: the radiosity solution with all textures and
/// objects, tone mapped, and the least visible change of each of its pixels.
///
/// The tone curve is made once, from the preview: a change of D on L is t(L + D) - t(L) on the
/// display. With `MaskedBy::matched` thresholds are kept for artefacts of a row of frequencies, an
/// octave from one to the next, among them the one that the eye sees best: that of edges and steps,
/// which have all higher frequencies as well.
/// Source: Scheel et al. 2002, Sec. 5.2, with the threshold model of perception/threshold_map.h.
class ViewPerception {
 public:
  /// @param world_cd_m2  luminance of the preview, one channel
  ViewPerception(perception::Image world_cd_m2, const PerceptionSettings& settings);

  double world_cd_m2(std::size_t pixel) const;
  /// Change on the display of a change of the world's luminance.
  double shown_change_cd_m2(double world_cd_m2, double change_cd_m2) const;

  /// How many frequencies have thresholds; one that stands for all with `MaskedBy::all`.
  std::size_t frequency_count() const { return frequencies_cpd_.size(); }
  /// The index of edges and steps.
  std::size_t edge() const { return edge_; }
  double edge_frequency_cpd() const { return frequencies_cpd_[edge_]; }
  /// Least visible change of an artefact on the display, cd/m2, with masking if asked for.
  double threshold_cd_m2(std::size_t pixel, std::size_t frequency) const;
  /// Factor of the same by which edges and steps are hidden.
  double elevation(std::size_t pixel) const;
  const perception::Image& elevation_map() const;
  /// Least visible step without masking.
  double base_threshold_cd_m2(std::size_t pixel) const;
  /// Of an artefact of any frequency. @param thresholds  one for each frequency here
  double at_frequency(std::span<const double> thresholds, double frequency_cpd) const;
  /// Degrees of visual angle.
  double degrees(double length_px) const { return length_px / settings_.pixels_per_degree; }

  const perception::Image& preview() const { return preview_; }  ///< tone mapped, cd/m2
  const perception::ThresholdMap& thresholds() const { return thresholds_; }

 private:
  double unmasked_elevation(std::size_t frequency) const;
  double tvi_cd_m2(std::size_t pixel) const;

  PerceptionSettings settings_;
  perception::Image world_;
  std::unique_ptr<perception::ToneCurve> curve_;
  perception::Image preview_;
  std::vector<double> frequencies_cpd_;  ///< lowest first
  std::size_t edge_ = 0;
  perception::ThresholdMap thresholds_;
};

/// How many steps of equal height a shadow's edge needs so that none of them is seen, at most
/// change / threshold: N steps over a width w are an artefact of N / w, but no lower than that of
/// edges. @param thresholds  one for each frequency of the view, all above 0
/// @param width_deg  of the penumbra; 0 or below: unknown
/// Source: Scheel et al. 2002, Sec. 5.3; the frequency is ours.
double hidden_steps(const ViewPerception& view, std::span<const double> thresholds,
                    double change_cd_m2, double width_deg);

/// Luminance of the solution as the camera sees it through the pixels' centres, cd/m2, Gouraud
/// shaded, with point lights by shadow rays. @param rays  counts those cast
perception::Image preview_luminance(const ray_tracing::RayScene& rays,
                                    const element_hierarchy::ShownLight& shown,
                                    const RenderJob& job, std::uint64_t& cast);

}  // namespace renderers::final_gather
