#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderers/contract/stage_timer.h"
#include "renderers/element_hierarchy/element_tree.h"
#include "renderers/element_hierarchy/link_refinement.h"
#include "renderers/element_hierarchy/link_set.h"
#include "renderers/element_hierarchy/radiosity_field.h"

namespace renderers::element_hierarchy {

struct SolverSettings {
  RefinementSettings refinement;
  double convergence = 1e-3;   ///< iterations end when max |dB| by the largest reflected B is below
  int most_iterations = 1000;  ///< per pass
  double growth = 1.0;         ///< links added per pass, share of those there are
  int side_rays = 32;  ///< least number of rays per whole side, >= 8; more where sides are few
  double largest_side = 8.0;  ///< larger ones, by the mean area, are cut; ours; with the next alone
  bool shares_by_views = true;  ///< light of clusters by `SideViews`; else spread evenly
};

/// What the solver did.
struct SolverRecord {
  std::vector<double> residuals;   ///< max |dB| by the largest reflected B, of all passes
  std::vector<double> pass_links;  ///< links after each pass
  std::uint64_t rays = 0;
  bool has_converged = false;
};

/// A solved scene.
struct Solution {
  std::unique_ptr<ElementTree> tree;
  LinkSet links;
  std::unique_ptr<SideViews> views;           ///< refers to `tree`; may be missing
  std::unique_ptr<RadiosityField> field;      ///< refers to `tree` and `views`
  std::vector<glm::vec3> emitted_irradiance;  ///< of `RadiosityField::emitted_irradiance`
  SolverRecord record;

  std::int64_t memory_bytes() const {
    return tree->memory_bytes() + links.memory_bytes() + (views ? views->memory_bytes() : 0) +
           field->memory_bytes() +
           static_cast<std::int64_t>(emitted_irradiance.capacity() * sizeof(glm::vec3));
  }
};

/// Hierarchical radiosity with clusters: refine, solve, refine where the solution says the error
/// is largest, until the budget of links is used up.
///
/// Stages, under whatever is open: `elements`, `links`, `iterations`.
/// @param rays  must live as long as the result
/// @return nothing if light reaches no surface
std::unique_ptr<Solution> solve_radiosity(const ray_tracing::RayScene& rays,
                                          const SolverSettings& settings, StageTimer& timer);

/// The same on a tree that is given. @param solution  receives; its `tree` is there
void solve_radiosity(const SolverSettings& settings, StageTimer& timer, Solution& solution);

}  // namespace renderers::element_hierarchy
