#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/element_hierarchy/known_light.h"
#include "renderers/element_hierarchy/link_estimate.h"
#include "renderers/element_hierarchy/link_set.h"
#include "renderers/element_hierarchy/radiosity_field.h"

namespace renderers::element_hierarchy {

struct RefinementSettings {
  LinkSettings links;
  std::size_t link_budget = 100000;  ///< most links
  /// Links whose error is below this share of all emitted power stay as they are.
  double error_floor = 1e-8;
  double least_area = 1e-6;          ///< of a patch after a cut, share of the area of all patches
  double known_light_share = 0.125;  ///< patches cut for point lights, share of the link budget
  int environment_rays = 32;         ///< per patch
  /// Patches next to a cluster ask for its parts before they are cut themselves.
  bool splits_near_sources = true;
};

/// Makes links finer where their error is largest.
///
/// Error of a link in watts, L1 over the receiver, luminance:
///   A_p rho_p (B_q e + F V dB_q),
/// e the link's own error of the form factor times visibility, dB_q half the range of the source's
/// radiosity. A link is replaced by those of its source's or its receiver's parts: of the source if
/// dB_q dominates, else of what extends further. A self-link becomes the children's self-links and
/// one link per ordered pair; everything begins with the root's.
///
/// Sources: Hanrahan et al. 1991 (BF refinement); Bekaert and Willems 1996, "Error Control for
/// Radiosity" (error and choice of side); Sillion 1995 (self-links). The budget: the links of
/// largest error first, as many as may be added.
class LinkRefinement {
 public:
  /// @param tree  must live as long as this
  LinkRefinement(ElementTree& tree, const RefinementSettings& settings);

  /// The root's link to itself.
  LinkSet initial_links();

  /// Cuts patches where point lights vary most, `known_light_share` of the budget, and lights all.
  void cut_for_known_light();

  /// Refines the links of largest error, at most `most_added` more than there are.
  /// @return links refined; 0: none is above the floor or may be refined
  std::size_t refine(RadiosityField& field, LinkSet& links, std::size_t most_added);

  /// Sum of the errors of all links, W of luminance.
  double total_error(const RadiosityField& field, const LinkSet& links) const;

  std::uint64_t rays() const { return rays_; }

 private:
  enum class Side { none, source, receiver };
  struct Choice {
    std::uint32_t receiver;
    std::uint32_t link;  ///< index into all links
    Side side;
  };

  std::vector<float> errors(const RadiosityField& field, const LinkSet& links) const;
  std::vector<Choice> choose(const RadiosityField& field, LinkSet& links,
                             std::size_t most_added) const;
  bool can_split(const Element& element) const;
  Side side_of(const RadiosityField& field, std::uint32_t receiver, const Link& link) const;
  void split_chosen(const std::vector<Choice>& chosen, const LinkSet& links);
  void light_patches(std::uint32_t begin);

  ElementTree& tree_;
  RefinementSettings settings_;
  LinkEstimator estimator_;
  KnownLight known_;
  std::vector<float> known_spread_;  ///< per element, luminance, W/m2
  double emitted_w_ = 0.0;           ///< luminance of all power sent for the first time
  std::uint64_t rays_ = 0;
};

}  // namespace renderers::element_hierarchy
