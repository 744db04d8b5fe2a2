#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderers/ray_bundles/light_solution.h"
#include "renderers/texel_atlas/texel_atlas.h"

namespace renderers::ray_bundles {

/// Light kept apart by how often it was reflected: what the paper's Fig. 7 draws.
///
/// For every number k of reflections a solution of its own, whose senders reflect what the solution
/// of k - 1 has: all are fed by the same bundles in the same way, so that the sum over k is the
/// indirect light of the one that they belong to.
///
/// Source: Hermes et al. 2010, Sec. 5.5: after i directions, light "that was reflected up to i
/// times".
class PathCensus {
 public:
  /// @param atlas     must live as long as this
  /// @param settings  of the solution that is counted; not jacobi, no glossy chain
  /// @param most      reflections, >= 1; longer paths are left out
  PathCensus(const texel_atlas::TexelAtlas& atlas, const SolutionSettings& settings, int most);

  /// The same bundle as the solution's, before it changes that.
  /// @param exchange  lets neighbours exchange what a solution's senders reflect
  template <typename Exchange>
  void add_direction(const LightSolution& counted, float weight, const Exchange& exchange) {
    // From the longest on: senders have what was there before this bundle.
    for (std::size_t k = lengths_.size(); k-- > 0;) {
      send(k, counted);
      lengths_[k].begin_direction(weight);
      exchange(lengths_[k]);
      lengths_[k].end_direction();
    }
  }

  /// Mean of J over the atlas' area, both sides of it summed, of light that was reflected 0, 1, ...
  /// times.
  std::vector<double> means(const LightSolution& counted) const;
  std::int64_t memory_bytes() const;

 private:
  void send(std::size_t k, const LightSolution& counted);

  const texel_atlas::TexelAtlas& atlas_;
  std::vector<LightSolution> lengths_;  ///< [k]: k + 1 reflections
  std::vector<glm::vec3> sent_;
};

}  // namespace renderers::ray_bundles
