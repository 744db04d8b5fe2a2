#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/final_gather/sender_transfer.h"

namespace renderers::final_gather {

/// Light at one point and what it cost.
struct GatheredLight {
  glm::vec3 irradiance{0.0F};  ///< W/m2, from all elements
  double visibility_rays = 0.0;
  double form_factor_samples = 0.0;
  double senders = 0.0;
  /// Senders that were evaluated here: for their form factor alone, visibility alone, both.
  glm::dvec3 resampled{0.0};
};

struct LinkGatherSettings {
  int samples = 256;    ///< N of Eq. 1, shared out by the links' unoccluded irradiance
  int near_rays = 100;  ///< for senders around or next to the point; "about 100" (Sec. 4.3)
};

/// True if an element is a cluster so close to a place that samples on it say little: the place is
/// within half its extent of its box; ours.
bool is_near(const element_hierarchy::Element& sender, const glm::vec3& place);

/// Radiosity that a ray from a point meets on certain senders.
/// @param senders  disjoint elements, in any order
glm::vec3 radiosity_on(const element_hierarchy::Solution& solution, const ray_tracing::Ray& ray,
                       const std::vector<std::uint32_t>& senders);

/// The full final gather: every link that arrives at a point's leaf or at its ancestors is
/// evaluated anew at the point, with N_s = N I_s / sum I samples (Eq. 1), at least one. Links that
/// no ray got through are skipped.
///
/// Senders that surround the point, the self-link among them, share `near_rays` cosine-distributed
/// rays: each brings the radiosity of the leaf that it meets if that is below such a sender.
/// Source: Scheel et al. 2002, Secs. 1, 4.3 (their comparison: one evaluation per link and pixel).
class LinkGather {
 public:
  /// @param transfer  must live as long as this
  LinkGather(const SenderTransfer& transfer, const LinkGatherSettings& settings)
      : transfer_(transfer), settings_(settings) {}

  /// @param leaf  of the receiver
  GatheredLight at(const Receiver& receiver, std::uint32_t leaf) const;

 private:
  void add_near(const Receiver& receiver, const std::vector<std::uint32_t>& senders,
                GatheredLight& light) const;

  const SenderTransfer& transfer_;
  LinkGatherSettings settings_;
};

}  // namespace renderers::final_gather
