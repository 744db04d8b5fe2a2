#pragma once

#include <cstdint>
#include <optional>

#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/element_hierarchy/link.h"

namespace renderers::element_hierarchy {

/// How clusters meet each other.
enum class ClusterKernel {
  /// Every surface in a cluster faces every way: cos = 1/4 of the total area (Sillion 1995, by
  /// Cauchy's theorem).
  isotropic,
  /// Real points on the surfaces inside, with their cosines and their mutual occlusion; ours.
  sampled
};

struct LinkSettings {
  int patch_rays = 16;    ///< segments of a link between patches, a multiple of 4
  int cluster_rays = 32;  ///< segments where an end is a cluster, a multiple of 4
  int near_rays = 128;    ///< rays from a receiver next to or within the source, and half as many
                          ///< that tell their error
  ClusterKernel kernel = ClusterKernel::sampled;
};

/// Estimates links: form factor, visibility and their spread.
///
/// - source a patch: points on the receiver, each with the exact form factor of the patch
///   (`point_form_factor`) and one segment to a point on it;
/// - source a cluster at a distance: pairs of points on the surfaces of both ends;
/// - source a cluster next to, around or equal to the receiver: cosine-distributed rays from the
///   receiver, the share that lands on the source. The rays depend on the receiver alone, so that
///   the sources of one receiver share out each ray and the sum of their form factors is exact.
///
/// Segments start from both ends in turn, so that the nearest occluder of either is seen. All
/// numbers depend on the two elements alone, never on order or threads.
/// Sources: Hanrahan et al. 1991 (visibility by jittered rays); Sillion 1995 (one kernel for
/// clusters and patches); error: `link_error`.
class LinkEstimator {
 public:
  /// @param tree  must live as long as this
  LinkEstimator(const ElementTree& tree, const LinkSettings& settings)
      : tree_(tree), settings_(settings) {}

  /// @return nothing if the two cannot see each other by the planes of patches
  /// @param rays  counts those traced
  std::optional<Link> estimate(std::uint32_t receiver, std::uint32_t source,
                               std::uint64_t& rays) const;

 private:
  struct Samples;
  Link from_pairs(std::uint32_t receiver, std::uint32_t source, std::uint64_t& rays) const;
  double landing_share(std::uint32_t receiver, const Element& source, std::uint64_t set, int count,
                       std::uint64_t& rays) const;
  Link from_rays(std::uint32_t receiver, std::uint32_t source, std::uint64_t& rays) const;
  struct PointPair {
    SidePoint from;
    SidePoint to;
  };
  void add_patch_sample(std::uint32_t receiver, std::uint32_t source, const glm::vec4& u,
                        Samples& samples) const;
  void add_pair(const Element& receiver, const Element& source, const PointPair& pair,
                Samples& samples) const;
  void trace_segment(const PointPair& pair, double weight, Samples& samples) const;
  bool are_near(const Element& receiver, const Element& source) const;

  const ElementTree& tree_;
  LinkSettings settings_;
};

}  // namespace renderers::element_hierarchy
