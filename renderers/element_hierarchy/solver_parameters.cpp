#include "renderers/element_hierarchy/solver_parameters.h"

#include <array>
#include <string>
#include <utility>

#include "renderers/contract/choice_names.h"

namespace renderers::element_hierarchy {

namespace {

using base::choice_parameter;
using base::integer_parameter;
using base::real_parameter;

constexpr std::array<std::pair<const char*, ClusterKernel>, 2> kKernels{
    {{"isotropic", ClusterKernel::isotropic}, {"sampled", ClusterKernel::sampled}}};

constexpr std::array<std::pair<const char*, bool>, 2> kSpreads{
    {{"uniform", false}, {"seen", true}}};

}  // namespace

std::vector<base::ParameterSpec> solver_parameters() {
  return {
      integer_parameter("link_budget", 60000, {64.0, 1e8}, "links",
                        "Most links of the radiosity solution, those of largest error refined "
                        "first; the paper gives none; ours."),
      integer_parameter("patch_rays", 16, {4.0, 4096.0}, "rays",
                        "Visibility rays of a link between patches, rounded up to a multiple of 4; "
                        "ours."),
      integer_parameter("cluster_rays", 32, {4.0, 4096.0}, "rays",
                        "The same where an end is a cluster; ours."),
      integer_parameter("near_rays", 128, {16.0, 65536.0}, "rays",
                        "Rays from a receiver next to or within a cluster that light it; ours."),
      choice_parameter("cluster_kernel", names_of(kKernels), "sampled",
                       "isotropic: surfaces in a cluster face every way (Sillion 1995); sampled: "
                       "points on them with their cosines; ours."),
      choice_parameter("cluster_light", names_of(kSpreads), "seen",
                       "uniform: light that arrives at a cluster is the same on all that is in it, "
                       "and it sends the mean (Sillion 1995); seen: by what its surfaces see; "
                       "ours."),
      real_parameter("convergence", 1e-3, {1e-7, 0.5}, "",
                     "Iterations end when the largest change of radiosity is below this share of "
                     "the largest reflected radiosity; ours."),
      real_parameter("error_floor", 1e-8, {0.0, 1.0}, "",
                     "Links whose error is below this share of all power are left as they are; "
                     "ours."),
      real_parameter("least_area", 1e-6, {1e-12, 1.0}, "",
                     "Least area of a patch after a cut, share of all area; ours."),
      integer_parameter("environment_rays", 32, {1.0, 65536.0}, "rays",
                        "Rays per patch towards the environment; ours."),
  };
}

SolverSettings solver_settings_of(const base::Parameters& parameters) {
  const auto in_fours = [&](const char* name) {
    return static_cast<int>((parameters.integer(name) + 3) / 4 * 4);
  };
  SolverSettings settings;
  settings.convergence = parameters.real("convergence");
  settings.shares_by_views = value_of(kSpreads, parameters.text("cluster_light"));
  RefinementSettings& refinement = settings.refinement;
  refinement.splits_near_sources = settings.shares_by_views;
  refinement.link_budget = static_cast<std::size_t>(parameters.integer("link_budget"));
  refinement.error_floor = parameters.real("error_floor");
  refinement.least_area = parameters.real("least_area");
  refinement.environment_rays = static_cast<int>(parameters.integer("environment_rays"));
  refinement.links.patch_rays = in_fours("patch_rays");
  refinement.links.cluster_rays = in_fours("cluster_rays");
  refinement.links.near_rays = static_cast<int>(parameters.integer("near_rays"));
  refinement.links.kernel = value_of(kKernels, parameters.text("cluster_kernel"));
  return settings;
}

std::vector<std::pair<std::string, base::ParameterValue>> paper_solver_values() {
  // The clusters that the paper cites are those of Sillion 1995.
  return {{"cluster_kernel", base::ParameterValue(std::string("isotropic"))},
          {"cluster_light", base::ParameterValue(std::string("uniform"))}};
}

std::vector<std::pair<std::string, CounterValue>> solution_counters(const Solution* solution) {
  if (solution == nullptr) return {{"links", 0.0}, {"elements", 0.0}};
  const auto number = [](auto value) { return static_cast<double>(value); };
  std::size_t patches = 0;
  for (const Element& element : solution->tree->elements()) {
    patches += element.is_patch && element.is_leaf() ? 1 : 0;
  }
  std::size_t occluded = 0;
  for (const Link& link : solution->links.all()) occluded += link.is(fully_occluded) ? 1 : 0;
  const double links = number(solution->links.size());
  return {{"links", links},
          {"occluded_links", number(occluded)},
          {"elements", number(solution->tree->elements().size())},
          {"leaf_patches", number(patches)},
          {"degenerate_triangles", number(solution->tree->degenerate_count())},
          {"bytes_per_link", links > 0.0 ? number(solution->links.memory_bytes()) / links : 0.0},
          {"solution_bytes", number(solution->memory_bytes())},
          {"refinement_passes", number(solution->record.pass_links.size() - 1)},
          {"pass_links", solution->record.pass_links},
          {"residuals", solution->record.residuals},
          {"has_converged", solution->record.has_converged ? 1.0 : 0.0},
          {"solution_rays", number(solution->record.rays)}};
}

}  // namespace renderers::element_hierarchy
