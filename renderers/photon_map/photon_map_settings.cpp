#include "renderers/photon_map/photon_map_settings.h"

#include <array>
#include <string>
#include <utility>

#include "renderers/contract/choice_names.h"

namespace renderers::photon_map {

namespace {

using base::choice_parameter;
using base::integer_parameter;
using base::real_parameter;

constexpr std::array<std::pair<const char*, Kernel>, 2> kKernels{
    {{"none", Kernel::none}, {"cone", Kernel::cone}}};
constexpr std::array<std::pair<const char*, Neighbours>, 2> kNeighbours{
    {{"arriving", Neighbours::arriving}, {"same_surface", Neighbours::same_surface}}};

/// Ten to twenty gigabytes: a photon takes 48 bytes wherever it lands, mostly two to four times.
constexpr double kMostPhotons = 1e8;

}  // namespace

std::vector<base::ParameterSpec> parameter_specs() {
  std::vector<base::ParameterSpec> specs = indirect_view::view_parameters();
  for (base::ParameterSpec& spec : indirect_view::hemisphere_parameters()) {
    specs.push_back(std::move(spec));
  }
  specs.push_back(integer_parameter("photons", 200000, {1.0, kMostPhotons}, "photons",
                                    "Photons that leave the lights; ours."));
  specs.push_back(choice_parameter("emission", {"random", "sobol"}, "sobol",
                                   "Numbers of photons: independent, or Owen-scrambled Sobol' "
                                   "points; ours."));
  specs.push_back(integer_parameter("nearest", 100, {2.0, 100000.0}, "photons",
                                    "Photons of a density estimate (Jensen 1996: 50 to 100; "
                                    "recalled)."));
  specs.push_back(choice_parameter("kernel", names_of(kKernels), "cone",
                                   "Filter of the density estimate: none, or a cone (Jensen 1996, "
                                   "Sec. 3.2)."));
  specs.push_back(choice_parameter("neighbours", names_of(kNeighbours), "same_surface",
                                   "arriving: all photons that came to the side looked at; "
                                   "same_surface: of these, those of nearly the same attitude and "
                                   "plane; ours."));
  specs.push_back(real_parameter("most_radius", 0.1, {1e-6, 1.0}, "scene diagonals",
                                 "Greatest radius of a density estimate; ours."));
  specs.push_back(integer_parameter("precompute_every", 4, {0.0, 1000.0}, "photons",
                                    "Irradiance is worked out beforehand where one in n as many "
                                    "other photons land (Christensen 1999, Sec. 3: at every n-th "
                                    "photon), and gather rays take the nearest; 0: an estimate for "
                                    "every ray."));
  specs.push_back(real_parameter("near_radii", 1.0, {0.0, 1000.0}, "radii",
                                 "Gather rays that end nearer than so many mean radii of an "
                                 "estimate go on by one ray and a sample on the lights (Jensen "
                                 "2001; recalled); 0: never."));
  return specs;
}

std::vector<base::Preset> presets() {
  using Value = base::ParameterValue;
  // Jensen 1996: independent photons, all that arrive count, an estimate at the end of every gather
  // ray, whose directions are stratified.
  base::Preset paper{"paper",
                     {{"emission", Value(std::string("random"))},
                      {"gather_sequence", Value(std::string("strata"))},
                      {"neighbours", Value(std::string("arriving"))},
                      {"precompute_every", Value(std::int64_t{0})},
                      {"near_radii", Value(0.0)}}};
  return {std::move(paper), base::Preset{"best", {}}};
}

Settings settings_of(const base::Parameters& parameters) {
  Settings settings;
  settings.view = indirect_view::view_settings_of(parameters);
  settings.gather = indirect_view::hemisphere_rays_of(parameters);
  settings.tracing.photons = parameters.integer("photons");
  settings.tracing.sequence = parameters.text("emission") == "sobol"
                                  ? ray_tracing::SequenceKind::sobol
                                  : ray_tracing::SequenceKind::random;
  settings.density.nearest = static_cast<int>(parameters.integer("nearest"));
  settings.density.kernel = value_of(kKernels, parameters.text("kernel"));
  settings.density.neighbours = value_of(kNeighbours, parameters.text("neighbours"));
  settings.most_radius = parameters.real("most_radius");
  settings.precompute_every = static_cast<int>(parameters.integer("precompute_every"));
  settings.near_radii = parameters.real("near_radii");
  return settings;
}

}  // namespace renderers::photon_map
