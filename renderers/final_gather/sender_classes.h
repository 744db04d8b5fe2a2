#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/final_gather/camera_anchors.h"
#include "renderers/final_gather/gather_vertex.h"
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

/// How senders of a vertex are classified, whatever it is a vertex of.
struct ClassSettings {
  int class_samples = 256;       ///< N of Eq. 1 while classifying
  int least_samples = 4;         ///< per sender
  int significant_samples = 24;  ///< least number for senders whose light alone is visible
  int gather_samples = 256;      ///< N of Eq. 1 while rendering
  int containing_rays = 100;
  bool has_reflectance = true;  ///< rho in Eq. 3, as in Eq. 2
  /// Errors of what is interpolated add up, so that they must be invisible together; or each by
  /// itself.
  bool judges_together = true;
  bool has_penumbra_bound = true;
  bool has_contrast_bound = true;
  Pooling pooling = Pooling::mean;
  bool resamples_all = false;  ///< whatever the errors
};

/// What lies around a vertex, and what a viewer tells apart there.
struct Surrounding {
  glm::vec3 place{0.0F};
  std::vector<const Anchor*> anchors;    ///< that the vertex stands for
  std::vector<std::uint32_t> leaves;     ///< each once
  double reflectance = 0.0;              ///< luminance, mean over the anchors
  double irradiance_sum = 0.0;           ///< of the senders that are not occluded
  double pixels_per_m = 0.0;             ///< at the vertex's depth
  double cell_frequency_cpd = 0.0;       ///< of what is interpolated: 1 / (2 cells' width)
  std::vector<double> thresholds_cd_m2;  ///< of every frequency of the view
};

/// Spread of a sender's form factor and visibility around a vertex.
struct Spread {
  double least = std::numeric_limits<double>::infinity();  ///< form factor
  double greatest = 0.0;
  double mean = 0.0;
  double visibility = 0.0;         ///< mean
  bool is_partly_visible = false;  ///< neither everywhere nor nowhere
  glm::vec3 radiosity{0.0F};       ///< W/m2, of what is seen
};

/// A sender as it was classified, and what interpolating it would change on the display, cd/m2.
struct ClassifiedSender {
  SenderRecord record;
  double form_factor_error_cd_m2 = 0.0;  ///< of Eq. 2
  double visibility_error_cd_m2 = 0.0;   ///< of Eq. 3
  double light_cd_m2 = 0.0;              ///< of all of it on the display
  double penumbra_px = 0.0;              ///< width of its widest one; 0: none
  bool is_seen = true;
};

/// The largest of the errors up to which they are invisible together if they are independent of
/// each other: the root of the sum of their squares is at most the threshold; 0 if none is. Ours.
double largest_hidden(std::vector<double> errors, double threshold);

/// Decides from the spread of a sender around a vertex what is interpolated, what evaluated anew,
/// and by how many samples.
///
/// Over points p_i around the vertex and q_i on the sender, F_i their form factors:
///   D_F = rho B_s (F_max - F_min) vis                                                      (Eq. 2)
///   D_vis = rho B_s F_avg where 0 < vis < 1, else 0                                        (Eq. 3)
/// B_s the sender's mean radiosity (`SenderPoints`); each resampled where its change on the
/// display is visible. What is interpolated has the mean radiosity that was seen instead: from
/// here, a cluster may show its bright or its dark parts; ours. Eq. 3 has no rho in the paper
/// (`has_reflectance` off).
///
/// A sender's samples while rendering, N I_s / sum I, get two bounds (Sec. 5.3): the width of its
/// widest penumbra in pixels, w = s (d - d_os) / d_os, and its light in visible steps,
/// (t(L + rho B F) - t(L)) / T.
///
/// Many errors, each below the threshold, are seen: 160 senders whose shadows a cell leaves out are
/// a cell without a shadow. So what is interpolated at a vertex must be invisible together
/// (`largest_hidden`), form factors and visibilities each by themselves, and so must be the steps
/// of the M senders whose visibility is resampled: a sender has as many as if its light were
/// sqrt(M) times as strong; ours.
///
/// Where thresholds know frequencies (`MaskedBy::matched`), what is interpolated over cells of
/// width c is an error of 1 / (2 c), a shadow's edge that is missed one of no lower frequency than
/// the eye's best, and steps across a penumbra have their own (`hidden_steps`); ours. Source:
/// Scheel et al. 2002, Secs. 4.3, 5.2, 5.3, Eqs. 1 to 3.
class SenderClasses {
 public:
  /// All must live as long as this.
  SenderClasses(const SenderTransfer& transfer, const ViewPerception& perception,
                const ClassSettings& settings)
      : transfer_(transfer), perception_(perception), settings_(settings) {}

  /// Makes the record of a sender by so many samples; none: the sender brings nothing.
  using Evaluate =
      std::function<std::optional<ClassifiedSender>(const Sender& sender, int samples)>;
  /// Weighs what lies around a vertex, whose place, cell, anchors and leaves are known, and
  /// classifies the senders that do not contain it.
  /// @return those that contain it
  std::vector<std::uint32_t> classify(Surrounding& around, GatherVertex& vertex,
                                      const Evaluate& evaluate) const;
  /// Without the form factors that are interpolated and without a decision.
  ClassifiedSender judge(const Surrounding& around, const Sender& sender, const Spread& spread,
                         const GatherVertex& vertex) const;

  const SenderTransfer& transfer() const { return transfer_; }
  const ViewPerception& perception() const { return perception_; }
  const ClassSettings& settings() const { return settings_; }

 private:
  /// Reflectance and thresholds from the anchors.
  void weigh(Surrounding& around, GatherVertex& vertex) const;
  /// What of the senders is evaluated anew; leaves out those that bring nothing.
  void decide(const Surrounding& around, std::vector<ClassifiedSender>& senders,
              GatherVertex& vertex) const;
  int class_samples_for(const Surrounding& around, const Sender& sender,
                        const GatherVertex& vertex) const;
  double pooled(const Surrounding& around, std::vector<double> values) const;
  double penumbra_px(const Surrounding& around, const Sender& sender) const;
  /// Shadow samples of a sender after both bounds. @param rivals  number of senders with some
  double visibility_samples(const Surrounding& around, const ClassifiedSender& sender,
                            double rivals, const GatherVertex& vertex) const;
  /// Change on the display of a change of radiosity, cd/m2. @param radiosity  luminance, W/m2
  double shown_change(const GatherVertex& vertex, double radiosity_w_m2) const;

  const SenderTransfer& transfer_;
  const ViewPerception& perception_;
  ClassSettings settings_;
};

}  // namespace renderers::final_gather
