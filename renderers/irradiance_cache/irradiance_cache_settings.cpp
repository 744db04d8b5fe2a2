#include "renderers/irradiance_cache/irradiance_cache_settings.h"

#include <array>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "renderers/contract/choice_names.h"

namespace renderers::irradiance_cache {

namespace {

constexpr std::array<std::pair<const char*, Weights>, 2> kWeights{
    {{"ward", Weights::ward}, {"continuous", Weights::continuous}}};

}  // namespace

std::vector<base::ParameterSpec> parameter_specs() {
  std::vector<base::ParameterSpec> specs = indirect_view::view_parameters();
  specs.push_back(base::real_parameter("accuracy", 0.2, {0.01, 1.0}, "",
                                       "a: greatest error of a record that is used (Ward 1988, "
                                       "Eq. 4; recalled); smaller means more records; ours."));
  specs.push_back(base::integer_parameter("hemisphere_rays", 512, {6.0, 1e6}, "rays",
                                          "Rays of a record, one per cell of its grid; ours."));
  specs.push_back(base::real_parameter("least_spacing", 0.02, {1e-6, 1.0}, "scene diagonals",
                                       "Least radius of a record; ours."));
  specs.push_back(base::real_parameter("greatest_spacing", 0.25, {1e-6, 10.0}, "scene diagonals",
                                       "Greatest radius of a record; ours."));
  specs.push_back(
      base::boolean_parameter("gradients", true,
                              "Records know how irradiance changes with place and "
                              "attitude (Ward and Heckbert 1992), and reach no further than "
                              "it takes irradiance to change by all of itself."));
  specs.push_back(base::boolean_parameter("neighbour_clamp", true,
                                          "Radii of neighbours differ by their distance at most "
                                          "(Krivanek et al. 2006)."));
  specs.push_back(base::choice_parameter("weights", names_of(kWeights), "continuous",
                                         "ward: 1 / e, ends abruptly (Ward 1988); continuous: 1 / "
                                         "e - 1 / a (Tabellion and Lamorlette 2004)."));
  specs.push_back(base::integer_parameter("depth", 0, {0.0, 1.0}, "surfaces",
                                          "Most surfaces of the path behind a ray of a record; 0: "
                                          "no bound, claims diffuse; 1: claims one_bounce; no set "
                                          "of light paths that can be claimed ends later; ours."));
  return specs;
}

std::vector<base::Preset> presets() {
  using Value = base::ParameterValue;
  // Ward, Rubinstein, Clear 1988: no gradients, weights 1 / e, radii as they are.
  base::Preset paper{"paper",
                     {{"gradients", Value(false)},
                      {"neighbour_clamp", Value(false)},
                      {"weights", Value(std::string("ward"))}}};
  return {std::move(paper), base::Preset{"best", {}}};
}

Claims claims_of(const base::Parameters& parameters) {
  const bool is_one_bounce = parameters.integer("depth") == 1;
  return {is_one_bounce ? Transport::one_bounce : Transport::diffuse,
          part_from_text(parameters.text("part")), std::nullopt};
}

Settings settings_of(const base::Parameters& parameters) {
  Settings settings;
  settings.view = indirect_view::view_settings_of(parameters);
  settings.cache.records.accuracy = static_cast<float>(parameters.real("accuracy"));
  settings.cache.records.gradients = parameters.boolean("gradients");
  settings.cache.spacing.by_gradient = settings.cache.records.gradients;
  settings.cache.records.neighbour_clamp = parameters.boolean("neighbour_clamp");
  settings.cache.records.weights = value_of(kWeights, parameters.text("weights"));
  settings.cache.grid = grid_size(static_cast<int>(parameters.integer("hemisphere_rays")));
  settings.cache.depth = static_cast<int>(parameters.integer("depth"));
  settings.least_spacing = parameters.real("least_spacing");
  settings.greatest_spacing = parameters.real("greatest_spacing");
  if (settings.least_spacing > settings.greatest_spacing) {
    throw base::InputError(
        fmt::format("irradiance-cache: least_spacing is {}; accepted: at most greatest_spacing, {}",
                    settings.least_spacing, settings.greatest_spacing));
  }
  return settings;
}

}  // namespace renderers::irradiance_cache
