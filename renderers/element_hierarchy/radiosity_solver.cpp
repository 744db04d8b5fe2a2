#include "renderers/element_hierarchy/radiosity_solver.h"

#include <algorithm>
#include <bit>

#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::element_hierarchy {

namespace {

/// The choice of links needs no more than this; ours.
constexpr double kRoughConvergence = 0.02;

/// Iterates until the radiosities settle.
void settle(const SolverSettings& settings, double convergence, StageTimer& timer,
            Solution& solution) {
  const auto stage = timer.stage("iterations");
  solution.record.has_converged = false;
  for (int i = 0; i < settings.most_iterations && !solution.record.has_converged; ++i) {
    const double residual = solution.field->iterate(solution.links);
    solution.record.residuals.push_back(residual);
    solution.record.has_converged = residual < convergence;
  }
}

/// Rays of all sides that are enough for the light of a scene; ours.
constexpr std::size_t kEnoughRays = std::size_t{1} << 20U;

/// A few large sides need more rays than many small ones, whose errors average out; ours.
std::size_t rays_per_side(const SolverSettings& settings, std::size_t pieces) {
  constexpr std::size_t kMost = 1024;
  const auto least = static_cast<std::size_t>(settings.side_rays);
  if (!settings.shares_by_views) return least;
  const std::size_t share = std::bit_floor(kEnoughRays / std::max<std::size_t>(1, 2 * pieces));
  return std::max(least, std::min(kMost, share));
}

/// Of them, for the choice of links; ours.
std::size_t rough_rays_per_side(std::size_t sides) {
  constexpr std::size_t kLeast = 8;
  return std::max(kLeast, kEnoughRays / std::max<std::size_t>(1, sides));
}

/// I_s of Eq. 1 of Scheel et al. 2002: unoccluded irradiance.
void store_irradiances(Solution& solution) {
  const std::vector<glm::vec3>& radiosity = solution.field->sent();
  for (std::uint32_t i = 0; i < solution.tree->elements().size(); ++i) {
    for (Link& link : solution.links.of(i)) {
      const float sent = ray_tracing::luminance(radiosity[link.source]);
      link.irradiance = log_coded(static_cast<double>(link.form_factor * sent));
    }
  }
}

/// Links that the next pass may add.
std::size_t room_for(const SolverSettings& settings, std::size_t links) {
  constexpr std::size_t kLeast = 64;  // the first passes would be too many
  const std::size_t budget = settings.refinement.link_budget;
  if (links >= budget) return 0;
  const auto grown = static_cast<std::size_t>(settings.growth * static_cast<double>(links));
  return std::min(budget - links, std::max(kLeast, grown));
}

}  // namespace

void solve_radiosity(const SolverSettings& settings, StageTimer& timer, Solution& solution) {
  LinkRefinement refinement(*solution.tree, settings.refinement);
  {
    const auto stage = timer.stage("links");
    refinement.cut_for_known_light();
    solution.links = refinement.initial_links();
  }
  solution.field = std::make_unique<RadiosityField>(*solution.tree, solution.views.get());
  solution.record.pass_links.push_back(static_cast<double>(solution.links.size()));
  const std::size_t rough_rays = rough_rays_per_side(solution.tree->roots().size());
  const auto follow = [&](std::size_t rays) {
    const auto stage = timer.stage("iterations");
    if (solution.views) solution.views->follow(solution.links, rays);
  };
  const double rough = settings.shares_by_views ? std::max(settings.convergence, kRoughConvergence)
                                                : settings.convergence;
  follow(rough_rays);
  settle(settings, rough, timer, solution);
  while (true) {
    std::size_t refined = 0;
    {
      const auto stage = timer.stage("links");
      refined = refinement.refine(*solution.field, solution.links,
                                  room_for(settings, solution.links.size()));
    }
    if (refined == 0) break;
    solution.record.pass_links.push_back(static_cast<double>(solution.links.size()));
    follow(rough_rays);
    settle(settings, rough, timer, solution);
  }
  if (solution.views && rough_rays < solution.views->rays_per_side()) {
    follow(solution.views->rays_per_side());
  }
  settle(settings, settings.convergence, timer, solution);
  store_irradiances(solution);
  solution.emitted_irradiance = solution.field->emitted_irradiance(solution.links);
  solution.record.rays += refinement.rays();
}

std::unique_ptr<Solution> solve_radiosity(const ray_tracing::RayScene& rays,
                                          const SolverSettings& settings, StageTimer& timer) {
  auto solution = std::make_unique<Solution>();
  {
    const auto stage = timer.stage("elements");
    const double most_means = settings.shares_by_views ? settings.largest_side : 0.0;
    const auto pieces = std::make_shared<SurfacePieces>(rays, most_means);
    const LitSides sides = find_lit_sides(rays, pieces, rays_per_side(settings, pieces->count()));
    const bool is_dark = std::ranges::none_of(sides.is_lit, [](bool is_lit) { return is_lit; });
    if (is_dark) return nullptr;
    solution->record.rays += sides.rays;
    solution->tree = std::make_unique<ElementTree>(rays, sides);
    if (settings.shares_by_views) {
      solution->views = std::make_unique<SideViews>(*solution->tree, sides);
    }
  }
  solve_radiosity(settings, timer, *solution);
  return solution;
}

}  // namespace renderers::element_hierarchy
