#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/final_gather/directional_irradiance.h"
#include "renderers/final_gather/grid_anchors.h"
#include "renderers/final_gather/hit_rule.h"
#include "renderers/final_gather/sender_list.h"
#include "renderers/final_gather/sender_transfer.h"
#include "renderers/final_gather/view_perception.h"

namespace renderers::final_gather {

/// What stands for the thresholds of all pixels in the cells around a vertex.
enum class Pooling {
  mean,      ///< Sec. 5.2.1
  quartile,  ///< the lower one; ours
  minimum    ///< "too conservative"
};

struct ClassSettings {
  HitRule hit_rule = HitRule::surface;
  int class_samples = 256;       ///< N of Eq. 1 while classifying
  int least_samples = 4;         ///< per sender
  int significant_samples = 24;  ///< least number for senders whose light alone is visible
  int gather_samples = 256;      ///< N of Eq. 1 while rendering
  int containing_rays = 100;
  bool has_reflectance = true;  ///< rho in Eq. 3, as in Eq. 2
  bool has_penumbra_bound = true;
  bool has_contrast_bound = true;
  Pooling pooling = Pooling::mean;
  bool resamples_all = false;  ///< whatever the errors
};

/// A sender as a vertex sees it.
struct SenderRecord {
  std::uint32_t sender = 0;
  bool resamples_form_factor = false;
  bool resamples_visibility = false;
  float visibility = 0.0F;             ///< mean over the neighbourhood
  glm::vec3 radiosity{0.0F};           ///< W/m2, of what is seen of the sender
  glm::vec3 vector_form_factor{0.0F};  ///< mean of omega d / pi, d towards the sender: B times its
                                       ///< product with a normal is irradiance
  float form_factor_samples = 0.0F;
  float visibility_samples = 0.0F;
};

/// What a grid vertex knows.
struct GridVertex {
  std::vector<SenderRecord> records;  ///< by sender
  DirectionalIrradiance around;       ///< from senders that contain the vertex
  double threshold_cd_m2 = 0.0;       ///< least visible step, pooled over the adjacent cells
  double base_threshold_cd_m2 = 0.0;  ///< without masking, the mean
  double elevation = 1.0;             ///< masking, pooled
  double weak_share = 0.0;   ///< of the pixels that mask less than half of what the vertex says
  double world_cd_m2 = 0.0;  ///< of the preview, the mean
  std::uint64_t visibility_rays = 0;
  std::uint64_t form_factor_samples = 0;
  std::uint32_t senders = 0;
  std::uint32_t near_senders = 0;
};

/// Collects and classifies the senders of a vertex.
///
/// Over points p_i in the adjacent cells and q_i on the sender:
///   F_i = omega_i / pi, omega_i the sender's solid angle: no receiver's cosine,
///   D_F = rho B_s (F_max - F_min) vis                                                      (Eq. 2)
///   D_vis = rho B_s F_avg where 0 < vis < 1, else 0                                        (Eq. 3)
/// B_s what the sender sends (`RadiosityField::sent`); each resampled where its change on the
/// display is visible. What is interpolated has the mean radiosity that the samples saw instead:
/// seen from here, a cluster may show its bright or its dark parts; ours. Eq. 3 has no rho in the
/// paper
/// (`has_reflectance` off).
///
/// A sender's samples while rendering, N I_s / sum I, get two bounds (Sec. 5.3): the width of its
/// widest penumbra in pixels, w = s (d - d_os) / d_os, and its light in visible steps,
/// (t(L + rho B F) - t(L)) / T.
///
/// Where thresholds know frequencies (`MaskedBy::matched`), what is interpolated over cells of
/// width c is an error of 1 / (2 c), a shadow's edge that is missed one of no lower frequency than
/// the eye's best, and steps across a penumbra have their own (`hidden_steps`); ours.
///
/// Differs from the paper: a cluster contains a vertex already from half its extent on (`is_near`),
/// as samples on it say as little there; with `HitRule::surface` points p_i are those that the
/// camera sees.
/// Source: Scheel et al. 2002, Secs. 4.3, 5.2, 5.3, Eqs. 1 to 3.
class VertexClassifier {
 public:
  /// All must live as long as this.
  VertexClassifier(const SenderTransfer& transfer, const GridAnchors& anchors,
                   const ViewPerception& perception, const ClassSettings& settings);

  GridVertex classify(std::uint32_t vertex) const;

 private:
  struct Neighbourhood;
  struct Spread;
  Neighbourhood neighbourhood_of(std::uint32_t vertex) const;
  void weigh(Neighbourhood& around, GridVertex& result) const;
  double pooled(const Neighbourhood& around, std::vector<double> values) const;
  double visibility_samples(const Neighbourhood& around, const Sender& sender,
                            const GridVertex& vertex, double light, double samples) const;
  Spread sample(const Neighbourhood& around, const Sender& sender, int count) const;
  void add_sample(const Neighbourhood& around, std::uint32_t sender, std::uint32_t index,
                  Spread& spread) const;
  SenderRecord record_of(const Neighbourhood& around, const Sender& sender, const Spread& spread,
                         const GridVertex& vertex) const;
  int class_samples_for(const Neighbourhood& around, const Sender& sender,
                        const GridVertex& vertex) const;
  void add_near(const Neighbourhood& around, const std::vector<std::uint32_t>& senders,
                GridVertex& result) const;
  /// Change on the display of a change of radiosity, cd/m2. @param radiosity  luminance, W/m2
  double shown_change(const GridVertex& vertex, double radiosity_w_m2) const;
  ray_tracing::SurfacePoint point_of(const Anchor& anchor) const;

  const SenderTransfer& transfer_;
  const GridAnchors& anchors_;
  const ViewPerception& perception_;
  ClassSettings settings_;
  HitCounter counter_;
  double pixels_per_rad_;  ///< at the picture's centre
};

}  // namespace renderers::final_gather
