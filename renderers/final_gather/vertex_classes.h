#pragma once

#include <cstdint>
#include <vector>

#include "renderers/final_gather/grid_anchors.h"
#include "renderers/final_gather/hit_rule.h"
#include "renderers/final_gather/sender_classes.h"

namespace renderers::final_gather {

/// Collects and classifies the senders of a vertex of the grid: over points p_i in the adjacent
/// cells and q_i on the sender, F_i = omega_i / pi, omega_i the sender's solid angle, without a
/// receiver's cosine.
///
/// Differs from the paper: a cluster contains a vertex already from half its extent on (`is_near`),
/// as samples on it say as little there; with `HitRule::surface` points p_i are those that the
/// camera sees.
/// Source: Scheel et al. 2002, Sec. 4.3.
class VertexClassifier {
 public:
  /// All must live as long as this.
  VertexClassifier(const SenderClasses& classes, const GridAnchors& anchors, HitRule hit_rule);

  GatherVertex classify(std::uint32_t vertex) const;

 private:
  struct Neighbourhood;
  struct Sums;
  Neighbourhood neighbourhood_of(std::uint32_t vertex) const;
  Sums sample(const Neighbourhood& around, const Sender& sender, int count) const;
  void add_sample(const Neighbourhood& around, std::uint32_t sender, std::uint32_t index,
                  Sums& sums) const;
  void add_near(const Neighbourhood& around, const std::vector<std::uint32_t>& senders,
                GatherVertex& result) const;
  ray_tracing::SurfacePoint point_of(const Anchor& anchor) const;

  const SenderClasses& classes_;
  const SenderTransfer& transfer_;
  const GridAnchors& anchors_;
  HitRule hit_rule_;
  HitCounter counter_;
  double pixels_per_rad_;  ///< at the picture's centre
};

}  // namespace renderers::final_gather
